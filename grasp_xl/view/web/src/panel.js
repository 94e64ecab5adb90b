// The panel beside the picture: the card, the bill of material, the places and the genes.

import { differences } from "./agreement.js";
import { cardRows } from "./card.js";
import { make } from "./dom.js";
import { genesText } from "./genes.js";
import { number, state, STATIC, status, SWING } from "./words.js";

const cell = (text, attributes = {}) => make("td", attributes, text);
const numeric = (text) => cell(text, { class: "number" });

function valueCell(row, grasp, scene) {
  const met = row.met?.(grasp) ?? null;
  const ratio = row.ratio?.(grasp) ?? null;
  const full = row.full?.(grasp);
  const classes = ["number", row.vector && "vector", met !== null && (met ? "met" : "missed")];
  const attributes = { class: classes.filter(Boolean).join(" ") };
  if (typeof full === "number") attributes.title = String(full);
  const value = make("td", attributes, make("span", {}, row.value(grasp, scene)));
  if (met !== null) {
    const told = met ? "met" : "missed";
    const share = ratio === null ? "" : `${number(100 * ratio, 1)} %, `;
    value.append(make("small", {}, `${share}${told}`));
  }
  return value;
}

function cardLine(row, scene, entries) {
  const unit = row.unit ? make("span", { class: "unit" }, ` ${row.unit}`) : null;
  const values = entries.map(({ grasp }) => valueCell(row, grasp, scene));
  const name = make("th", { scope: "row" }, row.label, unit);
  if (row.vector && values.length === 1) {
    values[0].colSpan = 2;
    return make("tr", {}, name, values);
  }
  return make(
    "tr",
    {},
    name,
    cell(row.goal?.(scene.rules) ?? "", { class: "number goal" }),
    values,
  );
}

function cardTable(scene, entries) {
  const head = make(
    "tr",
    {},
    make("th", { scope: "col" }, "Card"),
    make("th", { scope: "col", class: "number" }, "Goal"),
    entries.map(({ design }) => make("th", { scope: "col", class: "number" }, design.name)),
  );
  const bodies = cardRows(scene).map(([title, rows]) => {
    const width = 2 + entries.length;
    const heading = make("th", { scope: "rowgroup", colspan: width, class: "group" }, title);
    const lines = rows.map((row) => cardLine(row, scene, entries));
    return make("tbody", {}, make("tr", {}, heading), lines);
  });
  return make("table", { class: "card" }, make("thead", {}, head), bodies);
}

function statusLine({ design, grasp }, several) {
  const name = several ? make("b", {}, `${design.name}: `) : null;
  return make("p", { class: `status ${state(grasp)}` }, name, status(grasp));
}

/** Most index genes whose row fits the panel. */
const NARROW = 8;
const AGREE = "The workbook and this page agree.";

function agreementLine({ design, grasp }, several) {
  const name = several ? `${design.name}: ` : "";
  if (!design.card) {
    return make(
      "p",
      { class: "agreement" },
      `${name}Not in the workbook; this page worked it out.`,
    );
  }
  const differing = differences(grasp, design.card);
  if (!differing.length) return make("p", { class: "agreement" }, `${name}${AGREE}`);
  const text = `${name}The workbook and this page differ: ${differing.join("; ")}.`;
  return make("p", { class: "agreement differs", role: "alert" }, text);
}

/** One line for each design, or one for both where there is nothing to say of either. */
function agreementLines(judged, several) {
  const agree = ({ design, grasp }) => design.card && !differences(grasp, design.card).length;
  if (judged.length && judged.every(agree)) return [make("p", { class: "agreement" }, AGREE)];
  return judged.map((entry) => agreementLine(entry, several));
}

function billTable(scene, grasp) {
  const used = scene.kinds
    .map((kind, position) => ({ kind, count: grasp.counts[position] }))
    .filter(({ count }) => count);
  const weights = used.map(({ kind, count }) =>
    kind.weight_g === null ? null : count * kind.weight_g,
  );
  const whole = weights.includes(null) ? null : weights.reduce((a, b) => a + b, 0);
  const header = ["Element", "Count", "Unit price $", "Price $", "Weight g"];
  const rows = used.map(({ kind, count }, position) =>
    make(
      "tr",
      {},
      make("th", { scope: "row" }, kind.model ? `${kind.label} ${kind.model}` : kind.label),
      numeric(number(count)),
      numeric(number(kind.price, 2)),
      numeric(number(count * kind.price, 2)),
      numeric(weights[position] === null ? "not known" : number(weights[position], 0)),
    ),
  );
  const sum = make(
    "tr",
    { class: "sum" },
    make("th", { scope: "row" }, "Sum"),
    numeric(number(grasp.elements.length)),
    cell(""),
    numeric(number(grasp.cost, 2)),
    numeric(whole === null ? "not known" : number(whole, 0)),
  );
  return table("Bill of material", header, [...rows, sum]);
}

function placesTable(scene, grasp, lit) {
  const header = ["Element", "Index", "x mm", "y mm", "z mm", "Force N"];
  const rows = grasp.elements.map((element) => {
    const kind = scene.kinds[element.kind];
    const swatch = make("span", { class: "swatch", "aria-hidden": "true" });
    swatch.style.background = kind.colour;
    const row = make(
      "tr",
      {},
      make("th", { scope: "row" }, swatch, kind.label),
      numeric(number(element.index)),
      ...element.place.map((value) => numeric(number(value, 2))),
      numeric(number(element.force, 1)),
    );
    row.addEventListener("pointerenter", () => lit(element));
    row.addEventListener("pointerleave", () => lit(null));
    return row;
  });
  return table("Places", header, rows);
}

function table(caption, header, rows) {
  const heads = header.map((text, position) =>
    make("th", { scope: "col", class: position ? "number" : "" }, text),
  );
  return make(
    "table",
    {},
    make("caption", {}, caption),
    make("thead", {}, make("tr", {}, heads)),
    make("tbody", {}, rows),
  );
}

function genesBox(scene, { design }, position, copied) {
  const id = `genes-${position}`;
  const text = make("textarea", { id, class: "genes", readonly: true, rows: 2, wrap: "off" });
  text.spellcheck = false;
  text.classList.toggle("wide", scene.gene_slots > NARROW);
  text.value = genesText(design.genes);
  const button = make("button", { type: "button", "data-copy": position }, "Copy");
  button.addEventListener("click", () => copied(text, design));
  const label = make("label", { for: id }, "Genes");
  return make("div", { class: "genes-box" }, make("div", { class: "row" }, label, button), text);
}

function faultyLine({ design, fault }, several) {
  const name = several ? `${design.name}: ` : "";
  return make("p", { class: "status faulty", role: "alert" }, `${name}${fault}`);
}

/**
 * Fill the panel for one or two designs: entries of { design, grasp } or { design, fault }.
 * `copied(textarea, design)` follows the Copy button, `lit(element)` a pointer over a place.
 */
export function fillPanel(box, scene, entries, { copied, lit }) {
  const several = entries.length > 1;
  const judged = entries.filter((entry) => entry.grasp);
  box.replaceChildren(
    make("div", { class: "lines" }, [
      ...entries.map((entry) => (entry.grasp ? statusLine : faultyLine)(entry, several)),
      ...agreementLines(judged, several),
    ]),
  );
  if (judged.length) box.append(cardTable(scene, judged));
  const swinging = judged.filter(({ grasp }) => grasp.support.can_swing);
  for (const { design } of swinging) {
    box.append(make("p", { class: "note" }, several ? `${design.name}: ${SWING}` : SWING));
  }
  box.append(make("p", { class: "note" }, STATIC));
  entries.forEach((entry, position) => {
    const section = make("section", { class: "of-design" });
    if (several) section.append(make("h3", {}, entry.design.name));
    if (entry.grasp) {
      section.append(billTable(scene, entry.grasp), placesTable(scene, entry.grasp, lit));
    }
    section.append(genesBox(scene, entry, position, copied));
    box.append(section);
  });
}
