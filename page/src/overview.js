// Charts over all points: error against time, published against predicted, a sweep.
import { chart, Plot } from "./charts.js";
import { element, folded, shown } from "./dom.js";

function pointsOf(page) {
  const { model } = page;
  return model.data.points
    .map((point, i) => {
      const { technique, gpu, frame, image } = point.explanation;
      const [low, high] = frame.interval_ms ?? [frame.time_ms, frame.time_ms];
      return image && { label: technique, gpu, index: i, time: frame.time_ms, low, high, error: image.flip_mean, memory: frame.memory_mib };
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
    const high = Math.max(...points.map((d) => d.time));
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
    this.say.textContent = `${shown(budget)} ms: ${within.length ? `${within[0].label} has the least error` : "nothing is within"}`;
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
        Plot.line(frontOf(points), { x: "time", y: "error", stroke: "#0072b2", strokeDasharray: "4,3" }),
        Plot.ruleY(points, { x1: "low", x2: (d) => Math.min(d.high, this.high), y: "error", stroke: "currentColor", strokeOpacity: 0.45 }),
        Plot.dot(points, { x: "time", y: "error", r: "memory", fill: (d) => (d.time <= budget ? "#56b4e9" : "#b8b8b8"), stroke: "currentColor", fillOpacity: 0.85, title: (d) => `${d.label} on ${d.gpu}: ${shown(d.time)} ms, FLIP ${d.error.toFixed(4)}, ${shown(d.memory)} MiB` }),
        Plot.text(points, { x: "time", y: "error", text: "label", dy: -16, stroke: "var(--paper)", strokeWidth: 3, fill: "currentColor" }),
        Plot.ruleX([budget], { stroke: "#d55e00", strokeWidth: 3 }),
      ],
    });
    this.#drag(svg);
    if (!this.table) {
      this.table = folded("error against time", [{ id: "label", title: "technique" }, { id: "gpu", title: "GPU" }, { id: "time", title: "ms" }, { id: "low", title: "from" }, { id: "high", title: "to" }, { id: "error", title: "FLIP" }, { id: "memory", title: "MiB" }], points);
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

export function drawBelief(mount, page) {
  const rows = page.model.data.published.map((d) => ({ ...d, ratio: d.held_out_ms / d.published_ms }));
  if (rows.length === 0) return;
  const errors = rows.map((d) => 100 * Math.abs(d.ratio - 1)).sort((a, b) => a - b);
  const mean = errors.reduce((a, b) => a + b, 0) / errors.length;
  const gpus = [...new Set(rows.map((d) => d.gpu))];
  mount.append(element("p", { class: "finding" }, `${rows.length} published times on ${gpus.join(", ")}: predictions of fits that had not seen their scene miss them by ${mean.toFixed(0)} % in the mean, ${errors[Math.floor(errors.length / 2)].toFixed(0)} % in the median. The line is equality, the bands are 10 and 20 %.`));
  const low = Math.min(...rows.map((d) => Math.min(d.published_ms, d.held_out_ms))) / 1.5;
  const high = Math.max(...rows.map((d) => Math.max(d.published_ms, d.held_out_ms))) * 1.5;
  const band = (part) => [low, high].map((x) => ({ x, y1: x * (1 - part), y2: x * (1 + part) }));
  const papers = [...new Set(rows.map((d) => d.paper))];
  chart(mount, {
    ariaLabel: "predicted against published times",
    height: 460,
    marginLeft: 60,
    x: { type: "log", label: "published ms", tickFormat: "~r", domain: [low, high], grid: true },
    y: { type: "log", label: "predicted ms", tickFormat: "~r", domain: [low, high], grid: true },
    color: { domain: papers, range: ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00"], legend: true },
    symbol: { domain: papers, legend: false },
    marks: [
      ...[0.2, 0.1].map((part) => Plot.areaY(band(part), { x: "x", y1: "y1", y2: "y2", fill: "currentColor", fillOpacity: 0.08 })),
      Plot.line([{ x: low }, { x: high }], { x: "x", y: "x" }),
      Plot.dot(rows, { x: "published_ms", y: "held_out_ms", stroke: "paper", symbol: "paper", r: 4, title: (d) => `${d.paper}, ${d.technique} on ${d.gpu}, ${d.scene}, ${d.what}: published ${shown(d.published_ms)} ms, predicted ${shown(d.held_out_ms)} ms` }),
    ],
  });
  mount.append(folded("published and predicted", [{ id: "paper", title: "paper" }, { id: "gpu", title: "GPU" }, { id: "technique", title: "technique" }, { id: "scene", title: "scene" }, { id: "what", title: "what" }, { id: "published_ms", title: "published ms" }, { id: "held_out_ms", title: "predicted ms" }, { id: "ratio", title: "ratio" }, { id: "row", title: "row" }], rows));
}

// A sweep: its times along the setting that has the most values, a line for each technique and GPU.
export function drawSweep(mount, page) {
  const rows = (page.model.data.sweep ?? []).filter((row) => typeof row.time_ms === "number");
  if (rows.length < 2) return;
  const axes = Object.keys(rows[0]).filter((id) => id.includes("."));
  const values = (axis) => new Set(rows.map((row) => row[axis]));
  const axis = axes.sort((a, b) => values(b).size - values(a).size)[0];
  if (!axis) return;
  const points = rows.map((row) => ({ x: Number(row[axis]), y: row.time_ms, line: `${row.technique} on ${row.gpu}` }));
  if (points.some((d) => Number.isNaN(d.x))) return;
  chart(mount, {
    ariaLabel: `time along ${axis}`,
    height: 380,
    marginLeft: 60,
    x: { label: axis, grid: true },
    y: { label: "frame, ms", grid: true, zero: true },
    color: { legend: true, scheme: "observable10" },
    marks: [Plot.dot(points, { x: "x", y: "y", stroke: "line", title: (d) => `${d.line}, ${d.x}: ${shown(d.y)} ms` }), axes.length === 1 ? Plot.line(points, { x: "x", y: "y", z: "line", stroke: "line", sort: "x" }) : null],
  });
}

