// What is under the pointer, in a box beside it.

import { make } from "./dom.js";
import { number } from "./words.js";

/** Show what was found beside a point of the stage; null hides the box. */
export function showTooltip(box, scene, found, where) {
  box.hidden = !found;
  if (!found) return;
  const kind = scene.kinds[found.kind];
  const title = `${kind.label} ${number(found.index)}${where.stands ? "" : ", a free place"}`;
  const [x, y, z] = found.place.map((value) => number(value, 2));
  box.replaceChildren(
    make("b", {}, title),
    make("span", {}, `x ${x}, y ${y}, z ${z} mm`),
    make("span", {}, `${number(found.force, 1)} N`),
  );
  const stage = box.parentElement;
  const [width, height] = [box.offsetWidth, box.offsetHeight];
  const left = Math.min(where.x + 14, stage.clientWidth - width - 4);
  const below = where.y + 14 + height < stage.clientHeight;
  box.style.left = `${Math.max(left, 4)}px`;
  box.style.top = `${Math.max(below ? where.y + 14 : where.y - height - 10, 4)}px`;
}
