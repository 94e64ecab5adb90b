// A design on the part: elements, frame, numbers, centroid and centre of force, as layers.

import { frame } from "./grip.js";
import { line } from "./lines.js";
import { centroidMark, discard, forceMark, label } from "./marks.js";
import { solid } from "./shading.js";
import { bar, elementMeshes } from "./solids.js";
import { Group } from "./three.js";

const LIT = 0.28;

function elementGroups(scene, grasp) {
  return grasp.elements.map((element) => {
    const group = new Group();
    group.position.set(...element.place);
    group.add(...elementMeshes(scene.kinds[element.kind]));
    group.userData.element = element;
    return group;
  });
}

function barGroup(bars, material) {
  const group = new Group();
  if (bars.length) group.add(...bars.map((each) => bar(each, material)));
  return group;
}

/** Everything of one design; `top` is the height of its frame. */
export class Gripper {
  constructor(scene, grasp) {
    this.scene = scene;
    this.grasp = grasp;
    const bars = frame(scene, grasp);
    this.top = bars.height + scene.frame.main_radius_mm;
    this.materials = {
      main: solid(),
      branches: solid(),
      posts: solid(),
    };
    const elements = new Group();
    this.elements = elementGroups(scene, grasp);
    elements.add(...this.elements);
    const frames = new Group();
    for (const [name, material] of Object.entries(this.materials)) {
      frames.add(barGroup(bars[name], material));
    }
    this.layers = { elements, frame: frames, centres: new Group(), numbers: new Group() };
    this.group = new Group();
    this.group.add(...Object.values(this.layers));
  }

  /** Take the colours of a theme; labels are drawn anew in them. */
  paint(theme) {
    for (const [name, material] of Object.entries(this.materials)) material.paint(theme[name]);
    this.#drawCentres(theme);
    this.#drawNumbers(theme);
  }

  #drawCentres(theme) {
    const { centres } = this.layers;
    discard(centres);
    const [centroid, force] = [this.scene.part.centroid_mm, this.grasp.centre_mm];
    const left = force[0] >= centroid[0] ? -1 : 1;
    const add = (mark, place) => {
      mark.position.set(...place);
      centres.add(mark);
    };
    const offset = line([centroid, force], 1.5, { depthTest: false });
    offset.material.paint(theme.force);
    offset.renderOrder = 1;
    centres.add(offset);
    add(centroidMark(theme.ink, theme.paper), centroid);
    add(forceMark(theme.force, theme.paper), force);
    add(label("Centroid", theme.ink, theme.stage, left, 10, 4), centroid);
    add(label("Centre of force", theme.force, theme.stage, -left, 10, 4), force);
  }

  #drawNumbers(theme) {
    const { numbers } = this.layers;
    discard(numbers);
    for (const element of this.grasp.elements) {
      const kind = this.scene.kinds[element.kind];
      const mark = label(String(element.index), theme.ink, theme.stage, 1, 4);
      const [x, y, z] = element.place;
      mark.position.set(x, y, z + kind.height_mm);
      numbers.add(mark);
    }
  }

  /** Light one element, or none. */
  light(chosen) {
    for (const group of this.elements) {
      const lit = group.userData.element === chosen;
      for (const mesh of group.children) {
        if (lit && !mesh.userData.plain) {
          mesh.userData.plain = mesh.material;
          mesh.material = mesh.material.clone();
          mesh.material.uniforms.glow.value = LIT;
        } else if (!lit && mesh.userData.plain) {
          mesh.material.dispose();
          mesh.material = mesh.userData.plain;
          delete mesh.userData.plain;
        }
      }
    }
  }

  /** Free what it alone holds; shapes of elements are shared. */
  dispose() {
    discard(this.layers.centres);
    discard(this.layers.numbers);
    this.light(null);
    for (const material of Object.values(this.materials)) material.dispose();
    this.layers.frame.traverse((each) => each.geometry?.dispose());
  }
}
