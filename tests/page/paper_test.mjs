// The page of a paper's tables, of frames that are small: its layout, its charts, its numbers beside the program's.
import assert from "node:assert/strict";
import { cpSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import test, { after, before } from "node:test";
import { fileURLToPath } from "node:url";

import { Browser } from "./browser.mjs";
import { hwsimIn, inPlace } from "./program.mjs";

const SOURCE = join(dirname(fileURLToPath(import.meta.url)), "..", "..");

let browser, page, rows;
before(async () => {
  const configs = inPlace("paper_configs");
  rmSync(configs, { recursive: true, force: true });
  cpSync(join(SOURCE, "configs"), configs, { recursive: true });
  const table = join(configs, "published", "axaa_table1.csv");
  writeFileSync(table, readFileSync(table, "utf8").replaceAll("1920x1080", "96x54"));
  const file = inPlace("paper.html");
  rows = JSON.parse(hwsimIn({ HWSIM_CONFIG_DIR: configs }, "reproduce", "axaa", "--json", "--force", "--report", file));
  browser = await Browser.launch();
  page = await browser.open(file);
});
after(() => browser?.close());

test("the table has the paper's lines and columns", async () => {
  const table = await page.$eval("table.paper", (node) => ({ title: node.caption.textContent, head: [...node.tHead.rows[0].cells].map((cell) => cell.textContent), lines: [...node.tBodies[0].rows].map((row) => row.cells[0].textContent) }));
  assert.match(table.title, /^AXAA, Table 1/);
  assert.deepEqual(table.head, ["method", "Intel HD Graphics 4600", "GeForce 840M", "Radeon HD 7650M", "Tegra K1"]);
  assert.deepEqual(table.lines.slice(0, 4), ["SMAA1x", "CMAA", "FXAA3.11", "AXAA"]);
});

test("a cell shows the published and the predicted time, and the error", async () => {
  const first = rows.find((row) => row.table === "axaa_table1" && row.gpu === "GeForce 840M" && row.technique === "AXAA");
  const cells = await page.$$eval("table.paper tbody tr", (all) => all.map((row) => [...row.cells].map((cell) => cell.textContent)));
  const cell = cells.find((row) => row[0] === "AXAA")[2];
  assert.ok(cell.includes(`${first.published_absolute.toFixed(2)} → ${first.predicted.toFixed(2)}`), cell);
  assert.match(cell, /%/);
  assert.ok(cells.flat().some((text) => text.includes("not predicted")), "what was printed as N/A");
});

test("errors by stage and beliefs are drawn, and no panel of frames is there", async () => {
  for (const id of ["residuals", "belief"]) assert.ok(await page.$(`#${id}.live svg`), id);
  for (const id of ["hardware", "pareto", "pictures", "units"]) assert.equal(await page.$(`#${id}`), null, id);
  assert.equal(await page.$$eval("#belief svg[viewBox]", (all) => all.filter((node) => node.getBoundingClientRect().height > 300).length), 3);
  assert.ok((await page.$$eval("table.paper button.csv", (all) => all.length)) >= 1);
});

test("nothing was said in the console, no request was sent", () => assert.deepEqual(browser.heard, []));
