// What a card says of a grasp: one row for each number, with its goal and whether it is met.

import { SLACK } from "./criteria.js";
import { number, point } from "./words.js";

const within = (ratio) => (ratio === null ? null : ratio <= 1 + SLACK);

function term(name, label, unit, digits) {
  return {
    label,
    unit,
    goal: ({ goals }) => (goals[name] === null ? null : `≤ ${number(goals[name], digits)}`),
    value: (grasp) => number(grasp[name], digits),
    full: (grasp) => grasp[name],
    ratio: (grasp) => grasp.ratios[name],
    met: (grasp) => within(grasp.ratios[name]),
  };
}

function vector(label, of) {
  return { label, unit: "mm", vector: true, value: (...from) => point(of(...from)) };
}

const CONSTRAINTS = [
  {
    label: "FoS",
    unit: "",
    goal: (rules) => `≥ ${number(rules.fos, 3)}`,
    value: (grasp) => number(grasp.fos, 3),
    full: (grasp) => grasp.fos,
    met: (grasp) => grasp.meetsFos,
  },
  {
    label: "Smallest distance",
    unit: "mm",
    goal: (rules) => `≥ ${number(rules.clearance_mm, 2)}`,
    value: (grasp) => number(grasp.clearance, 2),
    full: (grasp) => grasp.clearance,
    met: (grasp) => grasp.isClear,
  },
];

const CRITERIA = [
  term("cost", "Cost", "$", 2),
  term("moment", "Residual moment", "N-mm", 1),
  term("deviation", "Deviation", "mm", 2),
  term("structure", "Structure", "mm", 1),
  {
    label: "Divergence",
    unit: "",
    value: (grasp) => number(grasp.divergence, 3),
    full: (grasp) => grasp.divergence,
  },
];

const CENTRE = [
  { label: "Lifting force", unit: "N", value: (grasp) => number(grasp.force_n, 1) },
  { label: "Part weight", unit: "N", value: (_, { part }) => number(part.weight_n, 1) },
  vector("Centroid x, y, z", (_, { part }) => part.centroid_mm),
  vector("Centre of force", (grasp) => grasp.centre_mm),
  vector("Offset of centroid", (grasp) => grasp.offset_mm),
  { label: "Moment arm", unit: "mm", value: (grasp) => number(grasp.arm_mm, 2) },
];

const HOLD = [
  { label: "Main truss", unit: "mm", value: (grasp) => number(grasp.longest_mm, 1) },
  {
    label: "Element weight",
    unit: "g",
    value: (grasp) =>
      grasp.support.element_weight_g === null
        ? "not known"
        : number(grasp.support.element_weight_g, 0),
  },
  { label: "Area of hull", unit: "mm²", value: (grasp) => number(grasp.support.hull_area_mm2) },
  {
    label: "Centroid inside hull",
    unit: "",
    value: (grasp) => (grasp.support.centroid_inside ? "yes" : "no"),
  },
];

function counts(scene) {
  return scene.kinds.map((kind, position) => ({
    label: `${kind.label}s`,
    unit: "",
    goal: () => `${kind.count_min} to ${kind.most}`,
    value: (grasp) => number(grasp.counts[position]),
  }));
}

function searched(scene) {
  const { criterion } = scene.rules;
  if (criterion === "divergence" || !criterion.includes("+")) return [];
  return [
    {
      label: `Searched: ${criterion}`,
      unit: "",
      value: (grasp) => number(grasp.value, 3),
      full: (grasp) => grasp.value,
    },
  ];
}

/** Groups of rows: [title, rows]. */
export function cardRows(scene) {
  return [
    ["Constraints", CONSTRAINTS],
    ["Criteria", [...CRITERIA, ...searched(scene)]],
    ["Forces", CENTRE],
    ["Elements", [...counts(scene), ...HOLD]],
  ];
}
