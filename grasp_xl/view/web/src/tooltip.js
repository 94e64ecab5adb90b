// What is under the pointer, in a box beside it.

import { make } from "./dom.js";
import { number } from "./words.js";

function lines(scene, { kind, index, place, force, used }) {
  const { label } = scene.kinds[kind];
  const [x, y, z] = place.map((value) => number(value, 2));
  return [
    make("b", {}, `${label} ${number(index)}${used ? "" : " (free place)"}`),
    make("span", {}, `x ${x}, y ${y}, z ${z} mm`),
    make("span", {}, `${number(force, 1)} N`),
  ];
}

/** Show what was found beside a point of the stage; nothing hides the box. */
export function showTooltip(box, scene, found, where) {
  box.hidden = !found.length;
  if (!found.length) return;
  box.replaceChildren(...found.flatMap((each) => lines(scene, each)));
  const stage = box.parentElement;
  const [width, height] = [box.offsetWidth, box.offsetHeight];
  const left = Math.min(where.x + 14, stage.clientWidth - width - 4);
  const below = where.y + 14 + height < stage.clientHeight;
  box.style.left = `${Math.max(left, 4)}px`;
  box.style.top = `${Math.max(below ? where.y + 14 : where.y - height - 10, 4)}px`;
}
