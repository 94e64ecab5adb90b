// Simple solids of elements and frame, as meshes.

import { solid } from "./shading.js";
import { BoxGeometry, CylinderGeometry, LatheGeometry, Mesh, Vector2, Vector3 } from "./three.js";

const SECTIONS = 40;
const UP = new Vector3(0, 1, 0);

/** A profile turned about the upright axis; each side of it is flat-edged, as machined. */
function turned(profile) {
  const corners = profile.flatMap((corner, number) => {
    const next = profile[(number + 1) % profile.length];
    return corner[0] === 0 && next[0] === 0 ? [] : [[corner, next]];
  });
  return corners.map((side) => {
    const points = side.map(([r, z]) => new Vector2(r, z));
    return new LatheGeometry(points, SECTIONS).rotateX(Math.PI / 2);
  });
}

function box({ box_mm: [length, width], angle_deg, z_mm: [low, high] }) {
  const geometry = new BoxGeometry(length, width, high - low);
  geometry.rotateZ((angle_deg * Math.PI) / 180);
  return [geometry.translate(0, 0, (low + high) / 2)];
}

const made = new WeakMap();

/** Geometries and materials of a kind, made once. */
function shapesOf(kind) {
  if (!made.has(kind)) {
    made.set(
      kind,
      kind.solids.flatMap((each) => {
        const material = solid({ colour: each.colour });
        const geometries = each.profile_mm ? turned(each.profile_mm) : box(each);
        return geometries.map((geometry) => ({ geometry, material }));
      }),
    );
  }
  return made.get(kind);
}

/** Meshes of one element of a kind; they stand on [0, 0, 0]. */
export function elementMeshes(kind) {
  return shapesOf(kind).map(({ geometry, material }) => new Mesh(geometry, material));
}

/** A round bar between two points. */
export function bar({ start, end, radius }, material) {
  const [from, to] = [new Vector3(...start), new Vector3(...end)];
  const axis = to.clone().sub(from);
  const mesh = new Mesh(new CylinderGeometry(radius, radius, axis.length(), 24), material);
  mesh.position.copy(from).addScaledVector(axis, 0.5);
  mesh.quaternion.setFromUnitVectors(UP, axis.normalize());
  return mesh;
}
