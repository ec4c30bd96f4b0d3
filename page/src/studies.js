// What a frame does on the hardware that is set: units, bytes, roofline, sensitivities, memory, data flow.
import { chart, Plot, streamScale, unitColor } from "./charts.js";
import { folded, shown } from "./dom.js";

const BYTES_PER_MB = 1e6;
const BYTES_PER_MIB = 1024 * 1024;

const countersOf = (page) => page.model.data.points[page.state.point].explanation.passes.map((pass) => pass.counters);
const frameOf = (page) => page.model.frame(page.state.point, page.state.gpu, page.state.sets);

// Two passes of one name would share a row.
function rowNames(passes) {
  const seen = new Map();
  return passes.map(({ name }) => {
    const count = (seen.get(name) ?? 0) + 1;
    seen.set(name, count);
    return count > 1 ? `${name} ${count}` : name;
  });
}

export function drawUnits(mount, page) {
  const { passes } = frameOf(page);
  const names = rowNames(passes);
  const units = page.model.engine.units.filter((unit) => passes.some((pass) => pass.share[unit] > 0.005));
  const cells = passes.flatMap((pass, p) => units.map((unit) => ({ pass: names[p], unit, share: pass.share[unit] })));
  chart(mount, {
    ariaLabel: "share of each pass in which each unit has to work",
    height: 26 * passes.length + 80,
    padding: 0.04,
    x: { domain: units, axis: "top", label: null, tickRotate: mount.clientWidth < 620 ? -60 : 0 },
    marginTop: 50,
    y: { domain: names, label: null },
    color: { type: "threshold", domain: [0.2, 0.4, 0.6, 0.8], range: ["var(--sol-0)", "var(--sol-1)", "var(--sol-2)", "var(--sol-3)", "var(--sol-4)"], legend: false },
    marks: [
      Plot.cell(cells, { x: "unit", y: "pass", fill: "share", title: (d) => `${d.pass}, ${d.unit}: ${(100 * d.share).toFixed(1)} %` }),
      Plot.text(cells.filter((d) => d.share >= 0.005), { x: "unit", y: "pass", text: (d) => (100 * d.share).toFixed(0), fill: (d) => (d.share > 0.8 ? "#fff" : d.share > 0.6 ? "#000" : "currentColor") }),
    ],
  });
  const columns = [{ id: "pass", title: "pass" }, { id: "limiter", title: "limiter" }, ...units.map((unit) => ({ id: unit, title: `${unit} %` }))];
  const rows = passes.map((pass, p) => ({ pass: names[p], limiter: pass.limiter, ...Object.fromEntries(units.map((unit) => [unit, 100 * pass.share[unit]])) }));
  mount.append(folded("units and passes", columns, rows));
}

export function drawBytes(mount, page) {
  const { passes } = frameOf(page);
  const names = rowNames(passes);
  const streams = page.model.engine.streams;
  const parts = passes.flatMap((pass, p) =>
    streams.flatMap((stream) => [
      { pass: names[p], stream, way: "read", mb: pass.read[stream] / BYTES_PER_MB },
      { pass: names[p], stream, way: "write", mb: -pass.write[stream] / BYTES_PER_MB },
    ]),
  );
  chart(mount, {
    ariaLabel: "bytes from and to DRAM by stream",
    height: 26 * passes.length + 70,
    x: { label: "written   MB   read", grid: true, tickFormat: (d) => String(Math.abs(d)), labelAnchor: "center" },
    y: { label: null, domain: names },
    color: { ...streamScale(streams.filter((stream) => parts.some((d) => d.stream === stream && d.mb !== 0))), legend: true },
    marks: [
      Plot.barX(parts.filter((d) => d.mb !== 0), { x: "mb", y: "pass", fill: "stream", title: (d) => `${d.pass}: ${d.stream} ${d.way} ${shown(Math.abs(d.mb))} MB` }),
      Plot.ruleX([0]),
    ],
  });
  const columns = [{ id: "pass", title: "pass" }, ...streams.flatMap((stream) => [{ id: `${stream}_read_mb`, title: `${stream} read` }, { id: `${stream}_write_mb`, title: `${stream} write` }])];
  const rows = passes.map((pass, p) => ({ pass: names[p], ...Object.fromEntries(streams.flatMap((stream) => [[`${stream}_read_mb`, pass.read[stream] / BYTES_PER_MB], [`${stream}_write_mb`, pass.write[stream] / BYTES_PER_MB]])) }));
  mount.append(folded("DRAM MB by stream", columns, rows));
}

const sum = (numbers) => Object.values(numbers).reduce((all, value) => all + value, 0);

export function drawRoofline(mount, page) {
  const { passes } = frameOf(page);
  const values = page.model.values(page.state);
  const counters = countersOf(page);
  const clockGhz = (values.core_clock_mhz * values.shader_clock_ratio) / 1000;
  const peak = values.shader_cores * values.fp32_lanes_per_core * clockGhz; // lane operations a ns
  const bandwidth = values.dram_bandwidth_gb_s; // bytes a ns
  const names = rowNames(passes);
  const rows = passes
    .map((pass, p) => {
      const operations = (counters[p]["shader.alu_lane_ops"] ?? 0) + (counters[p]["vs.alu_lane_ops"] ?? 0);
      const bytes = sum(pass.read) + sum(pass.write);
      return { pass: names[p], limiter: pass.limiter, operations, bytes, intensity: operations / bytes, rate: operations / pass.timeNs };
    })
    .filter((row) => row.operations > 0 && row.bytes > 0 && row.rate > 0);
  if (rows.length === 0) return;
  const low = Math.min(peak / bandwidth, ...rows.map((row) => row.intensity)) / 3;
  const high = Math.max(peak / bandwidth, ...rows.map((row) => row.intensity)) * 3;
  const roof = [low, peak / bandwidth, high].map((x) => ({ x, y: Math.min(peak, x * bandwidth) }));
  chart(mount, {
    ariaLabel: "arithmetic of each pass against its bytes",
    height: 380,
    marginLeft: 60,
    x: { type: "log", label: "lane operations a byte of DRAM", domain: [low, high], grid: true, tickFormat: "~r" },
    y: { type: "log", label: "lane operations a ns", tickFormat: "~r", domain: [Math.min(...rows.map((row) => row.rate)) / 2, peak * 2], grid: true },
    marks: [
      Plot.line(roof, { x: "x", y: "y", strokeWidth: 2 }),
      Plot.dot(rows, { x: "intensity", y: "rate", r: 6, fill: (d) => unitColor(d.limiter), stroke: "var(--paper)", title: (d) => `${d.pass}: ${shown(d.intensity)} operations a byte, ${shown((100 * d.rate) / peak)} % of the peak` }),
      Plot.text(rows, { x: "intensity", y: "rate", text: "pass", dx: 9, textAnchor: "start", stroke: "var(--paper)", fill: "currentColor", strokeWidth: 3 }),
      Plot.text([{ x: high, y: peak }], { x: "x", y: "y", text: () => `peak ${shown(peak)}`, dy: -9, textAnchor: "end" }),
    ],
  });
  const columns = [{ id: "pass", title: "pass" }, { id: "operations", title: "lane operations" }, { id: "bytes", title: "DRAM bytes" }, { id: "intensity", title: "operations a byte" }, { id: "rate", title: "operations a ns" }];
  mount.append(folded("roofline", columns, rows));
}

const TORNADO_ROWS = 14;

export function drawTornado(mount, page) {
  const { state, model } = page;
  const all = model.elasticities(state.point, state.gpu, state.sets);
  const rows = all.slice(0, TORNADO_ROWS);
  chart(mount, {
    ariaLabel: "percent of time for one percent of each number",
    height: 24 * rows.length + 50,
    marginLeft: Math.min(260, (mount.clientWidth || 900) * 0.45),
    x: { label: "% of the frame's time for 1 % more", grid: true, insetLeft: 48, insetRight: 48 },
    y: { label: null, domain: rows.map((row) => row.key) },
    marks: [
      Plot.barX(rows, { x: "elasticity", y: "key", fill: (d) => (d.elasticity < 0 ? "var(--faster)" : "var(--slower)"), title: (d) => `${d.key} = ${shown(d.value, 4)}: ${d.elasticity.toFixed(3)}` }),
      Plot.text(rows.filter((d) => d.elasticity > 0), { x: "elasticity", y: "key", text: (d) => d.elasticity.toFixed(3), textAnchor: "start", dx: 4 }),
      Plot.text(rows.filter((d) => d.elasticity <= 0), { x: "elasticity", y: "key", text: (d) => d.elasticity.toFixed(3), textAnchor: "end", dx: -4 }),
      Plot.ruleX([0]),
    ],
  });
  const columns = [{ id: "key", title: "number of the GPU" }, { id: "value", title: "value" }, { id: "elasticity", title: "% of time for 1 % more" }];
  mount.append(folded("what matters", columns, all));
}

export function drawMemory(mount, page) {
  const { passes, parts } = page.model.data.points[page.state.point].memory;
  const live = passes.map((_, p) => parts.filter((part) => part.first <= p && p <= part.last).reduce((all, part) => all + part.bytes, 0) / BYTES_PER_MIB);
  const peak = Math.max(...live);
  const rows = parts.map((part) => ({ part: part.name, mib: part.bytes / BYTES_PER_MIB, first: part.first, end: part.last + 1, from: passes[part.first], to: passes[part.last] })).sort((a, b) => b.mib - a.mib);
  const shownRows = rows.slice(0, 16);
  const ticks = { ticks: passes.map((_, p) => p + 0.5), tickFormat: (d) => passes[Math.floor(d)], tickRotate: -35, domain: [0, passes.length], label: null };
  chart(mount, {
    ariaLabel: "memory that is alive in each pass",
    height: 200,
    marginLeft: 60,
    marginBottom: 80,
    x: ticks,
    y: { label: "MiB alive", grid: true, zero: true },
    marks: [
      Plot.rectY(live.map((mib, p) => ({ p, mib })), { x1: (d) => d.p, x2: (d) => d.p + 1, y: "mib", fill: (d) => (d.mib === peak ? "#d55e00" : "#56b4e9"), insetLeft: 1, insetRight: 1, title: (d) => `${passes[d.p]}: ${shown(d.mib)} MiB` }),
      Plot.text(live.map((mib, p) => ({ p, mib })), { x: (d) => d.p + 0.5, y: "mib", dy: -7, text: (d) => shown(d.mib) }),
    ],
  });
  chart(mount, {
    ariaLabel: "when each image and buffer is alive",
    height: 22 * shownRows.length + 80,
    marginBottom: 70,
    x: ticks,
    y: { label: null, domain: shownRows.map((row) => row.part) },
    marks: [
      Plot.barX(shownRows, { x1: "first", x2: "end", y: "part", fill: "#56b4e9", insetTop: 2, insetBottom: 2, title: (d) => `${d.part}: ${shown(d.mib)} MiB` }),
      Plot.text(shownRows, { x: (d) => (d.first + d.end) / 2, y: "part", text: (d) => `${shown(d.mib)}`, fill: "#000" }),
    ],
  });
  mount.append(folded("memory", [{ id: "part", title: "image or buffer" }, { id: "mib", title: "MiB" }, { id: "from", title: "from pass" }, { id: "to", title: "to pass" }], rows));
}

const STAGES = [
  ["set-up, triangles", "setup.in_primitives", null, "setup.out_primitives"],
  ["coarse depth, tiles", "hiz.tested_tiles", "hiz.killed_tiles", null],
  ["early depth, samples", "zrop.early_z_tested_samples", "zrop.early_z_killed_samples", null],
  ["shading, fragments", "ps.invocations", "ps.discarded_invocations", null],
  ["late depth, samples", "zrop.late_z_tested_samples", "zrop.late_z_killed_samples", null],
  ["color, samples", "crop.written_samples", null, "crop.written_samples"],
];

export function drawFlow(mount, page) {
  const counters = countersOf(page);
  const count = (id) => counters.reduce((all, pass) => all + (pass[id] ?? 0), 0);
  const rows = STAGES.map(([stage, input, killed, output]) => {
    const entered = count(input);
    const out = output ? count(output) : entered - count(killed);
    return { stage, in: entered, killed: entered - out, out };
  }).filter((row) => row.in > 0);
  const parts = rows.flatMap((row) => [
    { stage: row.stage, what: "goes on", count: row.out, share: row.out / row.in },
    { stage: row.stage, what: "killed", count: row.killed, share: row.killed / row.in },
  ]);
  chart(mount, {
    ariaLabel: "what goes on and what is killed at each stage",
    height: 34 * rows.length + 70,
    x: { label: "% of what came in", percent: true, grid: true },
    y: { label: null, domain: rows.map((row) => row.stage) },
    color: { domain: ["goes on", "killed"], range: ["#0072b2", "#e69f00"], legend: true },
    marks: [
      Plot.barX(parts, { x: "share", y: "stage", fill: "what", insetTop: 3, insetBottom: 3, title: (d) => `${d.stage}: ${d.count.toLocaleString("en")} ${d.what}` }),
      Plot.text(rows, { x: 0, y: "stage", dx: 8, textAnchor: "start", fill: "#fff", text: (d) => `in ${d.in.toLocaleString("en")}, killed ${((100 * d.killed) / d.in).toFixed(0)} %` }),
    ],
  });
  mount.append(folded("raster data flow", [{ id: "stage", title: "stage" }, { id: "in", title: "in" }, { id: "killed", title: "killed" }, { id: "out", title: "out" }], rows));
}

