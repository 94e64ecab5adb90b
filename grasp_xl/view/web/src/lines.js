// Lines of a width in pixels.

import { inPixels, wide } from "./shading.js";
import {
  Float32BufferAttribute,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  Mesh,
} from "./three.js";

/** A strip: x across, y along. */
const STRIP = [-1, 0, 0, 1, 0, 0, 1, 1, 0, -1, 0, 0, 1, 1, 0, -1, 1, 0];

/** A line through points, closed or not; options are those of its material. */
export function line(points, width, { closed = false, ...options } = {}) {
  const starts = closed ? points : points.slice(0, -1);
  const ends = points.slice(1).concat(closed ? [points[0]] : []);
  const geometry = new InstancedBufferGeometry();
  geometry.instanceCount = starts.length;
  geometry.setAttribute("position", new Float32BufferAttribute(STRIP, 3));
  const place = (list) => new InstancedBufferAttribute(new Float32Array(list.flat()), 3);
  geometry.setAttribute("start", place(starts));
  geometry.setAttribute("end", place(ends));
  const mesh = new Mesh(geometry, wide(width, options));
  mesh.frustumCulled = false;
  mesh.onBeforeRender = inPixels;
  return mesh;
}
