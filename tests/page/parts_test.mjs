// Parts of the page that were not built: the build goes on, and the report says what it lacks.
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { copyFileSync, cpSync, existsSync, mkdirSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { dirname, join } from "node:path";
import test, { after, before } from "node:test";
import { fileURLToPath } from "node:url";

import { Browser } from "./browser.mjs";
import { inPlace, place, program, scene } from "./program.mjs";

const HERE = dirname(fileURLToPath(import.meta.url));
const SOURCE = join(HERE, "..", "..");
const BUILT = process.env.HWSIM_PAGE_PARTS;

let browser;
before(async () => (browser = await Browser.launch()));
after(() => browser?.close());

function folderWith(name, parts) {
  const folder = inPlace(name);
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  for (const part of parts) copyFileSync(join(BUILT, part), join(folder, part));
  return folder;
}

function reportWith(folder, name) {
  const file = inPlace(`${name}.html`);
  const env = { ...process.env, HWSIM_CACHE: inPlace("cache"), HWSIM_PAGE_DIR: folder };
  const words = ["run", ...scene, "-t", "none", "-g", "gtx980", "--out", inPlace(name), "--force", "--report", file];
  const done = spawnSync(program, words, { env, encoding: "utf8" });
  assert.equal(done.status, 0, done.stderr);
  return { file, html: readFileSync(file, "utf8"), said: done.stderr };
}

// Neither the packages nor clang for WebAssembly: configured and built as the project does it.
test("the build goes on without Node's packages and without clang for WebAssembly", () => {
  const page = inPlace("bare_page");
  rmSync(page, { recursive: true, force: true });
  cpSync(join(SOURCE, "page"), page, { recursive: true, filter: (path) => !path.includes("node_modules") });
  const build = inPlace("bare_build");
  rmSync(build, { recursive: true, force: true });
  const said = execFileSync("cmake", ["-S", join(HERE, "bare"), "-B", build, "-G", "Ninja", `-DSOURCE=${SOURCE}`, `-DPAGE=${page}`, "-DHWSIM_WASM_CXX_INCLUDE="], { encoding: "utf8" });
  assert.match(said, /No clang for wasm32-wasi: reports will not move hardware/);
  assert.match(said, /No esbuild in page\/node_modules: reports will have no charts/);
  execFileSync("cmake", ["--build", build]);
  assert.deepEqual(readdirSync(join(build, "page_parts")), ["page.css"]);
  const { html, said: told } = reportWith(join(build, "page_parts"), "bare");
  assert.match(told, /the report lacks charts/);
  assert.match(html, /This page lacks charts/);
  assert.ok(!html.includes("<script"), "a page without scripts has none");
  for (const words of ["Before you lean on it", "none on gtx980", "Can I believe it"]) assert.ok(html.includes(words), words);
});

test("without the engine charts are drawn, tables stand where hardware would move", async () => {
  const { file, html, said } = reportWith(folderWith("no_engine", ["page.css", "page.js"]), "no_engine_run");
  assert.match(said, /the report lacks hardware that can be moved/);
  assert.match(html, /This page lacks hardware that can be moved/);
  const page = await browser.open(file);
  assert.ok(await page.$("#belief svg"), "a chart that needs no engine");
  assert.equal(await page.$("#mount-hardware input"), null);
  assert.ok(await page.$eval("#hardware table", (node) => node.getBoundingClientRect().height > 0));
  await page.close();
});

test("without its style a page says so", () => {
  const { html } = reportWith(folderWith("no_style", ["page.js", "engine.wasm"]), "no_style_run");
  assert.match(html, /This page lacks its style/);
});

test("nothing was said in the console, no request was sent", () => assert.deepEqual(browser.heard, []));
assert.ok(place && existsSync(BUILT ?? ""), "HWSIM_PAGE_PARTS names the parts that were built");
