// The scene as Python wrote it, with its packed arrays unpacked.

function bytes(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const packed = atob(text);
  const values = new Uint8Array(packed.length);
  for (let i = 0; i < packed.length; i += 1) values[i] = packed.charCodeAt(i);
  return values;
}

/** Place of a 1-based index in a flat list of places: [x, y, z] in mm. */
export function at(places, index) {
  return [places[3 * index - 3], places[3 * index - 2], places[3 * index - 1]];
}

function mesh(packed) {
  if (!packed) return null;
  return {
    positions: new Float32Array(bytes(packed.positions).buffer),
    triangles: new Uint32Array(bytes(packed.triangles).buffer),
  };
}

function kind(packed) {
  const places = new Float64Array(bytes(packed.footprints_mm).buffer);
  const total = places.length / 3;
  return { ...packed, places, total, most: Math.min(packed.count_max, total) };
}

/** Read the scene of a page; its designs are put into a list of their own, which can grow. */
export function readScene(text) {
  const packed = JSON.parse(text);
  return {
    ...packed,
    part: { ...packed.part, mesh: mesh(packed.part.mesh) },
    kinds: packed.kinds.map(kind),
  };
}
