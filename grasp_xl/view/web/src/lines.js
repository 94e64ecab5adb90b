// Lines of a width in pixels.

import { LineMaterial, LineSegments2, LineSegmentsGeometry } from "./three.js";

/** A line through points, closed or not. */
export function line(points, width, { closed = false, dashed = null } = {}) {
  const ends = [];
  points.forEach((point, number) => {
    const next = points[number + 1] ?? (closed ? points[0] : null);
    if (next) ends.push(...point, ...next);
  });
  const geometry = new LineSegmentsGeometry();
  geometry.setPositions(ends);
  const material = new LineMaterial({ linewidth: width });
  if (dashed) {
    material.dashed = true;
    [material.dashSize, material.gapSize] = dashed;
  }
  const segments = new LineSegments2(geometry, material);
  if (dashed) segments.computeLineDistances();
  return segments;
}
