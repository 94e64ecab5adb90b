// Marks and labels that keep their size on the screen, drawn on small canvases.

import { CanvasTexture, Sprite, SpriteMaterial, SRGBColorSpace } from "./three.js";

const FONT = "600 13px system-ui, -apple-system, 'Segoe UI', Roboto, 'Liberation Sans', sans-serif";
/** Pixels of the canvas for one of the screen. */
const FINE = 2;

function drawn(width, height, draw) {
  const canvas = document.createElement("canvas");
  canvas.width = Math.ceil(width * FINE);
  canvas.height = Math.ceil(height * FINE);
  const pen = canvas.getContext("2d");
  pen.scale(FINE, FINE);
  draw(pen);
  const map = new CanvasTexture(canvas);
  map.colorSpace = SRGBColorSpace;
  const sprite = new Sprite(new SpriteMaterial({ map, depthTest: false, depthWrite: false }));
  sprite.userData.size = [width, height];
  return sprite;
}

let ruler = null;

function widthOf(text) {
  ruler ??= document.createElement("canvas").getContext("2d");
  ruler.font = FONT;
  return ruler.measureText(text).width;
}

/** Text with a halo; `side` puts it left of (-1), on (0) or right of (1) its point. */
export function label(text, colour, halo, { side = 0, gap = 0, lift = 0.5 } = {}) {
  const [width, height] = [widthOf(text) + 10, 22];
  const sprite = drawn(width, height, (pen) => {
    pen.font = FONT;
    pen.textBaseline = "middle";
    pen.lineJoin = "round";
    pen.lineWidth = 4;
    pen.strokeStyle = halo;
    pen.strokeText(text, 5, height / 2);
    pen.fillStyle = colour;
    pen.fillText(text, 5, height / 2);
  });
  const shift = gap / width;
  sprite.center.set(side < 0 ? 1 + shift : side > 0 ? -shift : 0.5, lift);
  sprite.renderOrder = 3;
  return sprite;
}

/** The engineer's sign of a centroid: a circle of four quarters. */
export function centroidMark(ink, paper) {
  const size = 22;
  const sprite = drawn(size, size, (pen) => {
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
  sprite.renderOrder = 2;
  return sprite;
}

/** A diamond with a dot: where the forces act as one. */
export function forceMark(colour, paper) {
  const size = 22;
  const sprite = drawn(size, size, (pen) => {
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
  sprite.renderOrder = 2;
  return sprite;
}

/** Free what a group of marks holds on the graphics card. */
export function discard(group) {
  for (const sprite of group.children) {
    sprite.material.map?.dispose();
    sprite.material.dispose();
    sprite.geometry?.isBufferGeometry && !sprite.isSprite && sprite.geometry.dispose();
  }
  group.clear();
}
