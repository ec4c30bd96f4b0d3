// Hardware that can be moved: knobs, and the passes of a frame before and after.
import { chart, Plot, unitScale } from "./charts.js";
import { changeText, copy, element, folded, select, shown } from "./dom.js";
import { commandOf, NS_PER_MS, tomlOf } from "./model.js";

const KNOBS = [
  { label: "Core clock", keys: ["core_clock_mhz"], unit: "MHz" },
  { label: "Shader cores", keys: ["shader_cores"] },
  { label: "Lanes of a core", keys: ["fp32_lanes_per_core"] },
  { label: "Rasterizers", keys: ["raster_engines"] },
  { label: "ROPs", keys: ["crop_units"] },
  { label: "Texture rate", keys: ["tex_bilinear_per_clk"], unit: "a clock" },
  { label: "Set-up rate", keys: ["setup_drawn_triangles_per_clk", "setup_culled_triangles_per_clk"], unit: "a clock" },
  { label: "L2", keys: ["l2_size_kib"], unit: "KiB" },
  { label: "Last-level cache", keys: ["llc_size_kib"], unit: "KiB", start: 1024 },
  { label: "L2 bandwidth", keys: ["l2_bytes_per_clk"], unit: "B a clock" },
  { label: "DRAM", keys: ["dram_bandwidth_gb_s"], unit: "GB/s" },
  { label: "DRAM latency", keys: ["dram_latency_cycles"], unit: "cycles" },
  { label: "Cost of a pass", keys: ["pass_overhead_us"], unit: "us" },
];
const SWITCHES = {
  msaa_color_compression: "Compressed multisampled color",
  fast_clear_color: "Fast clear of color",
  fast_clear_depth: "Fast clear of depth",
  depth_offset_forms: "Depth as offsets",
  rop_through_l2: "ROPs behind the L2",
};
const STEPS = 12; // of a slider, each way: a quarter of an octave each

const factorOf = (step) => 2 ** (step / 4);
const stepOf = (factor) => Math.round(4 * Math.log2(factor));

// A slider at a step: a multiple of what the GPU has; where it has none, `start` and its doubles.
const valueAt = ({ start }, base, step) => (base > 0 ? base * factorOf(step) : step > 0 ? start * 2 ** (step - 1) : 0);
const stepAt = ({ start }, base, value) => (base > 0 ? stepOf(value / base) : value > 0 && start ? Math.round(Math.log2(value / start)) + 1 : 0);
const timesText = (factor) => (Math.abs(factor - 1) < 1e-9 ? "as it is" : `x ${shown(factor)}`);

// A value that the key takes: whole, within its range.
export function fitted(key, value) {
  const number = key.type === "whole" ? Math.round(value) : value;
  return Math.min(key.high, Math.max(key.low, number));
}

export class HardwarePanel {
  constructor(mount, page) {
    this.page = page;
    this.controls = element("div", { class: "knobs" });
    this.bars = element("div", { class: "live" });
    mount.append(this.#choices(), element("div", { class: "bench" }, this.controls, this.bars));
    this.#makeKnobs();
  }

  #choices() {
    this.choices = element("div", { class: "choices" });
    return this.choices;
  }

  #makeChoices() {
    const { model, state } = this.page;
    const points = model.data.points.map((_, i) => ({ text: model.label(i) }));
    const gpus = model.data.gpus.map((gpu, i) => {
      const refusal = model.refusal(state.point, i);
      const own = i === model.ownGpu(state.point) ? " (of the point)" : "";
      return { text: `${gpu.title || gpu.id}${own}${refusal && ` - ${refusal}`}`, disabled: Boolean(refusal), title: refusal };
    });
    const ifs = [{ text: "none" }, ...model.data.variations.map((v) => ({ text: `tried: ${v.label}`, disabled: v.point !== state.point })), ...model.data.what_ifs.map((w) => this.#whatIfOption(w))];
    this.choices.replaceChildren(
      select("Frame", points, state.point, (i) => this.page.move({ point: i, gpu: model.ownGpu(i), sets: {} })),
      select("GPU", gpus, state.gpu, (i) => this.page.move({ gpu: i, sets: {} })),
      select("What if", ifs, 0, (i) => this.#take(i)),
    );
  }

  #whatIfOption(whatIf) {
    const refused = Object.keys(whatIf.changes).filter((key) => !this.page.model.keys.has(key));
    const reason = refused.length > 0 ? `needs a new emulation: ${refused[0]}` : "";
    return { text: `${whatIf.name}${reason && ` - ${reason}`}`, disabled: Boolean(reason), title: whatIf.about };
  }

  #take(index) {
    const { model, state } = this.page;
    const { variations, what_ifs: whatIfs } = model.data;
    if (index === 0) return this.page.move({ sets: {} });
    if (index <= variations.length) {
      const gpu = model.ownGpu(state.point);
      const values = model.data.gpus[gpu].values;
      const changed = Object.entries(variations[index - 1].values).filter(([key, value]) => values[key] !== value);
      return this.page.move({ gpu, sets: Object.fromEntries(changed) });
    }
    const sets = {};
    for (const [key, text] of Object.entries(whatIfs[index - 1 - variations.length].changes)) {
      const base = model.data.gpus[state.gpu].values[key];
      sets[key] = text === "true" ? true : text === "false" ? false : text.startsWith("x") ? base * Number(text.slice(1)) : Number(text);
    }
    this.page.move({ sets });
  }

  #makeKnobs() {
    const { page } = this;
    this.sliders = KNOBS.map((knob) => this.#knob(knob));
    this.switches = Object.entries(SWITCHES).map(([key, label]) => {
      const box = element("input", { type: "checkbox", onchange: () => page.set({ [key]: box.checked }) });
      return { key, box, node: element("label", { class: "switch" }, box, label) };
    });
    const greyed = [
      ["Sample counts, conservative raster, multicast", "need a new emulation: they change the frame's work"],
      ["Hierarchical depth, vertex cache", "need a new emulation: they change the frame's work"],
    ];
    const buttons = element(
      "div",
      { class: "buttons" },
      element("button", { type: "button", id: "reset", onclick: () => page.move({ gpu: page.model.ownGpu(page.state.point), sets: {} }) }, "As it was"),
      element("button", { type: "button", id: "copy-toml", onclick: (e) => copy(tomlOf(page.model, page.state), e.target) }, "Copy as TOML"),
      element("button", { type: "button", id: "copy-command", onclick: (e) => copy(commandOf(page.model, page.state), e.target) }, "Copy as command"),
    );
    this.controls.append(
      ...this.sliders.map(({ node }) => node),
      ...this.switches.map(({ node }) => node),
      ...greyed.map(([label, why]) => element("p", { class: "greyed", "aria-disabled": "true" }, element("span", {}, label), element("small", {}, why))),
      buttons,
      this.#allNumbers(),
    );
  }

  #knob(knob) {
    const id = `knob-${knob.keys[0]}`;
    const range = element("input", { type: "range", id, min: -STEPS, max: STEPS, step: 1, "data-key": knob.keys[0] });
    const text = element("output", { for: id });
    range.addEventListener("input", () => {
      const sets = {};
      const { model, state } = this.page;
      for (const key of knob.keys) {
        const base = model.data.gpus[state.gpu].values[key];
        sets[key] = Number(range.value) === 0 ? base : fitted(model.keys.get(key), valueAt(knob, base, Number(range.value)));
      }
      this.page.set(sets);
    });
    return { knob, range, text, node: element("div", { class: "knob" }, element("label", { for: id }, knob.label), range, text) };
  }

  #allNumbers() {
    const { page } = this;
    this.numbers = page.model.data.keys.map((key) => {
      const input =
        key.type === "switch"
          ? element("input", { type: "checkbox", onchange: () => page.set({ [key.name]: input.checked }) })
          : element("input", { type: "number", step: "any", min: key.low, max: key.high, onchange: () => page.set({ [key.name]: fitted(key, Number(input.value)) }) });
      return { key, input, node: element("label", { class: "number", title: key.meaning }, element("span", {}, key.name), input) };
    });
    return element("details", { class: "numbers" }, element("summary", {}, "All numbers of the GPU"), element("div", { class: "grid" }, ...this.numbers.map(({ node }) => node)));
  }

  update() {
    const { model, state } = this.page;
    this.#makeChoices();
    const base = model.data.gpus[state.gpu].values;
    const values = model.values(state);
    for (const { knob, range, text } of this.sliders) {
      const [key] = knob.keys;
      const factor = base[key] > 0 ? values[key] / base[key] : 1;
      range.value = String(Math.max(-STEPS, Math.min(STEPS, stepAt(knob, base[key], values[key]))));
      const against = base[key] > 0 || values[key] === 0 ? timesText(factor) : "where there is none";
      text.textContent = `${shown(values[key], 4).replace(/\.0+$/, "")}${knob.unit ? ` ${knob.unit}` : ""}, ${against}`;
      range.setAttribute("aria-valuetext", text.textContent);
    }
    for (const { key, box } of this.switches) box.checked = Boolean(values[key]);
    for (const { key, input, node } of this.numbers) {
      if (key.type === "switch") input.checked = Boolean(values[key.name]);
      else input.value = String(values[key.name]);
      node.classList.toggle("changed", values[key.name] !== base[key.name]);
    }
    this.#draw();
  }

  #draw() {
    const { model, state, before, after } = this.page;
    const changes = model.changes(state.point, before, after);
    const old = model.frame(state.point, before.gpu, before.sets);
    const now = model.frame(state.point, after.gpu, after.sets);
    const moved = old.timeNs !== now.timeNs;
    const rows = now.passes.map((pass, p) => ({
      pass: pass.name,
      before_ms: old.passes[p].timeNs / NS_PER_MS,
      time_ms: pass.timeNs / NS_PER_MS,
      limiter: pass.limiter,
      before_limiter: old.passes[p].limiter,
      change: changeText(changes[p]),
    }));
    this.bars.replaceChildren(this.#headline(now, old, changes.at(-1), moved));
    const names = rows.map((row, i) => `${row.pass}${rows.findIndex((r) => r.pass === row.pass) === i ? "" : ` ${i}`}`);
    rows.forEach((row, i) => (row.name = names[i]));
    const units = unitScale(model.engine.units.filter((unit) => rows.some((row) => row.limiter === unit)));
    chart(this.bars, {
      ariaLabel: "time of each pass before and after",
      height: 30 * rows.length + 60,
      marginRight: this.bars.clientWidth < 560 ? 130 : 190,
      x: { label: "ms", grid: true, zero: true },
      y: { label: null, domain: names },
      color: { ...units, legend: true },
      marks: [
        Plot.barX(rows, { x: "time_ms", y: "name", fill: "limiter", insetTop: 5, insetBottom: 5, title: (d) => `${d.pass}: ${shown(d.time_ms, 4)} ms, limited by ${d.limiter}` }),
        Plot.barX(rows, { x: "before_ms", y: "name", fill: "none", stroke: "currentColor", strokeDasharray: "3,2", strokeWidth: moved ? 1.2 : 0, insetTop: 2, insetBottom: 2 }),
        Plot.text(rows, { x: (d) => Math.max(d.time_ms, d.before_ms), y: "name", dx: 6, textAnchor: "start", text: (d) => (moved ? `${d.limiter}  ${d.change}` : `${d.limiter}  ${shown(d.time_ms)} ms`) }),
        Plot.ruleX([0]),
      ],
    });
    this.bars.append(
      folded("passes on this hardware", [
        { id: "pass", title: "pass" },
        { id: "before_ms", title: "before, ms" },
        { id: "time_ms", title: "ms" },
        { id: "before_limiter", title: "limiter before" },
        { id: "limiter", title: "limiter" },
        { id: "change", title: "change, 90 %" },
      ], rows),
    );
  }

  #headline(now, old, change, moved) {
    const time = element("strong", { id: "frame-ms", "data-v": String(now.timeNs / NS_PER_MS) }, `${shown(now.timeNs / NS_PER_MS)} ms`);
    const range = now.interval ? ` [${shown(now.interval[0] / NS_PER_MS)}, ${shown(now.interval[1] / NS_PER_MS)}]` : "";
    const faster = change.ratio < 1 ? "faster" : "slower";
    const text = moved
      ? ` ${now.support}; it was ${shown(old.timeNs / NS_PER_MS)} ms: ${changeText(change)}, ${faster}.`
      : ` ${now.support}, on the hardware of the point. Move something.`;
    return element("div", { class: "headline", "aria-live": "polite" }, element("p", {}, time, range, element("span", { class: "support" }, text)));
  }
}

