// Names of strangers: scenes, GPUs, techniques and materials that carry scripts, quotes and escape sequences.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import test, { after, before } from "node:test";

import { commandOf, tomlOf } from "../../page/src/model.js";
import { Browser } from "./browser.mjs";
import { hwsim, inPlace } from "./program.mjs";

const SCRIPT = "</script><script>window.hostile=1</script>";
const IMAGE = `"'><img src=x onerror=window.hostile=2>`;
const ESCAPE = "\u001b[31mred\u0007";
const TOUCH = `$(touch ${inPlace("touched")})\`touch ${inPlace("touched")}\``;
const FOLDER = inPlace("x<script>window.hostile=3<"); // with the file's name it ends a script element

let browser, runPage, rankPage, gpuFile, sceneFile;

// A triangle whose every name is hostile.
function writeScene(file) {
  const positions = Buffer.from(new Float32Array([-1, -1, 0, 1, -1, 0, 0, 1, 0]).buffer);
  const name = SCRIPT + IMAGE + ESCAPE;
  const gltf = {
    asset: { version: "2.0", generator: name },
    extensionsUsed: ["EXT_nobody_knows" + SCRIPT],
    scene: 0,
    scenes: [{ name, nodes: [0, 1] }],
    nodes: [{ name, mesh: 0 }, { name, camera: 0, translation: [0, 0, 3] }],
    cameras: [{ name, type: "perspective", perspective: { yfov: 1, znear: 0.1, zfar: 10 } }],
    materials: [{ name, pbrMetallicRoughness: { baseColorFactor: [1, 0.5, 0.2, 1] } }],
    meshes: [{ name, primitives: [{ attributes: { POSITION: 0 }, material: 0 }] }],
    accessors: [{ bufferView: 0, componentType: 5126, count: 3, type: "VEC3", min: [-1, -1, 0], max: [1, 1, 0] }],
    bufferViews: [{ buffer: 0, byteLength: 36 }],
    buffers: [{ byteLength: 36, uri: `data:application/octet-stream;base64,${positions.toString("base64")}` }],
  };
  writeFileSync(file, JSON.stringify(gltf));
}

function writeGpu(file) {
  const title = JSON.stringify(SCRIPT + IMAGE + ESCAPE);
  writeFileSync(file, `schema = 1\nkind = "gpu"\nid = "hostile"\nextends = "gtx980"\ntitle = ${title}\nvendor = ${title}\narchitecture = ${title}\ncore_clock_mhz = { value = 900, provenance = "assumed", source = ${title} }\n`);
}

before(async () => {
  mkdirSync(FOLDER, { recursive: true });
  sceneFile = join(FOLDER, `script>${TOUCH.replaceAll("/", "_")}'".gltf`);
  gpuFile = inPlace(`gpu'"${"<b>"}.toml`);
  writeScene(sceneFile);
  writeGpu(gpuFile);
  const view = [sceneFile, "--resolution", "64x48", "-g", gpuFile, "--reference", "1", "-q", "--force"];
  runPage = inPlace("hostile_run.html");
  hwsim("run", ...view, "-t", "none,msaa4x", "--out", inPlace("hostile_run"), "--report", runPage);
  const rank = inPlace("hostile_rank");
  hwsim("rank", ...view, "-t", "msaa4x", "--out", rank);
  const ranking = JSON.parse(readFileSync(join(rank, "ranking.json"), "utf8"));
  ranking.scene = ranking.budget = ranking.gpu = SCRIPT + IMAGE;
  for (const technique of ranking.techniques) technique.technique = SCRIPT + IMAGE + ESCAPE;
  writeFileSync(join(rank, "ranking.json"), JSON.stringify(ranking));
  rankPage = inPlace("hostile_rank.html");
  hwsim("report", rank, "-o", rankPage, "--force");
  browser = await Browser.launch();
});

after(() => browser?.close());

for (const scripts of [true, false])
  for (const which of ["run", "rank"])
    test(`names are text, ${scripts ? "with" : "without"} scripts: ${which}`, async () => {
      const page = await browser.open(which === "run" ? runPage : rankPage, { scripts });
      const html = await page.content();
      assert.ok(html.includes("&lt;script&gt;window.hostile"), "the names are not shown at all");
      assert.equal(html.match(/<img[^>]*onerror/g), null);
      assert.equal(html.match(/\u001b|\u0007/g), null);
      if (scripts) {
        assert.equal(await page.evaluate(() => window.hostile), undefined);
        assert.equal(await page.$$eval("script:not([type])", (all) => all.length), 1);
      }
      await page.close();
    });

test("what is copied is one word for a shell, and TOML for the program", async () => {
  const page = await browser.open(runPage);
  const texts = await page.evaluate(() => {
    const { model, state } = window.hwsimReport;
    return { again: document.getElementById("command").textContent, data: model.data, state: { ...state, sets: { crop_units: 8 } } };
  });
  const model = { data: texts.data, ownGpu: () => 0, values: (state) => ({ ...texts.data.gpus[state.gpu].values, ...state.sets }) };
  for (const command of [texts.again, commandOf(model, texts.state)]) {
    const words = execFileSync("bash", ["-c", command.replace(/^hwsim/, "printf '%s\\n'")], { encoding: "utf8" }).split("\n");
    assert.ok(words.includes(sceneFile), `${sceneFile} is not in ${words.join(" | ")}`);
  }
  assert.ok(!existsSync(inPlace("touched")), "a shell ran a part of a name");
  const file = inPlace("hostile_moved.toml");
  writeFileSync(file, tomlOf(model, { ...texts.state, gpu: texts.data.gpus.findIndex((gpu) => gpu.id === "gtx980") }));
  hwsim("config", "check", file);
  await page.close();
});

test("nothing was said, asked for or run", () => assert.deepEqual(browser.heard, []));
