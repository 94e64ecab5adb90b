// Rings in plan view that nest by even-odd: which are outlines, and which are holes in them.

function inside([x, y], ring) {
  let odd = false;
  ring.forEach(([ax, ay], number) => {
    const [bx, by] = ring[(number + 1) % ring.length];
    if (ay > y !== by > y && x < ax + ((y - ay) / (by - ay)) * (bx - ax)) odd = !odd;
  });
  return odd;
}

const open = (ring) => {
  const [first, last] = [ring[0], ring.at(-1)];
  return first[0] === last[0] && first[1] === last[1] ? ring.slice(0, -1) : ring;
};

/** Areas of rings: [{ outline, holes }]. */
export function areas(closed) {
  const rings = closed.map(open).filter((ring) => ring.length > 2);
  const around = rings.map((ring) =>
    rings.flatMap((other, number) => (other !== ring && inside(ring[0], other) ? [number] : [])),
  );
  return rings.flatMap((outline, number) => {
    const depth = around[number].length;
    if (depth % 2) return [];
    const holes = rings.filter(
      (_, other) => around[other].length === depth + 1 && around[other].includes(number),
    );
    return [{ outline, holes }];
  });
}
