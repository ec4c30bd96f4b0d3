// The engine in the page against the program: the same numbers to the last digit.
import assert from "node:assert/strict";
import test from "node:test";

import { Engine } from "../../page/src/engine.js";
import { commandOf, Model, tomlOf } from "../../page/src/model.js";
import { answer, hwsim, inPlace, makePage, partsOf, scene } from "./program.mjs";
import { writeFileSync } from "node:fs";

const NS_PER_MS = 1e6;
// Intervals take exponentials, which two mathematics libraries may round apart; times take none.
const near = (a, b) => assert.ok(Math.abs(a - b) <= 1e-12 * Math.abs(b), `${a} is not ${b}`);

const { data, engine } = partsOf(makePage("replay"));
const model = new Model(data, await Engine.load(engine));

function expectFrame(frame, result) {
  assert.equal(frame.timeNs / NS_PER_MS, result.frame.time_ms);
  assert.equal(frame.support, result.frame.support);
  assert.deepEqual(frame.passes.map((pass) => pass.name), result.passes.map((pass) => pass.name));
  frame.passes.forEach((pass, p) => {
    const expected = result.passes[p];
    assert.equal(pass.timeNs / NS_PER_MS, expected.time_ms);
    assert.equal(pass.limiter, expected.limiter);
    assert.deepEqual(pass.share, expected.units);
    for (const [stream, bytes] of Object.entries(expected.bytes)) assert.equal(pass.read[stream] + pass.write[stream], bytes);
  });
  const interval = result.frame.interval_ms;
  assert.equal(Boolean(frame.interval), Boolean(interval));
  interval?.forEach((end, i) => near(frame.interval[i] / NS_PER_MS, end));
}

test("every point replays to its own result", () => {
  assert.equal(data.points.length, 3);
  data.points.forEach((point, i) => expectFrame(model.frame(i, model.ownGpu(i), {}), point.explanation));
});

test("every other GPU that takes the work gives what the program says of it", () => {
  const takers = data.gpus.map((_, i) => i).filter((i) => i !== model.ownGpu(1) && !model.refusal(1, i));
  assert.ok(takers.length >= 2, "too few GPUs share the features of the GTX 980");
  for (const gpu of takers)
    expectFrame(model.frame(1, gpu, {}), answer("run", ...scene, "-t", "msaa4x", "-g", data.gpus[gpu].id, "--no-image", "--out", inPlace("other"), "--force"));
});

test("a GPU with other features is refused with its reason", () => {
  const refused = data.gpus.map((_, i) => model.refusal(1, i)).filter(Boolean);
  assert.ok(refused.length > 0);
  for (const reason of refused) assert.match(reason, /needs a new emulation: \w+/);
});

const CHANGES = [
  { dram_bandwidth_gb_s: 448 },
  { l2_size_kib: 8192, l2_bytes_per_clk: 900 },
  { crop_units: 128, shader_cores: 8 },
  { core_clock_mhz: 1500.5, fast_clear_color: false, msaa_color_compression: false },
  { raster_engines: 1, fp32_lanes_per_core: 64, pass_overhead_us: 0.25 },
];

test("moved hardware gives what `compare --set` says, with the interval of the change", () => {
  for (const sets of CHANGES)
    for (const point of [1, 2]) {
      const { technique } = data.points[point].explanation;
      const words = Object.entries(sets).flatMap(([key, value]) => ["--set", `gpu.${key}=${value}`]);
      const compared = answer("compare", ...scene, "-t", technique, "-g", "gtx980", ...words);
      const [{ frame, passes }] = compared.results;
      const gpu = model.ownGpu(point);
      const moved = model.frame(point, gpu, sets);
      assert.equal(moved.timeNs / NS_PER_MS, frame.time_ms.after);
      moved.passes.forEach((pass, p) => {
        assert.equal(pass.timeNs / NS_PER_MS, passes[p].time_ms.after);
        assert.equal(pass.limiter, passes[p].limiter.after);
      });
      const change = model.changes(point, { gpu, sets: {} }, { gpu, sets }).at(-1);
      near(change.ratio - 1, frame.time_ms.delta_ratio);
      near(change.low, 1 + frame.time_ms.delta_interval90[0]);
      near(change.high, 1 + frame.time_ms.delta_interval90[1]);
      expectFrame(moved, answer("run", ...scene, "-t", technique, "-g", "gtx980", ...words, "--no-image", "--out", inPlace("moved"), "--force"));
    }
});

test("derivatives are those of `explain`", () => {
  const expected = new Map(data.points[2].explanation.sensitivity.map((s) => [s.parameter, s.elasticity]));
  const found = model.elasticities(2, model.ownGpu(2), {});
  assert.ok(found.length > 5);
  for (const { key, elasticity } of found) near(elasticity, expected.get(`gpu.${key}`));
});

test("the copied command and the copied file give the page's time", () => {
  const state = { point: 1, gpu: model.ownGpu(1), sets: { dram_bandwidth_gb_s: 300, crop_units: 32 } };
  const time = model.frame(1, state.gpu, state.sets).timeNs / NS_PER_MS;
  const words = commandOf(model, state).replaceAll("'", "").split(" ").slice(1);
  assert.equal(answer(...words).results[0].frame.time_ms.after, time);
  const file = inPlace("moved.toml");
  writeFileSync(file, tomlOf(model, state));
  const result = answer("run", ...scene, "-t", "msaa4x", "-g", file, "--no-image", "--out", inPlace("file"), "--force");
  // A file with another id is no calibrated GPU: its numbers without the fitted ones may differ, its keys not.
  assert.match(hwsim("config", "check", file), /./);
  assert.ok(result.frame.time_ms > 0);
});
