// Charts over all points: error against time, published against predicted, a paper's errors, a sweep.
import { chart, Plot } from "./charts.js";
import { element, folded, shown } from "./dom.js";

function pointsOf(page) {
  const { model } = page;
  const severalGpus = new Set(model.data.points.map((point) => point.explanation.gpu)).size > 1;
  return model.data.points
    .map((point, i) => {
      const { technique, gpu, frame, image } = point.explanation;
      const [low, high] = frame.interval_ms ?? [frame.time_ms, frame.time_ms];
      const place = [severalGpus ? gpu : "", point.view].filter(Boolean).join(", ");
      return image && { label: technique, place, name: place ? `${technique} (${place})` : technique, gpu, view: point.view, index: i, time: frame.time_ms, low, high, error: image.flip_mean, memory: frame.memory_mib };
    })
    .filter(Boolean);
}

// Nobody else is both faster and closer.
function frontOf(points) {
  const front = points.filter((a) => !points.some((b) => b !== a && b.time <= a.time && b.error <= a.error && (b.time < a.time || b.error < a.error)));
  return front.sort((a, b) => a.time - b.time);
}

export class ParetoPanel {
  constructor(mount, page) {
    this.mount = mount;
    this.page = page;
    const points = pointsOf(page);
    if (points.length < 2) {
      mount.append(element("p", {}, "Fewer than two points have an image and a reference: run with --reference."));
      return;
    }
    this.points = points;
    this.places = [...new Set(points.map((d) => d.place))];
    const high = Math.max(...points.map((d) => Math.min(d.high, 2 * d.time)));
    this.line = element("input", { type: "range", id: "budget", min: 0, max: 1000, value: 1000 });
    this.line.addEventListener("input", () => this.#draw());
    this.say = element("output", { for: "budget" });
    this.high = high * 1.05;
    this.box = element("div");
    mount.append(element("label", { class: "budget", for: "budget" }, "Budget for a frame ", this.line, this.say), this.box);
    this.#draw();
  }

  get budget() {
    return (this.high * Number(this.line.value)) / 1000;
  }

  #draw() {
    const { points, budget } = this;
    const within = points.filter((d) => d.time <= budget).sort((a, b) => a.error - b.error);
    this.say.textContent = `${shown(budget)} ms: ${within.length ? `${within[0].name} has the least error` : "nothing is within"}`;
    this.box.replaceChildren();
    const svg = chart(this.box, {
      ariaLabel: "error of the image against time",
      height: 420,
      marginLeft: 60,
      marginRight: 90,
      x: { label: "frame, ms", grid: true, domain: [0, this.high], clamp: true },
      y: { label: "error (FLIP)", grid: true, insetTop: 34, insetBottom: 24 },
      r: { range: [4, 22], domain: [0, Math.max(...points.map((d) => d.memory))] },
      marks: [
        ...this.places.map((place) => Plot.line(frontOf(points.filter((d) => d.place === place)), { x: "time", y: "error", stroke: "#0072b2", strokeDasharray: "4,3" })),
        Plot.ruleY(points, { x1: "low", x2: (d) => Math.min(d.high, this.high), y: "error", stroke: "currentColor", strokeOpacity: 0.45 }),
        Plot.dot(points, { x: "time", y: "error", r: "memory", fill: (d) => (d.time <= budget ? "#56b4e9" : "#b8b8b8"), stroke: "currentColor", fillOpacity: 0.85, title: (d) => `${d.name}: ${shown(d.time)} ms, FLIP ${d.error.toFixed(4)}, ${shown(d.memory)} MiB` }),
        Plot.text(points, { x: "time", y: "error", text: "name", dy: -16, stroke: "var(--paper)", strokeWidth: 3, fill: "currentColor" }),
        Plot.ruleX([budget], { stroke: "#d55e00", strokeWidth: 3 }),
      ],
    });
    this.#drag(svg);
    if (!this.table) {
      this.table = folded("error against time", [{ id: "label", title: "technique" }, { id: "gpu", title: "GPU" }, { id: "view", title: "view" }, { id: "time", title: "ms" }, { id: "low", title: "from" }, { id: "high", title: "to" }, { id: "error", title: "FLIP" }, { id: "memory", title: "MiB" }], points);
      this.mount.append(this.table);
    }
  }

  // The line follows the pointer; the slider does the same for keyboards.
  #drag(svg) {
    const root = svg.tagName === "svg" ? svg : svg.querySelector("svg");
    const scale = svg.scale("x");
    root.style.touchAction = "none";
    root.style.cursor = "ew-resize";
    const move = (event) => {
      if (event.buttons !== 1) return;
      const box = root.getBoundingClientRect();
      const x = ((event.clientX - box.left) * root.viewBox.baseVal.width) / box.width;
      this.line.value = String(Math.round((1000 * scale.invert(x)) / this.high));
      this.#draw();
    };
    root.addEventListener("pointerdown", move);
    root.addEventListener("pointermove", move);
  }
}

const PAPER_COLORS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];

// Dots beside the line of equality and its bands of 10 and 20 %; those that are not the report's own are faint.
function drawAgainst(mount, rows, { x, y, low, high, group, unit, label, title }) {
  const ends = rows.flatMap((d) => [d[x], d[y]]).filter((v) => v > 0);
  const from = Math.min(...ends) / 1.5;
  const to = Math.max(...ends) * 1.5;
  const band = (part) => [from, to].map((v) => ({ v, y1: v * (1 - part), y2: v * (1 + part) }));
  const groups = [...new Set(rows.map((d) => d[group]))];
  const faint = rows.some((d) => d.own) ? rows.filter((d) => d.own === false) : [];
  const strong = rows.filter((d) => !faint.includes(d));
  const clamp = (v) => Math.min(to, Math.max(from, v));
  const dots = (some, opacity) => Plot.dot(some, { x, y, stroke: group, symbol: group, r: 4, strokeOpacity: opacity, title });
  chart(mount, {
    ariaLabel: label,
    title: label,
    height: 420,
    marginLeft: 60,
    x: { type: "log", label: `published${unit}`, tickFormat: "~r", domain: [from, to], grid: true },
    y: { type: "log", label: `predicted${unit}`, tickFormat: "~r", domain: [from, to], grid: true },
    color: { domain: groups, range: PAPER_COLORS },
    symbol: { domain: groups, legend: true },
    marks: [
      ...[0.2, 0.1].map((part) => Plot.areaY(band(part), { x: "v", y1: "y1", y2: "y2", fill: "currentColor", fillOpacity: 0.08 })),
      Plot.line([{ v: from }, { v: to }], { x: "v", y: "v" }),
      low ? Plot.ruleX(rows.filter((d) => low(d) != null), { x, y1: (d) => clamp(low(d)), y2: (d) => clamp(high(d)), stroke: group, strokeOpacity: 0.3 }) : null,
      dots(faint, 0.3),
      dots(strong, 1),
    ],
  });
}

const errorText = (e) => `${e.mape_pct.toFixed(0)} % in the mean, ${e.median_ape_pct.toFixed(0)} % in the median (${e.count})`;

export function drawBelief(mount, page) {
  const { published: times, published_ratios: ratios, external, errors } = page.model.data;
  if (times.length === 0) return;
  const named = (part) => errors.find((e) => e.what.startsWith(part));
  const found = [
    ["Times", named("times of")],
    ["ratios of two techniques", named("ratios of")],
    ["other renderers' times", named("other renderers")],
  ].filter(([, e]) => e);
  mount.append(element("p", { class: "finding" }, `Predictions miss what no fit saw by: ${found.map(([name, e]) => `${name} ${errorText(e)}`).join("; ")}. The line is equality, the bands are 10 and 20 %.${times.some((d) => d.own) ? " Faint: other GPUs." : ""}`));
  drawAgainst(mount, times, { x: "published_ms", y: "held_out_ms", group: "paper", unit: ", ms", label: "Times, by fits without their scene", title: (d) => `${d.paper}, ${d.technique} on ${d.gpu}, ${d.scene}, ${d.what}: published ${shown(d.published_ms)} ms, predicted ${shown(d.held_out_ms)} ms` });
  if (ratios.length > 0) drawAgainst(mount, ratios, { x: "published", y: "held_out", group: "paper", unit: " ratio", label: "Ratios of two techniques, by fits without their scene", title: (d) => `${d.paper}, ${d.techniques} on ${d.gpu}, ${d.scene}, ${d.what}: published ${shown(d.published)}, predicted ${shown(d.held_out)}` });
  if (external.length > 0) drawAgainst(mount, external, { x: "published_ms", y: "predicted_ms", low: (d) => d.interval_ms?.[0], high: (d) => d.interval_ms?.[1], group: "gpu", unit: ", ms", label: "Other renderers, which no fit saw, with 90 % intervals", title: (d) => `${d.technique} on ${d.gpu}, ${d.msaa} samples, ${d.lights} lights, ${d.pass}: published ${shown(d.published_ms)} ms, predicted ${shown(d.predicted_ms)} ms` });
}

// A paper's times: predicted over published by stage and technique, and against each other.
export function drawResiduals(mount, page) {
  const rows = (page.model.data.reproduction ?? []).filter((d) => d.unit === "ms" && d.predicted > 0 && d.published_absolute > 0);
  if (rows.length === 0) return;
  const points = rows.map((d) => ({ ...d, stage: `${d.technique}${d.surfaces_or_aggregates} ${d.pass}`, error: 100 * (d.predicted / d.published_absolute - 1) }));
  const stages = [...new Set(points.map((d) => d.stage))];
  const scenes = [...new Set(points.map((d) => d.scene))];
  const title = (d) => `${d.scene}, ${d.stage}, ${d.msaa}x: published ${shown(d.published_absolute)} ms, predicted ${shown(d.predicted)} ms`;
  chart(mount, {
    ariaLabel: "error of each predicted time by stage",
    height: 22 * stages.length + 80,
    marginLeft: Math.min(280, (mount.clientWidth || 900) * 0.45),
    x: { label: "predicted over published, %", grid: true },
    y: { label: null, domain: stages },
    color: { domain: scenes, range: PAPER_COLORS },
    symbol: { domain: scenes, legend: true },
    marks: [
      Plot.rectX([{ a: -20, b: 20 }, { a: -10, b: 10 }], { x1: "a", x2: "b", fill: "currentColor", fillOpacity: 0.07 }),
      Plot.ruleX([0]),
      Plot.dot(points, { x: "error", y: "stage", stroke: "scene", symbol: "scene", r: 4, title }),
    ],
  });
  drawAgainst(mount, points, { x: "published_absolute", y: "predicted", low: (d) => d.lo, high: (d) => d.hi, group: "scene", unit: ", ms", label: "Predicted against published times, with 90 % intervals", title });
}

const withoutAxis = (row, axes, axis) => JSON.stringify([row.technique, row.gpu, ...axes.filter((other) => other !== axis).map((other) => row[other])]);

// By how much the time moves along an axis while all else stays, in the mean.
function reachOf(rows, axes, axis) {
  const groups = new Map();
  for (const row of rows) {
    const key = withoutAxis(row, axes, axis);
    const [low, high] = groups.get(key) ?? [Infinity, -Infinity];
    groups.set(key, [Math.min(low, row.time_ms), Math.max(high, row.time_ms)]);
  }
  return [...groups.values()].reduce((all, [low, high]) => all + (high - low), 0) / groups.size;
}

// A sweep: its times along the setting that moves them most; a line for each technique, GPU and value of the others.
export function drawSweep(mount, page) {
  const rows = (page.model.data.sweep ?? []).filter((row) => typeof row.time_ms === "number");
  if (rows.length < 2) return;
  const axes = Object.keys(rows[0]).filter((id) => id.includes(".") && rows.every((row) => !Number.isNaN(Number(row[id]))));
  if (axes.length === 0) return;
  const reaches = new Map(axes.map((axis) => [axis, reachOf(rows, axes, axis)]));
  const [axis, ...others] = [...axes].sort((a, b) => reaches.get(b) - reaches.get(a));
  const points = rows.map((row) => ({ x: Number(row[axis]), y: row.time_ms, line: `${row.technique} on ${row.gpu}`, z: withoutAxis(row, axes, axis), rest: others.map((other) => `${other.replace(/^.*\./, "")} ${shown(Number(row[other]), 4)}`).join(", ") }));
  const ends = Object.values(Object.fromEntries([...points].sort((a, b) => a.x - b.x).map((d) => [d.z, d])));
  const few = ends.length <= 12 && others.length > 0 && others.every((other) => reaches.get(other) > 0.01 * reaches.get(axis));
  chart(mount, {
    ariaLabel: `time along ${axis}`,
    height: 380,
    marginLeft: 60,
    marginRight: few ? 190 : 30,
    x: { label: axis, grid: true },
    y: { label: "frame, ms", grid: true, zero: true },
    color: { legend: true, scheme: "observable10" },
    marks: [
      Plot.line(points, { x: "x", y: "y", z: "z", stroke: "line", strokeOpacity: 0.7, sort: "x" }),
      Plot.dot(points, { x: "x", y: "y", stroke: "line", title: (d) => `${d.line}, ${axis} ${shown(d.x, 4)}${d.rest && `, ${d.rest}`}: ${shown(d.y)} ms` }),
      few ? Plot.text(ends, { x: "x", y: "y", text: "rest", dx: 8, textAnchor: "start" }) : null,
    ],
  });
  const still = others.filter((other) => reaches.get(other) <= 0.01 * reaches.get(axis));
  if (still.length > 0) mount.append(element("p", { class: "finding" }, `${still.join(", ")}: the time hardly moves along ${still.length > 1 ? "these" : "this"}.`));
}
