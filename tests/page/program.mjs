// The program, and the page that the tests look at.
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync } from "node:fs";
import { join } from "node:path";

export const place = process.env.HWSIM_TEST_PLACE;
export const program = process.env.HWSIM;
if (!place || !program) throw new Error("HWSIM and HWSIM_TEST_PLACE say what to test: run it by ctest");

export const scene = ["sponza_hall", "--resolution", "320x180"];

export function inPlace(name) {
  mkdirSync(place, { recursive: true });
  return join(place, name);
}

export const hwsim = (...words) => hwsimIn({}, ...words);

// With variables of its own.
export function hwsimIn(variables, ...words) {
  const env = { ...process.env, HWSIM_CACHE: inPlace("cache"), ...variables };
  return execFileSync(program, words, { env, encoding: "utf8", stdio: ["ignore", "pipe", "ignore"], maxBuffer: 1 << 28 });
}

export const answer = (...words) => JSON.parse(hwsim(...words, "--json"));

// A page of three techniques with pictures, written by `run --report`.
export function makePage(name, ...words) {
  const file = inPlace(`${name}.html`);
  hwsim("run", ...scene, "-t", "none,msaa4x,deferred_simple_complex", "-g", "gtx980", "--reference", "4", ...words, "--out", inPlace(name), "--force", "--report", file, "-q");
  return file;
}

export function partsOf(file) {
  const html = readFileSync(file, "utf8");
  const part = (id) => html.match(new RegExp(`<script type="[^"]*" id="${id}">([^<]*)</script>`))[1];
  return { html, data: JSON.parse(part("report-data")), engine: Buffer.from(part("report-engine"), "base64") };
}
