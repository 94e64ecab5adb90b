// Numbers and sentences as a person reads them.

const formats = new Map();

function format(digits) {
  if (!formats.has(digits)) {
    formats.set(
      digits,
      new Intl.NumberFormat("en-GB", {
        minimumFractionDigits: digits,
        maximumFractionDigits: digits,
      }),
    );
  }
  return formats.get(digits);
}

/** A number with so many decimals, thousands parted by commas; a dash for none. */
export function number(value, digits = 0) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  const text = format(digits).format(value);
  return /^-[0.,]*$/.test(text) ? text.slice(1) : text.replace("-", "\u2212");
}

/** A point or an offset, in mm. */
export const point = (values, digits = 1) =>
  values.map((value) => number(value, digits)).join(", ");

/** What the card says of its grasp in one line; the words are the workbook's. */
export function status(grasp) {
  if (grasp.meets_all_goals) return "Meets FoS, distance and every goal.";
  if (grasp.feasible) return "Meets FoS and distance, not every goal.";
  return [
    grasp.meetsFos ? "" : "FoS is below its goal.",
    grasp.isClear ? "" : "Two elements are closer than the minimum distance.",
  ]
    .filter(Boolean)
    .join(" ");
}

/** The same as one word for style sheets. */
export function state(grasp) {
  if (!grasp) return "faulty";
  if (grasp.meets_all_goals) return "meets-all";
  return grasp.feasible ? "meets-some" : "fails";
}

export const SWING = "Fewer than three points out of line hold the part: it can swing.";
export const STATIC = "FoS is static and for the whole grasp.";
