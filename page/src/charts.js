// What all charts share: one color for each unit and stream, text in the page's own colors.
import * as Plot from "@observablehq/plot";

// Okabe and Ito's colors, which color-blind readers tell apart, then muted ones of Tol's for what is rarer.
const UNIT_COLORS = {
  shader: "#0072b2",
  dram: "#d55e00",
  crop: "#009e73",
  zrop: "#cc79a7",
  tex: "#56b4e9",
  l2: "#e69f00",
  raster: "#b8a800",
  fe: "#8a8f98",
  setup: "#882255",
  hiz: "#aa4499",
  vs: "#117733",
  ia: "#44aa99",
  resolve: "#999933",
};
const STREAM_COLORS = {
  depth: "#cc79a7",
  color: "#009e73",
  texture: "#56b4e9",
  storage: "#0072b2",
  vertex: "#e69f00",
  index: "#b8a800",
  constant: "#8a8f98",
  shader: "#882255",
  other: "#999933",
};
const SPARE = ["#661100", "#6699cc", "#888888", "#332288"];

const scale = (colors) => (names) => ({
  domain: names,
  range: names.map((name, i) => colors[name] ?? SPARE[i % SPARE.length]),
});
export const unitScale = scale(UNIT_COLORS);
export const streamScale = scale(STREAM_COLORS);
export const unitColor = (name) => UNIT_COLORS[name] ?? SPARE[0];

export function chart(mount, options) {
  const width = Math.max(300, Math.min(1080, mount.clientWidth || 900));
  const small = width < 560;
  const node = Plot.plot({
    width,
    marginLeft: options.marginLeft ?? (small ? 96 : 150),
    marginBottom: 42,
    style: { background: "transparent", color: "inherit", fontSize: "13px", overflow: "visible" },
    ...options,
  });
  const box = document.createElement("div");
  box.className = "chart";
  box.setAttribute("role", "img");
  box.setAttribute("aria-label", options.ariaLabel ?? options.title ?? "chart");
  box.append(node);
  mount.append(box);
  return node;
}

export { Plot };
