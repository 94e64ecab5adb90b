// Gene rows as text, as a person copies them from a workbook and pastes them "as is" (figure 34).

/** An inactive index gene that nobody set. */
const UNSET = 1;

/** Both rows as Excel's cells: tabs between genes, blank genes empty. */
export function genesText(genes) {
  return genes.map((row) => row.map((gene) => gene ?? "").join("\t")).join("\n");
}

/** The same on one line, for the address of the page. */
export function genesKey(genes) {
  return genes.map((row) => row.map((gene) => gene ?? "").join(".")).join("_");
}

/** Undo genesKey, unchecked. */
export function textOfKey(key) {
  return key.replaceAll(".", "\t").replaceAll("_", "\n");
}

function cells(line) {
  const parted = line.includes("\t") ? line.split("\t") : line.trim().split(/\s*[,;]\s*|\s+/);
  return parted.map((cell) => cell.trim());
}

function rowsOf(scene, text) {
  const lines = text.split(/[\r\n/]+/).filter((line) => line.trim());
  const rows = lines.map(cells);
  const kinds = scene.kinds.length;
  const [only] = rows;
  if (rows.length === 1 && only.length > kinds && only.length % kinds === 0) {
    const size = only.length / kinds;
    return scene.kinds.map((_, number) => only.slice(number * size, (number + 1) * size));
  }
  return rows;
}

const count = (number, word) => `${number} ${word}${number === 1 ? "" : "s"}`;

function rowName(scene, number) {
  return `Row ${number + 1} (${scene.kinds[number].label.toLowerCase()}s)`;
}

function readRow(scene, row, number) {
  const kind = scene.kinds[number];
  const where = rowName(scene, number);
  const known = row.filter((cell) => cell !== "");
  const strange = known.find((cell) => !/^\d{1,9}$/.test(cell));
  if (strange !== undefined) {
    const found = strange.length > 24 ? `${strange.slice(0, 24)}…` : strange;
    return { fault: `${where} has “${found}” where a whole number is expected.` };
  }
  if (known.length > 1 + scene.gene_slots) {
    const expected = `a count and at most ${count(scene.gene_slots, "index gene")} are expected`;
    return { fault: `${where} has ${count(known.length, "number")} where ${expected}.` };
  }
  const [active, ...indices] = known.map(Number);
  if (!(active >= kind.count_min && active <= kind.most)) {
    const found = active === undefined ? "is empty" : `begins with a count of ${active}`;
    const range = `${kind.count_min} to ${kind.most}`;
    return { fault: `${where} ${found} where ${range} may be.` };
  }
  if (indices.length < active) {
    const found = `has a count of ${active} and ${indices.length || "no"} `;
    const word = indices.length === 1 ? "index" : indices.length ? "indices" : "index";
    return { fault: `${where} ${found}${word} where at least ${active} are expected.` };
  }
  const used = indices.slice(0, active);
  const stray = used.find((index) => index < 1 || index > kind.total);
  if (stray !== undefined) {
    return { fault: `${where} has the index ${stray} where 1 to ${kind.total} are known.` };
  }
  const twice = used.find((index, position) => used.indexOf(index) < position);
  if (twice !== undefined) {
    const expected = "each place can hold one element";
    return { fault: `${where} has the index ${twice} more than once where ${expected}.` };
  }
  const inactive = Array.from({ length: scene.gene_slots - active }, (_, position) => {
    if (!kind.total) return null;
    const index = indices[active + position];
    return index >= 1 && index <= kind.total ? index : UNSET;
  });
  return { genes: [active, ...used, ...inactive] };
}

/** Read pasted rows: { genes } or { fault: one sentence }. */
export function readGenes(scene, text) {
  const rows = rowsOf(scene, text);
  const kinds = scene.kinds.length;
  if (rows.length !== kinds) {
    const names = scene.kinds.map((kind) => `${kind.label.toLowerCase()}s`);
    const expected = `two are expected: ${names.join(", then ")}`;
    const found =
      rows.length === 0
        ? "There are no genes"
        : `There ${rows.length === 1 ? "is one row" : `are ${rows.length} rows`} of genes`;
    return { fault: `${found} where ${expected}.` };
  }
  const read = rows.map((row, number) => readRow(scene, row, number));
  const faulty = read.find((row) => row.fault);
  if (faulty) return faulty;
  const genes = read.map((row) => row.genes);
  if (genes.every((row) => row[0] === 0)) {
    return { fault: "Both rows have a count of 0 where at least one element is expected." };
  }
  return { genes };
}
