// The report's page: data, engine and panels together, and what is set in the address.
import { addCsvButtons, copy, element } from "./dom.js";
import { bytesOfBase64, Engine } from "./engine.js";
import { HardwarePanel } from "./hardware.js";
import { Model } from "./model.js";
import { drawBelief, drawResiduals, drawSweep, ParetoPanel } from "./overview.js";
import { PicturePanel } from "./pictures.js";
import { drawBytes, drawFlow, drawMemory, drawRoofline, drawTornado, drawUnits } from "./studies.js";

const STUDIES = { units: drawUnits, bytes: drawBytes, roofline: drawRoofline, tornado: drawTornado, memory: drawMemory, flow: drawFlow };
const SETTLED_MS = 120;

const mountOf = (name) => document.getElementById(`mount-${name}`);

class Page {
  constructor(model) {
    this.model = model;
    this.state = this.#fromAddress();
    this.panels = [];
    this.readSettled = null;
  }

  get before() {
    return { gpu: this.model.ownGpu(this.state.point), sets: {} };
  }
  get after() {
    return { gpu: this.state.gpu, sets: this.state.sets };
  }

  // "#point=1&gpu=gtx980&dram_bandwidth_gb_s=448": what cannot be is left out.
  #fromAddress() {
    const words = new URLSearchParams(location.hash.slice(1));
    const { data, keys } = this.model;
    if (data.points.length === 0) return {};
    const number = Number(words.get("point") ?? 0);
    const point = Number.isInteger(number) && data.points[number] ? number : 0;
    const named = data.gpus.findIndex((gpu) => gpu.hash === words.get("gpu"));
    const gpu = named >= 0 && !this.model.refusal(point, named) ? named : this.model.ownGpu(point);
    const sets = {};
    for (const [name, text] of words) {
      const key = keys.get(name);
      const value = key?.type === "switch" ? text === "true" : Number(text);
      if (key && (key.type === "switch" || (value >= key.low && value <= key.high))) sets[name] = value;
    }
    return { point, gpu, sets };
  }

  #toAddress() {
    const { point, gpu, sets } = this.state;
    const words = new URLSearchParams({ point, gpu: this.model.data.gpus[gpu].hash, ...sets });
    history.replaceState(null, "", `#${words}`);
  }

  set(sets) {
    const own = this.model.data.gpus[this.state.gpu].values;
    const all = { ...this.state.sets, ...sets };
    this.move({ sets: Object.fromEntries(Object.entries(all).filter(([key, value]) => own[key] !== value)) });
  }

  move(change) {
    Object.assign(this.state, change);
    if (this.model.refusal(this.state.point, this.state.gpu)) this.state.gpu = this.model.ownGpu(this.state.point);
    this.#toAddress();
    this.hardware?.update();
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.#redraw(), SETTLED_MS);
  }

  start() {
    guard("residuals", (mount) => drawResiduals(mount, this));
    guard("belief", (mount) => drawBelief(mount, this));
    if (this.model.data.points.length > 0) this.#startFrames();
    else this.#ready();
    addEventListener("beforeprint", () => document.querySelectorAll("details.data").forEach((node) => (node.open = true)));
  }

  // What shows frames that can be moved.
  #startFrames() {
    guard("pareto", (mount) => new ParetoPanel(mount, this));
    guard("pictures", (mount) => new PicturePanel(mount, this));
    guard("sweep", (mount) => drawSweep(mount, this));
    if (this.model.engine) guard("hardware", (mount) => (this.hardware = new HardwarePanel(mount, this)));
    this.hardware?.update();
    this.#redraw();
    addEventListener("hashchange", () => this.move(this.#fromAddress()));
  }

  #redraw() {
    for (const [name, draw] of Object.entries(STUDIES))
      if (this.model.engine)
        guard(name, (mount) => {
          mount.replaceChildren();
          draw(mount, this);
        });
    this.#ready();
  }

  #ready() {
    addCsvButtons(document);
    document.documentElement.dataset.drawn = JSON.stringify(this.state);
  }
}

// A panel that fails leaves its static tables, and says so.
function guard(name, draw) {
  const mount = mountOf(name);
  if (!mount) return;
  try {
    draw(mount);
    mount.parentElement.classList.add("live");
  } catch (error) {
    console.error(error);
    mount.replaceChildren(element("p", { class: "missing" }, `This panel could not be drawn: ${error.message}`));
  }
}

async function engineOfPage() {
  const text = document.getElementById("report-engine")?.textContent.trim();
  return text ? Engine.load(bytesOfBase64(text)) : null;
}

// Control characters, and what turns the direction of writing, as hwsim's printable() shows them: what is copied from the
// page goes into terminals.
const UNPRINTABLE = /[\u0000-\u0008\u000b\u000c\u000e-\u001f\u007f-\u009f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ufeff]/g;
function printable(_, value) {
  if (typeof value !== "string") return value;
  return value.replace(UNPRINTABLE, (c) => {
    const code = c.charCodeAt(0);
    return code < 0x100 ? `\\x${code.toString(16).padStart(2, "0")}` : `\\u${code.toString(16).padStart(4, "0")}`;
  });
}

async function main() {
  const data = JSON.parse(document.getElementById("report-data").textContent, printable);
  const engine = await engineOfPage();
  const page = new Page(new Model(data, engine));
  window.hwsimReport = page; // for the console, and for tests
  page.start();
  const command = document.getElementById("command");
  if (command) {
    const button = element("button", { type: "button", class: "copy" }, "Copy");
    button.addEventListener("click", () => copy(command.textContent, button));
    command.after(button);
  }
}

main().catch((error) => {
  console.error(error);
  document.getElementById("limits")?.append(element("p", { class: "missing" }, `Scripts failed: ${error.message}`));
});
