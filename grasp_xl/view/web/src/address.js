// The shown and the compared design in the address of the page, so that a reload keeps them.

import { genesKey, textOfKey } from "./genes.js";

/** What the address says: texts by name, a design's number or the genes of a pasted one. */
export function readAddress() {
  const said = new URLSearchParams(location.hash.slice(1));
  const one = (name) => {
    const value = said.get(name);
    if (value === null || value === "") return null;
    return /^\d+$/.test(value) ? { number: Number(value) } : { text: textOfKey(value) };
  };
  return { shown: one("shown"), compared: one("compare") };
}

/** Put designs there; `given` is how many the page came with, and later ones are named by genes. */
export function writeAddress(designs, given, shown, compared) {
  const name = (number) => (number < given ? String(number) : genesKey(designs[number].genes));
  const said = new URLSearchParams({ shown: name(shown) });
  if (compared !== null) said.set("compare", name(compared));
  try {
    history.replaceState(null, "", `#${said}`);
  } catch {
    // a page without an address of its own keeps nothing
  }
}
