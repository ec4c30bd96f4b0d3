// Two pictures on one stage: a slider between them, or blinking, with one zoom for both.
import "img-comparison-slider";
import Panzoom from "@panzoom/panzoom";
import { element, select, shown } from "./dom.js";

const BLINK_MS = 600;
const KINDS = [
  { id: "color", text: "color" },
  { id: "flip", text: "error (FLIP)" },
  { id: "heat", text: "shader invocations" },
];

export class PicturePanel {
  constructor(mount, page) {
    this.page = page;
    this.sources = page.model.data.points
      .map((point, i) => ({ point, index: i, label: page.model.label(i) }))
      .filter(({ point }) => document.getElementById(`color-${point.pictures}`));
    if (this.sources.length === 0) {
      mount.append(element("p", {}, "The points have no images: they were run with --no-image."));
      return;
    }
    this.pick = { left: 0, right: this.sources.length > 1 ? 1 : 0, leftKind: 0, rightKind: 0 };
    if (this.#reference(0)) this.pick.left = this.sources.length; // the reference stands last
    if (this.#reference(0)) this.pick.right = 0;
    this.choices = element("div", { class: "choices" });
    this.first = element("img", { slot: "first", alt: "left picture" });
    this.second = element("img", { slot: "second", alt: "right picture" });
    this.slider = element("img-comparison-slider", { id: "comparer", tabindex: "0" }, this.first, this.second);
    this.marks = element("div", { class: "marks" });
    this.stage = element("div", { class: "stage" }, this.slider, this.marks);
    this.frame = element("div", { class: "stage-frame" }, this.stage);
    this.say = element("p", { class: "readout", "aria-live": "polite" });
    const fit = document.querySelector("#pictures .note")?.textContent ?? "";
    mount.append(this.choices, this.#buttons(), this.frame, this.say, this.#legend(), this.#crops(), element("p", { class: "fit" }, fit));
    this.zoom = Panzoom(this.stage, { maxScale: 16, contain: "outside", excludeClass: "handle", cursor: "crosshair", pinchAndPan: true });
    this.frame.addEventListener("wheel", (event) => event.ctrlKey && this.zoom.zoomWithWheel(event));
    this.frame.addEventListener("pointermove", (event) => this.#read(event));
    this.#show();
  }

  #reference(index) {
    const { reference } = this.sources[index].point;
    return reference === null ? null : document.getElementById(`reference-${reference}`);
  }

  #element(which, kind) {
    if (which === this.sources.length) return this.#reference(Math.min(this.pick.left, this.pick.right) % this.sources.length);
    return document.getElementById(`${KINDS[kind].id}-${this.sources[which].point.pictures}`);
  }

  #makeChoices() {
    const options = this.sources.map(({ label }) => ({ text: label }));
    if (this.#reference(0)) options.push({ text: "reference" });
    const side = (name, title) =>
      element("span", { class: "side" },
      select(title, options, this.pick[name], (i) => this.#choose({ [name]: i })),
      select("shows", KINDS.map((kind, k) => ({ text: kind.text, disabled: !this.#element(this.pick[name], k) })), this.pick[`${name}Kind`], (k) => this.#choose({ [`${name}Kind`]: k })),
      );
    this.choices.replaceChildren(side("left", "Left"), side("right", "Right"));
  }

  #buttons() {
    const button = (text, id, onclick) => element("button", { type: "button", id, onclick }, text);
    this.blinker = button("Blink", "blink", () => this.#blink());
    return element("div", { class: "buttons" }, button("Whole", "zoom-out", () => this.zoom.reset()), button("Zoom in", "zoom-in", () => this.zoom.zoomIn()), this.blinker);
  }

  #choose(change) {
    Object.assign(this.pick, change);
    for (const side of ["left", "right"])
      if (!this.#element(this.pick[side], this.pick[`${side}Kind`])) this.pick[`${side}Kind`] = 0;
    this.#show();
  }

  #show() {
    this.#makeChoices();
    for (const [side, image] of [["left", this.first], ["right", this.second]]) {
      const source = this.#element(this.pick[side], this.pick[`${side}Kind`]);
      image.src = source.src;
      image.width = source.width;
      image.height = source.height;
      image.className = source.className;
    }
    this.#mark();
    this.data = [this.first, this.second].map((image) => this.#pixels(image));
  }

  // Where the images of the points err most.
  #mark() {
    const { regions, points } = this.page.model.data;
    const [width, height] = points[0].explanation.resolution;
    const shownView = this.sources[Math.min(this.pick.left, this.pick.right) % this.sources.length].point.view_words;
    this.marks.hidden = shownView !== points[0].view_words;
    this.marks.replaceChildren(
      ...regions.map((region, i) =>
        element("span", { class: "mark", style: `left:${(100 * region.x) / width}%;top:${(100 * region.y) / height}%;width:${(100 * region.side) / width}%;height:${(100 * region.side) / height}%` }, String(i + 1)),
      ),
    );
  }

  #crops() {
    const { regions, points } = this.page.model.data;
    const [width, height] = points[0].explanation.resolution;
    const go = (region) => {
      const scale = Math.min(8, width / region.side / 2);
      this.zoom.zoom(scale, { animate: false });
      const box = this.frame.getBoundingClientRect();
      const at = (place, all, length) => (0.5 - (place + region.side / 2) / all) * length;
      this.zoom.pan(at(region.x, width, box.width), at(region.y, height, box.height), { animate: false });
    };
    if (regions.length === 0) return element("p");
    return element("div", { class: "buttons crops" }, element("span", {}, points.some((point) => point.view_words !== points[0].view_words) ? `Where the images of ${points[0].view || points[0].view_words} err most: ` : "Where the images err most: "), ...regions.map((region, i) => element("button", { type: "button", onclick: () => go(region) }, String(i + 1))));
  }

  #legend() {
    const { points } = this.page.model.data;
    const most = Math.max(...points.map((point) => point.heat_scale));
    const names = this.sources.map(({ index, label }) => `${label}: 0 to ${shown(points[index].heat_scale)}`);
    return element("div", { class: "legend" }, element("span", {}, "0"), element("i", { class: "ramp" }), element("span", {}, "FLIP 1, or the most shader invocations a pixel"), element("small", {}, ` (${names.length > 4 ? `at most ${shown(most)}` : names.join("; ")})`));
  }

  #pixels(image) {
    const canvas = element("canvas", { width: image.width, height: image.height });
    const context = canvas.getContext("2d", { willReadFrequently: true });
    const draw = () => context.drawImage(image, 0, 0, image.width, image.height);
    image.complete ? draw() : image.addEventListener("load", draw, { once: true });
    return context;
  }

  #value(side, x, y) {
    const which = side === 0 ? "left" : "right";
    const kind = KINDS[this.pick[`${which}Kind`]].id;
    const [r, g, b] = this.data[side].getImageData(x, y, 1, 1).data;
    const source = this.sources[this.pick[which]];
    if (kind === "flip" && source) return `FLIP ${((r / 255) * source.point.flip_scale).toFixed(2)}`;
    if (kind === "heat" && source) return `${((r / 255) * source.point.heat_scale).toFixed(1)} invocations`;
    return `rgb ${r} ${g} ${b}`;
  }

  #read(event) {
    const box = this.first.getBoundingClientRect();
    const x = Math.floor(((event.clientX - box.left) * this.first.width) / box.width);
    const y = Math.floor(((event.clientY - box.top) * this.first.height) / box.height);
    if (x < 0 || y < 0 || x >= this.first.width || y >= this.first.height) return;
    this.say.textContent = `pixel ${x}, ${y}: left ${this.#value(0, x, y)}, right ${this.#value(1, x, y)}`;
  }

  #blink() {
    if (this.timer) {
      clearInterval(this.timer);
      this.timer = null;
      this.slider.value = 50;
    } else {
      let on = false;
      this.timer = setInterval(() => (this.slider.value = (on = !on) ? 100 : 0), BLINK_MS);
    }
    this.blinker.setAttribute("aria-pressed", String(Boolean(this.timer)));
    this.blinker.textContent = this.timer ? "Stop" : "Blink";
  }
}
