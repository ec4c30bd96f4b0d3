// The page in a browser: drawn, moved, read back.
import assert from "node:assert/strict";
import { statSync } from "node:fs";
import test, { after, before } from "node:test";

import { Browser } from "./browser.mjs";
import { answer, makePage, scene } from "./program.mjs";

const PANELS = ["hardware", "pareto", "pictures", "units", "bytes", "roofline", "tornado", "memory", "flow", "belief"];

let browser, page, file;

async function open(address) {
  await page.goto("about:blank");
  await page.goto(address);
  await page.waitForFunction("document.documentElement.dataset.drawn", { timeout: 60000 });
}

// Waits until the studies show what was set last.
const settled = () => page.waitForFunction(() => document.documentElement.dataset.drawn === JSON.stringify(window.hwsimReport.state), { timeout: 60000 });

async function moveSlider(key, step) {
  await page.$eval(`input[data-key="${key}"]`, (input, value) => {
    input.value = value;
    input.dispatchEvent(new Event("input", { bubbles: true }));
  }, String(step));
  await settled();
}

const frameMs = () => page.$eval("#frame-ms", (node) => Number(node.dataset.v));

before(async () => {
  file = makePage("browser");
  browser = await Browser.launch();
  page = await browser.open(file);
});

after(async () => {
  await browser?.close();
});

test("the file is below 5 MB", () => assert.ok(statSync(file).size < 5e6));

test("every panel is drawn", async () => {
  for (const name of PANELS) {
    const seen = await page.$eval(`#${name}`, (node) => ({ live: node.classList.contains("live"), size: Math.max(0, ...[...node.querySelectorAll("svg, img")].map((part) => part.getBoundingClientRect().height)), failed: Boolean(node.querySelector(".missing")) }));
    assert.ok(seen.live && seen.size > 20 && !seen.failed, `${name}: ${JSON.stringify(seen)}`);
  }
  assert.equal(await page.$$eval("#belief svg[viewBox]", (all) => all.filter((node) => node.getBoundingClientRect().height > 300).length), 3, "times, ratios, other renderers");
  assert.equal(await page.$$eval("table", (all) => all.filter((node) => !node.querySelector("button.csv")).length), 0);
});

test("what a slider moves is what the program says", async () => {
  await moveSlider("dram_bandwidth_gb_s", 4);
  await moveSlider("crop_units", -4);
  const sets = await page.evaluate(() => window.hwsimReport.state.sets);
  const base = await page.evaluate(() => window.hwsimReport.model.data.gpus[window.hwsimReport.state.gpu].values);
  assert.equal(sets.dram_bandwidth_gb_s, 2 * base.dram_bandwidth_gb_s);
  assert.equal(sets.crop_units, base.crop_units / 2);
  const technique = await page.evaluate(() => window.hwsimReport.model.data.points[0].explanation.technique);
  const words = Object.entries(sets).flatMap(([key, value]) => ["--set", `gpu.${key}=${value}`]);
  const [{ frame, passes }] = answer("compare", ...scene, "-t", technique, "-g", "gtx980", ...words).results;
  assert.equal(await frameMs(), frame.time_ms.after);
  const shown = await page.$$eval("#mount-hardware table tbody tr", (rows) => rows.map((row) => [row.cells[0].textContent, Number(row.cells[2].dataset.v), row.cells[4].textContent]));
  assert.deepEqual(shown, passes.map((pass) => [pass.name, pass.time_ms.after, pass.limiter.after]));
});

test("a GPU without a last-level cache is given one", async () => {
  await page.click("#reset");
  await settled();
  await moveSlider("llc_size_kib", 4);
  assert.equal(await page.evaluate(() => window.hwsimReport.state.sets.llc_size_kib), 8192);
  const technique = await page.evaluate(() => window.hwsimReport.model.data.points[0].explanation.technique);
  const [{ frame }] = answer("compare", ...scene, "-t", technique, "-g", "gtx980", "--set", "gpu.llc_size_kib=8192").results;
  assert.equal(await frameMs(), frame.time_ms.after);
  await moveSlider("dram_bandwidth_gb_s", 4);
});

test("the address keeps what is moved", async () => {
  const moved = await frameMs();
  await open(await page.evaluate(() => location.href));
  assert.equal(await frameMs(), moved);
  await page.click("#reset");
  await settled();
  assert.notEqual(await frameMs(), moved);
});

test("an address of nonsense is an unmoved page", async () => {
  const own = await frameMs();
  await open(`file://${file}#point=99&gpu=nobody&crop_units=-5&dram_bandwidth_gb_s=x&__proto__=1`);
  assert.equal(await frameMs(), own);
});

test("the budget moves by keyboard", async () => {
  await page.focus("#budget");
  await page.keyboard.press("Home");
  assert.match(await page.$eval("output[for=budget]", (node) => node.textContent), /nothing is within/);
  await page.keyboard.press("End");
  assert.match(await page.$eval("output[for=budget]", (node) => node.textContent), /least error/);
});

test("pictures are compared, blink and zoom", async () => {
  const [left, right] = await page.$$eval("#comparer img", (images) => images.map((image) => image.src.length));
  assert.ok(left > 1000 && right > 1000);
  await page.click("#blink");
  await page.waitForFunction(() => document.querySelector("#comparer").value === 100);
  await page.click("#blink");
  await page.click("#zoom-in");
  await page.waitForFunction(() => new DOMMatrix(getComputedStyle(document.querySelector(".stage")).transform).a > 1);
});

test("without scripts the answer, the tables and the pictures are there", async () => {
  const plain = await browser.open(file, { scripts: false });
  const seen = await plain.evaluate(() => document.body.innerText).catch(() => null);
  const html = seen ?? (await plain.content());
  for (const word of ["Before you lean on it", "deferred_simple_complex on gtx980", "Can I believe it"]) assert.ok(html.includes(word), word);
  await plain.close();
});

test("nothing was said in the console, no request was sent", () => assert.deepEqual(browser.heard, []));
