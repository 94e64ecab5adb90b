// How a grasp holds its part, as grasp_xl/stability.py says it: shown, not searched.

/** Area over the squared length of the grasp below which the points lie on one line. */
const FLAT = 1e-9;

const cross = (o, a, b) => (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);

/** Corners of the convex hull of points in plan view, counter-clockwise. */
export function hull(points) {
  const sorted = points.map((p) => [p[0], p[1]]).sort((p, q) => p[0] - q[0] || p[1] - q[1]);
  const chain = (ordered) => {
    const corners = [];
    for (const point of ordered) {
      while (corners.length > 1 && cross(corners.at(-2), corners.at(-1), point) <= 0) corners.pop();
      corners.push(point);
    }
    return corners.slice(0, -1);
  };
  return [...chain(sorted), ...chain(sorted.reverse())];
}

/** Hull area (mm²), whether the centroid is inside, whether the part can swing, element weight. */
export function support(scene, grasp) {
  const corners = hull(grasp.elements.map((each) => each.place));
  const twice = corners.reduce(
    (total, a, number) => total + cross(corners[0], a, corners[(number + 1) % corners.length]),
    0,
  );
  const flat = twice / 2 <= FLAT * grasp.longest_mm ** 2;
  const centroid = scene.part.centroid_mm;
  const inside = corners.every((a, number) => {
    const b = corners[(number + 1) % corners.length];
    const size = Math.hypot(b[0] - a[0], b[1] - a[1]);
    return cross(a, b, centroid) >= -FLAT * grasp.longest_mm * size;
  });
  const weights = scene.kinds.map((kind, number) =>
    grasp.counts[number]
      ? kind.weight_g === null
        ? null
        : grasp.counts[number] * kind.weight_g
      : 0,
  );
  return {
    hull_area_mm2: flat ? 0 : twice / 2,
    centroid_inside: !flat && inside,
    can_swing: flat,
    element_weight_g: weights.includes(null) ? null : weights.reduce((a, b) => a + b, 0),
  };
}
