// Do the numbers that this page works out agree with those that the workbook gave it?

/** Largest difference, relative (absolute below 1), that still counts as agreement. */
export const SAME = 1e-9;

const NAMES = {
  force_n: "force",
  fos: "FoS",
  cost: "cost",
  moment: "moment",
  deviation: "deviation",
  structure: "structure",
  divergence: "divergence",
  clearance: "smallest distance",
  feasible: "FoS and distance met",
  meets_all_goals: "every goal met",
};

function same(ours, theirs) {
  if (typeof ours !== "number" || typeof theirs !== "number") return ours === theirs;
  return Math.abs(ours - theirs) <= SAME * Math.max(1, Math.abs(ours), Math.abs(theirs));
}

const told = (value) => {
  if (typeof value === "boolean") return value ? "yes" : "no";
  return value === null || value === undefined ? "none" : String(value);
};

/** What differs: one text for each number, none where all agree. */
export function differences(grasp, card) {
  return Object.entries(NAMES)
    .filter(([key]) => !same(grasp[key], card[key]))
    .map(([key, name]) => `${name} (workbook ${told(card[key])}, page ${told(grasp[key])})`);
}
