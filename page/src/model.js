// What the page knows: the report's data, and frames on hardware that is moved.
import { bytesOfBase64 } from "./engine.js";

export const NS_PER_MS = 1e6;

// Variance of a logarithm by its gradient, as hwsim's cost_models/covariance.cpp sums it.
function variance(covariance, gradient) {
  const n = gradient.length;
  let sum = 0;
  for (let a = 0; a < n; ++a)
    if (gradient[a] !== 0)
      for (let b = 0; b < n; ++b) sum += gradient[a] * covariance[a * n + b] * gradient[b];
  return Math.max(0, sum);
}

const sum = (numbers) => numbers.reduce((all, value) => all + value, 0);

// Sum of the squares of what each unit's part of the time changed by.
function movedSquares(before, after) {
  const units = new Set([...Object.keys(before), ...Object.keys(after)]);
  return sum([...units].map((unit) => ((after[unit] ?? 0) - (before[unit] ?? 0)) ** 2));
}

const SUPPORTS = ["calibrated", "interpolated", "extrapolated", "uncalibrated"];

export class Model {
  constructor(data, engine) {
    this.data = data;
    this.engine = engine;
    this.keys = new Map(data.keys.map((key) => [key.name, key]));
    this.traces = engine
      ? data.points.map((point) =>
          engine.addTrace(bytesOfBase64(point.trace), point.explanation.passes.length),
        )
      : [];
    this.kept = new Map();
  }

  label(point) {
    return this.data.points[point].label;
  }

  ownGpu(point) {
    const { gpu_hash } = this.data.points[point];
    return this.data.gpus.findIndex((gpu) => gpu.hash === gpu_hash);
  }

  // Why a GPU cannot take a point's trace; empty where it can.
  refusal(point, gpu) {
    const own = this.data.gpus[this.ownGpu(point)].functional;
    const other = this.data.gpus[gpu].functional;
    const names = Object.keys(own).filter((name) => own[name] !== other[name]);
    if (this.data.points[point].functional_hash === this.data.gpus[gpu].functional_hash) return "";
    const shown = names.slice(0, 3).map((name) => name.replace(/^.*\./, ""));
    return `needs a new emulation: ${shown.join(", ")}${names.length > 3 ? ", ..." : ""} differ`;
  }

  values(state) {
    return { ...this.data.gpus[state.gpu].values, ...state.sets };
  }

  #cached(name, make) {
    if (!this.kept.has(name)) {
      if (this.kept.size > 400) this.kept.clear();
      this.kept.set(name, make());
    }
    return this.kept.get(name);
  }

  // A point on hardware: {timeNs, passes, support, interval, gradient}.
  frame(point, gpu, sets) {
    return this.#cached(JSON.stringify(["frame", point, gpu, sets]), () => {
      const { values: own, fitted, supports } = this.data.gpus[gpu];
      const values = { ...own, ...sets };
      const support = supports[point] ?? "uncalibrated";
      const known = support !== "uncalibrated";
      const frame = this.engine.time(this.traces[point], values, { slopeKeys: known ? Object.keys(fitted) : [] });
      const changed = Object.keys(sets).some((key) => own[key] !== sets[key]);
      frame.support = known && changed ? "extrapolated" : support;
      frame.passes.forEach((pass, i) => (pass.name = this.data.points[point].explanation.passes[i].name));
      if (!known) return frame;
      frame.gradient = this.#gradient(gpu, values, frame.slopes, frame.timeNs);
      const { covariance, residual_log_sd: residual, quantile90 } = this.data.intervals;
      const sd = Math.sqrt(variance(covariance, frame.gradient) + residual * residual);
      const quantile = quantile90[frame.support];
      frame.interval = [-1, 1].map((sign) => frame.timeNs * Math.exp(sign * quantile * sd));
      return frame;
    });
  }

  // d ln(time) / d ln(parameter), in the order of the calibration's parameters.
  #gradient(gpu, values, slopes, timeNs) {
    const { fitted } = this.data.gpus[gpu];
    const byId = new Map(Object.entries(fitted).map(([key, id]) => [id, ((slopes[key] ?? 0) * values[key]) / timeNs]));
    return this.data.intervals.parameters.map((id) => (timeNs > 0 ? byId.get(id) ?? 0 : 0));
  }

  // The gradient of each pass: slopes of the first p passes less those of the first p - 1.
  #passGradients(point, { gpu, sets }) {
    return this.#cached(JSON.stringify(["passes", point, gpu, sets]), () => {
      const { values: own, fitted } = this.data.gpus[gpu];
      const values = { ...own, ...sets };
      const slopeKeys = Object.keys(fitted);
      let before = {};
      return this.frame(point, gpu, sets).passes.map(({ timeNs }, p) => {
        const { slopes } = this.engine.time(this.traces[point], values, { slopeKeys, passes: p + 1 });
        const mine = Object.fromEntries(slopeKeys.map((key) => [key, (slopes[key] ?? 0) - (before[key] ?? 0)]));
        before = slopes;
        return this.#gradient(gpu, values, mine, timeNs);
      });
    });
  }

  // A ratio of times with its 90 % interval: ratio_half_width of hwsim's cost_models/intervals.cpp, for one
  // technique and scene.
  #ratio(before, after, sameGpu, support) {
    if (!(before.timeNs > 0)) return null;
    const ratio = after.timeNs / before.timeNs;
    if (support === "uncalibrated") return { ratio };
    const { covariance, residual_log_sd: residual, quantile90, ratio_quantile90 } = this.data.intervals;
    const parts = (side) => Object.fromEntries(Object.entries(side.stackNs).map(([unit, ns]) => [unit, ns / side.timeNs]));
    const own = variance(covariance, after.gradient.map((g, i) => g - before.gradient[i]));
    const rest = residual * residual * (sameGpu ? movedSquares(parts(before), parts(after)) : 2);
    const quantile = sameGpu ? ratio_quantile90.calibrated : quantile90[support];
    const factor = Math.exp(quantile * Math.sqrt(own + rest));
    return { ratio, low: ratio / factor, high: ratio * factor };
  }

  // What the keys' documents say that a change of values does to every time: -1 never longer, 1 never shorter, 0 both
  // ways; as time_direction of hwsim's lab/studies/variation.h.
  #direction(before, after) {
    const [was, is] = [before, after].map(({ gpu, sets }) => ({ ...this.data.gpus[gpu].values, ...sets }));
    const signs = new Set();
    for (const { name, direction } of this.data.keys) {
      const change = Number(is[name]) - Number(was[name]);
      if (change === 0 || Number.isNaN(change)) continue;
      if (direction === "neither") return 0;
      signs.add((direction === "faster") === change > 0 ? -1 : 1);
    }
    return signs.size === 1 ? [...signs][0] : 0;
  }

  // The change of each pass, and of the frame last.
  changes(point, before, after) {
    const sides = [before, after].map((side) => this.frame(point, side.gpu, side.sets));
    const support = SUPPORTS[Math.max(...sides.map((frame) => SUPPORTS.indexOf(frame.support)))];
    const sameGpu = this.data.gpus[before.gpu].id === this.data.gpus[after.gpu].id;
    const gradients = support === "uncalibrated" ? [[], []] : [before, after].map((side) => this.#passGradients(point, side));
    const direction = sameGpu ? this.#direction(before, after) : 0;
    const one = ([a, b]) => {
      const change = this.#ratio(a, b, sameGpu, support);
      if (direction > 0 && change?.low < 1 && change.ratio >= 1) change.low = 1;
      if (direction < 0 && change?.high > 1 && change.ratio <= 1) change.high = 1;
      return change;
    };
    const changes = sides[1].passes.map((_, p) => one(sides.map(({ passes }, s) => ({ ...passes[p], gradient: gradients[s][p] }))));
    changes.push(one(sides.map((frame) => ({ ...frame, stackNs: stackOf(frame) }))));
    return changes;
  }

  // Percent of time for one percent of each real number, the largest first.
  elasticities(point, gpu, sets) {
    return this.#cached(JSON.stringify(["elasticities", point, gpu, sets]), () => {
      const { values: own, foreign_keys: foreign } = this.data.gpus[gpu];
      const values = { ...own, ...sets };
      const slopeKeys = this.data.keys.filter((key) => key.derivative && !foreign.includes(key.name)).map((key) => key.name);
      const { timeNs, slopes } = this.engine.time(this.traces[point], values, { slopeKeys });
      return Object.entries(slopes)
        .map(([key, slope]) => ({ key, value: values[key], elasticity: (slope * values[key]) / timeNs }))
        .filter(({ elasticity }) => elasticity !== 0)
        .sort((a, b) => Math.abs(b.elasticity) - Math.abs(a.elasticity));
    });
  }
}

// What each unit holds the frame up for.
function stackOf({ passes }) {
  const units = Object.keys(passes[0]?.stackNs ?? {});
  return Object.fromEntries(units.map((unit) => [unit, sum(passes.map((pass) => pass.stackNs[unit]))]));
}

function shellWord(word) {
  return /^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`;
}

export function tomlOf(model, state) {
  const gpu = model.data.gpus[state.gpu];
  const lines = [`schema = 1`, `kind = "gpu"`, `id = ${JSON.stringify(gpu.id + "-moved")}`, `extends = ${JSON.stringify(gpu.id)}`];
  for (const [key, value] of changedValues(model, state)) lines.push(`${key} = ${value}`);
  return lines.join("\n") + "\n";
}

// What a GPU of hwsim's own with this id does not have.
function changedValues(model, state) {
  const { data } = model;
  const gpu = data.gpus[state.gpu];
  const hash = data.catalog_hashes[gpu.id];
  const base = data.gpus.find((other) => other.hash === hash)?.values ?? gpu.values;
  return Object.entries(model.values(state)).filter(([key, value]) => base[key] !== value);
}

export function commandOf(model, state) {
  const { data } = model;
  const point = data.points[state.point];
  const own = data.gpus[model.ownGpu(state.point)];
  const gpu = data.gpus[state.gpu];
  const sets = changedValues(model, state).map(([key, value]) => ` --set gpu.${key}=${value}`);
  const frame = `${point.view_words} -t ${shellWord(point.explanation.technique)}`;
  if (gpu.id !== own.id && sets.length === 0) return `hwsim compare ${frame} -g ${shellWord(`${own.id},${gpu.id}`)}`;
  const verb = data.catalog_hashes[gpu.id] === gpu.hash && sets.length > 0 ? "compare" : "run";
  return `hwsim ${verb} ${frame} -g ${shellWord(gpu.id)}${sets.join("")}`;
}
