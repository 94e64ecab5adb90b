// The list of designs: one is shown; arrow keys, clicks and a search by group lead through it.

import { make } from "./dom.js";
import { number, state, status } from "./words.js";

export class DesignList {
  /** `chosen(number)` follows a choice. */
  constructor(box, { chosen }) {
    this.box = box;
    this.chosen = chosen;
    this.options = [];
    this.groups = new Map();
    box.addEventListener("keydown", (event) => this.#key(event));
    box.addEventListener("click", (event) => {
      const option = event.target.closest("[role=option]");
      if (option) chosen(this.options.indexOf(option));
    });
  }

  /** Put a design at the end of its group. */
  add(design) {
    const position = this.options.length;
    const value = make("span", { class: "value" });
    const option = make(
      "div",
      { role: "option", id: `design-${position}`, "aria-selected": "false" },
      make("span", { class: "dot", "aria-hidden": "true" }),
      make("span", { class: "name" }, design.name),
      value,
    );
    if (design.note) option.title = design.note;
    this.options.push(option);
    this.#group(design.group).append(option);
  }

  #group(name) {
    if (!this.groups.has(name)) {
      const group = make("div", { role: "group", "aria-label": name });
      group.append(make("div", { class: "group", role: "presentation" }, name));
      this.box.append(group);
      this.groups.set(name, group);
    }
    return this.groups.get(name);
  }

  /** Say what a design's grasp is worth; null where its genes are faulty. */
  judge(position, grasp) {
    const option = this.options[position];
    option.querySelector(".dot").className = `dot ${state(grasp)}`;
    option.querySelector(".value").textContent = grasp ? number(grasp.value, 3) : "–";
    option.title ||= grasp ? status(grasp) : "";
  }

  /** Mark the shown design, and the one it is compared with. */
  mark(shown, compared) {
    this.options.forEach((option, position) => {
      option.setAttribute("aria-selected", String(position === shown));
      option.classList.toggle("compared", position === compared);
    });
    this.shown = shown;
    const option = this.options[shown];
    this.box.setAttribute("aria-activedescendant", option.id);
    const [seen, row] = [this.box.getBoundingClientRect(), option.getBoundingClientRect()];
    if (row.top < seen.top) this.box.scrollTop -= seen.top - row.top + 28;
    if (row.bottom > seen.bottom) this.box.scrollTop += row.bottom - seen.bottom + 4;
  }

  /** Positions in the order in which they are seen: group by group. */
  order() {
    return [...this.box.querySelectorAll("[role=option]")].map((o) => this.options.indexOf(o));
  }

  #key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const order = this.order();
    const here = order.indexOf(this.shown);
    const last = order.length - 1;
    const page = 8;
    const to = {
      ArrowDown: Math.min(here + 1, last),
      ArrowUp: Math.max(here - 1, 0),
      PageDown: Math.min(here + page, last),
      PageUp: Math.max(here - page, 0),
      Home: 0,
      End: last,
    }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    if (to !== here) this.chosen(order[to]);
  }
}
