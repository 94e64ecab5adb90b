// What stands where in a design: elements, posts, and the frame over them (figures 19, 35, 36).

/** The bars of the frame: { main, branches, posts }, each bar { start, end, radius }. */
export function frame(scene, grasp) {
  const { main_radius_mm, branch_radius_mm, rise_mm } = scene.frame;
  const tops = grasp.elements.map((each) => each.place[2] + scene.kinds[each.kind].height_mm);
  const height = Math.max(...tops) + rise_mm;
  const lifted = (place) => [place[0], place[1], height];
  const posts = grasp.elements.map((each, number) => ({
    start: [each.place[0], each.place[1], tops[number]],
    end: lifted(each.place),
    radius: scene.kinds[each.kind].post_radius_mm,
  }));
  if (!grasp.truss || grasp.longest_mm === 0) return { height, main: [], branches: [], posts };
  const [start, end] = grasp.truss.map((number) => lifted(grasp.elements[number].place));
  const branches = grasp.elements
    .filter((_, number) => !grasp.truss.includes(number))
    .map((each) => ({
      start: lifted(each.place),
      end: foot(lifted(each.place), start, end),
      radius: branch_radius_mm,
    }));
  return { height, main: [{ start, end, radius: main_radius_mm }], branches, posts };
}

/** Nearest point of the main truss's line: no element lies beyond its ends. */
function foot(point, start, end) {
  const axis = [end[0] - start[0], end[1] - start[1]];
  const along =
    ((point[0] - start[0]) * axis[0] + (point[1] - start[1]) * axis[1]) /
    (axis[0] * axis[0] + axis[1] * axis[1]);
  return [start[0] + along * axis[0], start[1] + along * axis[1], point[2]];
}
