// What every design shares: the part, all places, and both polygons, as layers.

import { line } from "./lines.js";
import { partGroup } from "./part.js";
import { dots } from "./shading.js";
import { BufferGeometry, Float32BufferAttribute, Group, Points, Vector3 } from "./three.js";

/** Pixels of a place, and its opacity. */
const DOT = 4;
const FAINT = 0.6;
/** Opacity of a line behind the part. */
const HIDDEN = 0.45;

function placesGroup(scene) {
  const group = new Group();
  const clouds = scene.kinds
    .filter((kind) => kind.total)
    .map((kind) => {
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new Float32BufferAttribute(kind.places, 3));
      return new Points(geometry, dots(kind.colour, FAINT));
    });
  if (clouds.length) group.add(...clouds);
  return {
    group,
    paint(_, ratio) {
      for (const { material } of clouds) material.uniforms.size.value = DOT * ratio;
    },
  };
}

/** A closed line, and its faint image where something is before it. */
function seenThrough(points, width) {
  const behind = { depthTest: false, depthWrite: false, opacity: HIDDEN };
  return [line(points, width, { closed: true }), line(points, width, { closed: true, ...behind })];
}

function polygonsGroup(scene) {
  const group = new Group();
  const outer = seenThrough(scene.part_polygon_mm, 2);
  const ideal = seenThrough(scene.ideal_polygon_mm, 2.5);
  group.add(...outer, ...ideal);
  return {
    group,
    paint(theme) {
      for (const each of outer) each.material.paint(theme.partPolygon);
      for (const each of ideal) each.material.paint(theme.idealPolygon);
    },
  };
}

/** Corners of a box about the part, its places and its polygons: what a fit shows. */
function extent(scene) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  const grow = (values, from, axes = 3) => {
    for (let axis = 0; axis < axes; axis += 1) {
      const value = values[from + axis];
      if (value < low[axis]) low[axis] = value;
      if (value > high[axis]) high[axis] = value;
    }
  };
  const lists = scene.kinds.map((kind) => kind.places);
  if (scene.part.mesh) lists.push(scene.part.mesh.positions);
  for (const list of lists) for (let i = 0; i < list.length; i += 3) grow(list, i);
  for (const corner of [...scene.part_polygon_mm, ...scene.ideal_polygon_mm]) {
    grow(corner, 0, scene.part.mesh ? 2 : 3);
  }
  for (const face of scene.part.faces) {
    for (const ring of face.rings) for (const [x, y] of ring) grow([x, y, face.z_mm], 0);
  }
  return { low, high };
}

export function surroundings(scene) {
  const part = partGroup(scene);
  const places = placesGroup(scene);
  const polygons = polygonsGroup(scene);
  const { low, high } = extent(scene);
  return {
    layers: { part: part.group, places: places.group, polygons: polygons.group },
    addEdges: part.addEdges,
    paint(theme, ratio) {
      for (const each of [part, places, polygons]) each.paint(theme, ratio);
    },
    /** Corners of the box of all that is shown, up to the frame's height. */
    corners(top) {
      const ends = [low, [high[0], high[1], Math.max(high[2], top)]];
      return [0, 1, 2, 3, 4, 5, 6, 7].map(
        (n) => new Vector3(ends[n & 1][0], ends[(n >> 1) & 1][1], ends[n >> 2][2]),
      );
    },
  };
}
