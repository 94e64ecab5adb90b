// Marks and labels that keep their size on the screen, drawn on small canvases.

import { inPixels, mark } from "./shading.js";
import { BufferGeometry, CanvasTexture, Float32BufferAttribute, Mesh } from "./three.js";

const FONT = "600 13px system-ui, -apple-system, 'Segoe UI', Roboto, 'Liberation Sans', sans-serif";
/** Pixels of the canvas for one of the screen. */
const FINE = 2;

const SQUARE = new BufferGeometry();
SQUARE.setAttribute(
  "position",
  new Float32BufferAttribute([0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0], 3),
);
SQUARE.setIndex([0, 1, 2, 0, 2, 3]);

/** A picture of a size in pixels whose lower left corner is so far from what it marks. */
function drawn(width, height, [left, low], order, draw) {
  const canvas = document.createElement("canvas");
  canvas.width = Math.ceil(width * FINE);
  canvas.height = Math.ceil(height * FINE);
  const pen = canvas.getContext("2d");
  pen.scale(FINE, FINE);
  draw(pen);
  const material = mark(new CanvasTexture(canvas), [left, low, left + width, low + height]);
  const mesh = new Mesh(SQUARE, material);
  mesh.renderOrder = order;
  mesh.frustumCulled = false;
  mesh.onBeforeRender = inPixels;
  return mesh;
}

let ruler = null;

function widthOf(text) {
  ruler ??= document.createElement("canvas").getContext("2d");
  ruler.font = FONT;
  return ruler.measureText(text).width;
}

/** Text with a halo, so many pixels left (side -1) or right (1) of its point. */
export function label(text, colour, halo, side, gap, order = 3) {
  const [width, height] = [widthOf(text) + 10, 22];
  const left = side < 0 ? -gap - width : gap;
  return drawn(width, height, [left, -height / 2], order, (pen) => {
    pen.font = FONT;
    pen.textBaseline = "middle";
    pen.lineJoin = "round";
    pen.lineWidth = 4;
    pen.strokeStyle = halo;
    pen.strokeText(text, 5, height / 2);
    pen.fillStyle = colour;
    pen.fillText(text, 5, height / 2);
  });
}

/** The engineer's sign of a centroid: a circle of four quarters. */
export function centroidMark(ink, paper) {
  const size = 22;
  return drawn(size, size, [-size / 2, -size / 2], 2, (pen) => {
    const [middle, radius] = [size / 2, size / 2 - 2];
    const circle = (from, to, colour) => {
      pen.beginPath();
      pen.moveTo(middle, middle);
      pen.arc(middle, middle, radius, from * Math.PI, to * Math.PI);
      pen.fillStyle = colour;
      pen.fill();
    };
    circle(0, 2, paper);
    circle(0, 0.5, ink);
    circle(1, 1.5, ink);
    pen.beginPath();
    pen.arc(middle, middle, radius, 0, 2 * Math.PI);
    pen.lineWidth = 1.75;
    pen.strokeStyle = ink;
    pen.stroke();
  });
}

/** A diamond with a dot: where the forces act as one. */
export function forceMark(colour, paper) {
  const size = 22;
  return drawn(size, size, [-size / 2, -size / 2], 2, (pen) => {
    const middle = size / 2;
    pen.beginPath();
    pen.moveTo(middle, 2);
    pen.lineTo(size - 2, middle);
    pen.lineTo(middle, size - 2);
    pen.lineTo(2, middle);
    pen.closePath();
    pen.fillStyle = paper;
    pen.fill();
    pen.lineWidth = 2.5;
    pen.strokeStyle = colour;
    pen.stroke();
    pen.beginPath();
    pen.arc(middle, middle, 3, 0, 2 * Math.PI);
    pen.fillStyle = colour;
    pen.fill();
  });
}

/** Free what a group of marks holds on the graphics card. */
export function discard(group) {
  for (const mesh of group.children) {
    mesh.material.uniforms.map?.value.dispose();
    mesh.material.dispose();
    if (mesh.geometry !== SQUARE) mesh.geometry.dispose();
  }
  group.clear();
}
