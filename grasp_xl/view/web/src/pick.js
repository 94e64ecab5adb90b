// What is under the pointer: an element, or a place where one could stand.

import { at } from "./data.js";
import { Raycaster, Vector2, Vector3 } from "./three.js";

/** Pixels from a place within which it is meant. */
const NEAR = 9;
/** Pixels between places that are one to the eye. */
const SAME = 0.5;

const ray = new Raycaster();

/** The element of a gripper under a point of a picture, x and y from -1 to 1; null for none. */
export function elementAt(camera, gripper, x, y) {
  ray.setFromCamera(new Vector2(x, y), camera);
  const [hit] = ray.intersectObjects(gripper.elements, true);
  return hit ? hit.object.parent.userData.element : null;
}

/**
 * The places nearest to a point of a picture of some size in pixels: none, or one of a kind, or one
 * of each where both kinds can stand there.
 */
export function placesAt(scene, camera, x, y, width, height) {
  const m = camera.projectionMatrix.clone().multiply(camera.matrixWorldInverse).elements;
  const nearest = scene.kinds.map((kind, number) => {
    const { places } = kind;
    let best = -1;
    let least = NEAR;
    for (let i = 0; i < places.length; i += 3) {
      const [a, b, c] = [places[i], places[i + 1], places[i + 2]];
      const w = m[3] * a + m[7] * b + m[11] * c + m[15];
      const right = (m[0] * a + m[4] * b + m[8] * c + m[12]) / w - x;
      const up = (m[1] * a + m[5] * b + m[9] * c + m[13]) / w - y;
      const away = Math.hypot((right * width) / 2, (up * height) / 2);
      if (away < least) [least, best] = [away, i];
    }
    const index = best / 3 + 1;
    return { away: best < 0 ? Infinity : least, kind: number, index, force: kind.force_n };
  });
  const least = Math.min(...nearest.map(({ away }) => away));
  return nearest
    .filter(({ away }) => away < NEAR && away - least < SAME)
    .map(({ kind, index, force }) => {
      return { kind, index, force, place: at(scene.kinds[kind].places, index) };
    });
}

/** Where a point in space is in a picture: x right and y down, in pixels. */
export function onScreen(camera, place, width, height) {
  const point = new Vector3(...place).project(camera);
  return { x: ((point.x + 1) / 2) * width, y: ((1 - point.y) / 2) * height };
}
