// The picture: one canvas with one or two panes that one eye looks into, drawn only on demand.

import { Eye, VIEWS } from "./camera.js";
import { Gripper } from "./gripper.js";
import { elementAt, onScreen, placesAt } from "./pick.js";
import { steer } from "./steering.js";
import { surroundings } from "./surroundings.js";
import { theme } from "./theme.js";
import { Scene, WebGLRenderer } from "./three.js";

const GLIDE_MS = 220;
/** Pixels between the two panes. */
/** Width (pixels) from which on two pictures have room beside each other. */
const SIDE_BY_SIDE = 480;

const GAP = 2;
/** Pixels below which nothing is drawn. */
const LEAST = 16;
/** Pixels of a printed picture for one of the page. */
const PAPER_PIXELS = 3;

export const LAYERS = ["part", "elements", "frame", "places", "polygons", "centres", "numbers"];

const still = matchMedia("(prefers-reduced-motion: reduce)");

/** Pixels of the picture for one of the page. */
export const pixelRatio = () => Math.min(devicePixelRatio, 2);

export class Stage {
  /**
   * `told(found, where)` follows the pointer: places under it, and where it is; `arranged(stacked)`
   * says whether two panes stand one above the other.
   */
  constructor(canvas, context, scene, { told, arranged }) {
    this.canvas = canvas;
    this.scene = scene;
    this.told = told;
    this.arranged = arranged;
    this.eye = new Eye();
    this.grippers = [];
    this.hidden = new Set();
    this.waiting = false;
    this.stacked = false;
    /** Whether the eye still sees what the last fit showed. */
    this.fits = true;
    this.gliding = 0;
    this.space = new Scene();
    this.around = surroundings(scene);
    this.space.add(...Object.values(this.around.layers));
    this.renderer = new WebGLRenderer({ canvas, context });
    this.renderer.debug.checkShaderErrors = false;
    this.renderer.autoClear = false;
    this.renderer.setScissorTest(true);
    steer(canvas, this.eye, {
      pane: (x, y) => this.#paneAt(x, y).box,
      changed: () => this.#moved(),
      tapped: (x, y) => this.#point(x, y),
      pointed: (x, y) => this.#hover(x, y),
    });
    canvas.addEventListener("webglcontextrestored", () => this.draw());
    new ResizeObserver(() => this.#resize()).observe(canvas.parentElement);
    this.#resize();
    this.paint();
  }

  /** Show the designs of one or two grasps, side by side. */
  show(grasps) {
    const kept = this.grippers.filter((each) => grasps.includes(each.grasp));
    for (const gripper of this.grippers) {
      if (kept.includes(gripper)) continue;
      this.space.remove(gripper.group);
      gripper.dispose();
    }
    const panes = this.grippers.length;
    this.grippers = grasps.map((grasp) => this.#gripper(grasp, kept));
    this.#applyLayers();
    if (!panes && grasps.length) {
      this.fit({ glide: false });
    } else if (panes !== grasps.length) this.fit();
    this.told([]);
    this.draw();
  }

  #gripper(grasp, kept) {
    const known = kept.find((each) => each.grasp === grasp);
    if (known) return known;
    const gripper = new Gripper(this.scene, grasp);
    gripper.paint(this.colours);
    this.space.add(gripper.group);
    return gripper;
  }

  /** Switch a layer on or off. */
  layer(name, on) {
    if (on) this.hidden.delete(name);
    else this.hidden.add(name);
    this.#applyLayers();
    this.draw();
  }

  #applyLayers() {
    for (const layers of [this.around.layers, ...this.grippers.map((each) => each.layers)]) {
      for (const [name, group] of Object.entries(layers)) group.visible = !this.hidden.has(name);
    }
  }

  /** Turn to a named view, and fit. */
  view(name) {
    const [azimuth, tilt] = VIEWS[name];
    this.fit({ azimuth, tilt });
  }

  /** Show everything, from the same side or from another. */
  fit({ azimuth = this.eye.azimuth, tilt = this.eye.tilt, glide = true } = {}) {
    const { eye } = this;
    const from = {
      azimuth: eye.azimuth,
      tilt: eye.tilt,
      span: eye.span,
      target: eye.target.clone(),
    };
    const corners = this.around.corners(Math.max(...this.grippers.map((each) => each.top)));
    Object.assign(eye, { azimuth, tilt });
    this.#arrange();
    const [pane] = this.#panes();
    this.fits = true;
    eye.fit(corners, pane.width / pane.height);
    eye.middle.copy(corners[0]).add(corners[7]).multiplyScalar(0.5);
    eye.reach = corners[0].distanceTo(corners[7]);
    if (glide && !still.matches) this.#glide(from);
    this.draw();
  }

  /** Put two panes side by side, or one above the other where there is no room. */
  #arrange() {
    this.stacked = this.width < SIDE_BY_SIDE && this.height > this.width;
    this.arranged(this.stacked);
  }

  #glide(from) {
    const { eye } = this;
    const to = { azimuth: eye.azimuth, tilt: eye.tilt, span: eye.span, target: eye.target.clone() };
    const turn = ((to.azimuth - from.azimuth + 3 * Math.PI) % (2 * Math.PI)) - Math.PI;
    const began = performance.now();
    cancelAnimationFrame(this.gliding);
    const step = () => {
      const part = Math.min(Math.max((performance.now() - began) / GLIDE_MS, 0), 1);
      const eased = 1 - (1 - part) ** 3;
      eye.azimuth = to.azimuth - turn * (1 - eased);
      eye.tilt = from.tilt + (to.tilt - from.tilt) * eased;
      eye.span = from.span + (to.span - from.span) * eased;
      eye.target.lerpVectors(from.target, to.target, eased);
      this.render();
      this.gliding = part < 1 ? requestAnimationFrame(step) : 0;
    };
    this.gliding = requestAnimationFrame(step);
  }

  /** Switch between a perspective and a parallel picture of the same size. */
  set perspective(on) {
    this.eye.perspective = on;
    if (this.fits) this.fit({ glide: false });
    this.draw();
  }

  zoom(factor) {
    this.eye.zoom(factor);
    this.#moved();
  }

  #moved() {
    this.fits = false;
    cancelAnimationFrame(this.gliding);
    this.gliding = 0;
    this.told([]);
    this.draw();
  }

  /** Take the colours of the page anew. */
  paint() {
    this.colours = theme();
    this.renderer.setClearColor(this.colours.stage, 1);
    this.around.paint(this.colours, this.renderer.getPixelRatio());
    for (const gripper of this.grippers) gripper.paint(this.colours);
    this.draw();
  }

  #resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    if (clientWidth < LEAST || clientHeight < LEAST || matchMedia("print").matches) return;
    this.renderer.setPixelRatio(pixelRatio());
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.width = clientWidth;
    this.height = clientHeight;
    if (!this.grippers.length) return;
    if (this.fits) this.fit({ glide: false });
    this.render();
  }

  /** Boxes of the panes in pixels of the page, from the upper left corner of the canvas. */
  #panes(stacked = this.stacked) {
    const [wide, high] = [this.width, this.height];
    if (this.grippers.length < 2) return [{ left: 0, top: 0, width: wide, height: high }];
    if (stacked) {
      const height = (high - GAP) / 2;
      return [0, height + GAP].map((top) => ({ left: 0, top, width: wide, height }));
    }
    const width = (wide - GAP) / 2;
    return [0, width + GAP].map((left) => ({ left, top: 0, width, height: high }));
  }

  #paneAt(x, y) {
    const boxes = this.#panes();
    const second = boxes[1] && x >= boxes[1].left && y >= boxes[1].top;
    const number = second ? 1 : 0;
    return { number, box: boxes[number] };
  }

  /** Draw soon. */
  draw() {
    if (this.waiting || this.gliding) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      if (this.waiting) this.render();
    });
  }

  /** Draw now. */
  render() {
    this.waiting = false;
    const { renderer, eye } = this;
    if (!this.grippers.length) return;
    renderer.setScissor(0, 0, this.width, this.height);
    renderer.setViewport(0, 0, this.width, this.height);
    renderer.clear();
    this.#panes().forEach(({ left, top, width, height }, number) => {
      this.grippers.forEach((each, other) => (each.group.visible = other === number));
      const bottom = this.height - top - height;
      renderer.setViewport(left, bottom, width, height);
      renderer.setScissor(left, bottom, width, height);
      renderer.render(this.space, eye.camera(width / height));
    });
  }

  #hover(x, y) {
    if (x === undefined) {
      this.light(null);
      this.told([]);
      return;
    }
    if (this.hovering) {
      this.hovering = [x, y];
      return;
    }
    this.hovering = [x, y];
    requestAnimationFrame(() => {
      const [latestX, latestY] = this.hovering;
      this.hovering = null;
      this.#point(latestX, latestY);
    });
  }

  #point(x, y) {
    const { number, box } = this.#paneAt(x, y);
    const gripper = this.grippers[number];
    if (!gripper) return;
    const camera = this.eye.camera(box.width / box.height);
    const right = ((x - box.left) / box.width) * 2 - 1;
    const up = 1 - ((y - box.top) / box.height) * 2;
    const element = this.hidden.has("elements") ? null : elementAt(camera, gripper, right, up);
    const free = this.hidden.has("places")
      ? []
      : placesAt(this.scene, camera, right, up, box.width, box.height);
    const found = element ? [element] : free;
    const { elements } = gripper.grasp;
    const used = (place) =>
      elements.some((each) => each.kind === place.kind && each.index === place.index);
    this.light(element);
    this.told(
      found.map((place) => ({ ...place, used: used(place) })),
      { x, y },
    );
  }

  /** Where a place is in the picture: pixels from the upper left corner of the canvas. */
  spot(place) {
    const [{ width, height }] = this.#panes();
    return onScreen(this.eye.camera(width / height), place, width, height);
  }

  /** Light an element of a shown design, or none. */
  light(element) {
    if (element === this.lit) return;
    this.lit = element;
    for (const gripper of this.grippers) gripper.light(element);
    this.draw();
  }

  /** Copy the picture as it is seen, in the colours of paper, to a canvas that can be printed. */
  print(paper) {
    const { classList } = document.documentElement;
    classList.add("paper");
    this.renderer.setPixelRatio(PAPER_PIXELS);
    this.paint();
    this.render();
    [paper.width, paper.height] = [this.canvas.width, this.canvas.height];
    paper.getContext("2d").drawImage(this.canvas, 0, 0);
    classList.remove("paper");
    this.renderer.setPixelRatio(pixelRatio());
    this.paint();
    this.render();
  }
}
