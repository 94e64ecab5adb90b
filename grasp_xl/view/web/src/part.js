// The part: its mesh, or its faces as thin plates, or the polygon that stands for it.

import { creased, featureEdges } from "./creases.js";
import { areas } from "./rings.js";
import { solid, thin } from "./shading.js";
import {
  BufferAttribute,
  BufferGeometry,
  Group,
  LineSegments,
  Mesh,
  ShapeUtils,
  Vector2,
} from "./three.js";

/** Triangles beyond which feature edges would keep a phone busy. */
const MOST_EDGED = 400_000;

function surface(positions, normals, triangles) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  if (normals) geometry.setAttribute("normal", new BufferAttribute(normals, 3));
  geometry.setIndex(new BufferAttribute(triangles, 1));
  if (!normals) geometry.computeVertexNormals();
  return geometry;
}

/** A flat area with holes, each corner at its own height. */
function plate(outline, holes, height) {
  const corners = [outline, ...holes].flat();
  const plan = (ring) => ring.map(([x, y]) => new Vector2(x, y));
  const triangles = ShapeUtils.triangulateShape(plan(outline), holes.map(plan)).flat();
  const positions = new Float32Array(corners.flatMap(([x, y, z]) => [x, y, height ?? z]));
  return surface(positions, null, new Uint32Array(triangles));
}

function outlines(rings, height) {
  return rings.flatMap((ring) =>
    ring.flatMap(([x, y, z], number) => {
      const [nextX, nextY, nextZ] = ring[(number + 1) % ring.length];
      return [x, y, height ?? z, nextX, nextY, height ?? nextZ];
    }),
  );
}

/** Surfaces of the part, and a function that returns its edges: the work can wait. */
function shapes(scene) {
  const { mesh, faces } = scene.part;
  if (mesh) {
    const { positions, normals, triangles } = creased(mesh);
    const few = mesh.triangles.length / 3 <= MOST_EDGED;
    return {
      surfaces: [surface(positions, normals, triangles)],
      edges: () => (few ? featureEdges(mesh) : new Float32Array()),
    };
  }
  const levels = faces.map((face) => ({ z: face.z_mm, areas: areas(face.rings) }));
  const plates = levels.flatMap((level) => level.areas.map((area) => ({ ...area, z: level.z })));
  if (!plates.length) plates.push({ outline: scene.part_polygon_mm, holes: [], z: undefined });
  return {
    surfaces: plates.map(({ outline, holes, z }) => plate(outline, holes, z)),
    edges: () =>
      new Float32Array(plates.flatMap(({ outline, holes, z }) => outlines([outline, ...holes], z))),
  };
}

/** The part as a group; addEdges() draws its edges, and paint() gives it the theme's colours. */
export function partGroup(scene) {
  const { surfaces, edges } = shapes(scene);
  const skin = solid({ behindLines: true });
  const line = thin();
  const group = new Group();
  group.add(...surfaces.map((geometry) => new Mesh(geometry, skin)));
  return {
    group,
    addEdges() {
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new BufferAttribute(edges(), 3));
      group.add(new LineSegments(geometry, line));
    },
    paint(theme) {
      skin.paint(theme.part);
      line.paint(theme.edge);
    },
  };
}
