// The criteria and constraints of grasp_xl/criteria.py, once more, for the page: the same sums in
// the same order.  Points are [x, y, z] in mm, forces in N.

import { at } from "./data.js";

/** Relative slack of every comparison with FoS, clearance and goals. */
export const SLACK = 1e-9;

/** The terms of the fitness vector (eq. 9), in its order. */
export const TERMS = ["cost", "moment", "deviation", "structure"];

const sum = (numbers) => numbers.reduce((total, number) => total + number, 0);
const length = (...parts) => Math.sqrt(sum(parts.map((part) => part * part)));
const planDistance = (p, q) => length(q[0] - p[0], q[1] - p[1]);

function* pairs(count) {
  for (let i = 0; i < count; i += 1) {
    for (let j = i + 1; j < count; j += 1) yield [i, j];
  }
}

/** Active places of a design: kind (from 0), index (from 1), place and force. */
export function standing(scene, genes) {
  return scene.kinds.flatMap((kind, number) =>
    genes[number].slice(1, 1 + genes[number][0]).map((index) => ({
      kind: number,
      index,
      place: at(kind.places, index),
      force: kind.force_n,
    })),
  );
}

/** Force-weighted mean of the places, eq. 2. */
export function centreOfForce(elements) {
  const whole = sum(elements.map((each) => each.force));
  return [0, 1, 2].map(
    (axis) => sum(elements.map((each) => each.force * each.place[axis])) / whole,
  );
}

/** Distance of the centre of force to the centroid, eq. 3; the plan arm leaves its height out. */
export function eccentricity(centre, centroid, arm) {
  const offset = centre.map((value, axis) => value - centroid[axis]);
  return length(...(arm === "plan" ? offset.slice(0, 2) : offset));
}

/** Plan-view distance of a point to the boundary of a closed polygon. */
export function distanceToBoundary(point, polygon) {
  let least = Infinity;
  polygon.forEach((start, number) => {
    const end = polygon[(number + 1) % polygon.length];
    const edge = [end[0] - start[0], end[1] - start[1]];
    const along =
      ((point[0] - start[0]) * edge[0] + (point[1] - start[1]) * edge[1]) /
      (edge[0] * edge[0] + edge[1] * edge[1]);
    const part = Math.min(Math.max(along, 0), 1);
    const nearest = [start[0] + part * edge[0], start[1] + part * edge[1]];
    least = Math.min(least, planDistance(point, nearest));
  });
  return least;
}

/** Mean distance of the points to the ideal deflection polygon, eq. 6. */
export function deviation(points, polygon) {
  return sum(points.map((point) => distanceToBoundary(point, polygon))) / points.length;
}

/** Smallest plan-view distance of two points; null for one point. */
export function smallestDistance(points) {
  const all = [...pairs(points.length)].map(([i, j]) => planDistance(points[i], points[j]));
  return all.length ? Math.min(...all) : null;
}

/** R l_max plus all branches, with the main truss on a given pair of points, eq. 7. */
export function trussLength(points, [first, last], ratio) {
  const start = points[first];
  const axis = [points[last][0] - start[0], points[last][1] - start[1]];
  const main = length(...axis);
  if (main === 0) return 0;
  const others = points.filter((_, number) => number !== first && number !== last);
  const branches = others.map(
    (p) => Math.abs(axis[0] * (p[1] - start[1]) - axis[1] * (p[0] - start[0])) / main,
  );
  return ratio * main + sum(branches);
}

/**
 * The pair of points that the main truss joins, the farthest two; null for one point.
 * Of pairs within the slack of the longest, the one with the smallest structure.
 */
export function mainTruss(points, ratio) {
  if (points.length < 2) return null;
  const all = [...pairs(points.length)];
  const lengths = all.map(([i, j]) => planDistance(points[i], points[j]));
  const longest = Math.max(...lengths);
  let best = null;
  let least = Infinity;
  all.forEach((pair, number) => {
    if (lengths[number] < longest * (1 - SLACK)) return;
    const size = trussLength(points, pair, ratio);
    if (size < least) [best, least] = [pair, size];
  });
  return best;
}

/** Values over their goals, null for a dropped term, eq. 9. */
export function normalised(values, goals) {
  return Object.fromEntries(
    TERMS.map((term) => [term, goals[term] === null ? null : values[term] / goals[term]]),
  );
}

/** The number that is minimised: the divergence, one term in its own unit, or a sum of ratios. */
export function criterionValue(values, ratios, criterion) {
  const terms = criterion === "divergence" ? TERMS : criterion.split("+");
  if (terms.length === 1) return values[terms[0]];
  return sum(TERMS.filter((term) => terms.includes(term)).map((term) => ratios[term] ?? 0));
}

/** Judge a design by every criterion and constraint, as grasp_xl/grasp.py does. */
export function evaluate(scene, genes) {
  const { rules, part } = scene;
  const elements = standing(scene, genes);
  const points = elements.map((each) => each.place);
  const counts = genes.map((row) => row[0]);
  const force = sum(counts.map((count, number) => count * scene.kinds[number].force_n));
  const fos = force / part.weight_n;
  const centre = centreOfForce(elements);
  const arm = eccentricity(centre, part.centroid_mm, rules.moment_arm);
  const clearance = smallestDistance(points);
  const truss = mainTruss(points, rules.density_ratio);
  const values = {
    cost: sum(counts.map((count, number) => count * scene.kinds[number].price)),
    moment: arm * part.weight_n,
    deviation: deviation(points, scene.ideal_polygon_mm),
    structure: truss ? trussLength(points, truss, rules.density_ratio) : 0,
  };
  const ratios = normalised(values, rules.goals);
  const meetsFos = fos >= rules.fos * (1 - SLACK);
  const isClear = clearance === null || clearance >= rules.clearance_mm * (1 - SLACK);
  const feasible = meetsFos && isClear;
  const meetsGoals = TERMS.every((term) => ratios[term] === null || ratios[term] <= 1 + SLACK);
  return {
    elements,
    counts,
    force_n: force,
    fos,
    ...values,
    divergence: sum(TERMS.map((term) => ratios[term] ?? 0)),
    clearance,
    centre_mm: centre,
    offset_mm: part.centroid_mm.map((value, axis) => value - centre[axis]),
    arm_mm: arm,
    truss,
    longest_mm: truss ? planDistance(points[truss[0]], points[truss[1]]) : 0,
    ratios,
    value: criterionValue(values, ratios, rules.criterion),
    meetsFos,
    isClear,
    feasible,
    meets_all_goals: feasible && meetsGoals,
  };
}
