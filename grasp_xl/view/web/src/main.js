// The page: reads its scene, shows the picture first, then everything that goes with it.

import { readAddress, writeAddress } from "./address.js";
import { copyField } from "./clipboard.js";
import { evaluate } from "./criteria.js";
import { readScene } from "./data.js";
import { find, make } from "./dom.js";
import { genesText, readGenes } from "./genes.js";
import { frame } from "./grip.js";
import { DesignList } from "./list.js";
import { fillPanel } from "./panel.js";
import { pixelRatio, Stage } from "./stage.js";
import { support } from "./support.js";
import { onThemeChange } from "./theme.js";
import { showTooltip } from "./tooltip.js";
import { number } from "./words.js";

const PASTED = "Pasted";
const NO_WEBGL =
  "This browser shows no 3-D pictures (WebGL is off or missing). Everything else works.";

const scene = readScene(find("scene").textContent);
const designs = scene.designs.map((design) => ({ ...design }));
const given = designs.length;
const judged = new Map();
const canvas = find("canvas");
let shown = 0;
let compared = null;

/** A design with its grasp, or with the fault of its genes; worked out once. */
function entry(position) {
  if (!judged.has(position)) {
    const design = designs[position];
    const read = readGenes(scene, genesText(design.genes));
    if (read.fault) {
      judged.set(position, { design, fault: read.fault });
    } else {
      const grasp = evaluate(scene, design.genes);
      judged.set(position, { design, grasp: { ...grasp, support: support(scene, grasp) } });
    }
  }
  return judged.get(position);
}

function openStage() {
  const options = { antialias: true, powerPreference: "low-power" };
  const ratio = pixelRatio();
  canvas.width = canvas.clientWidth * ratio;
  canvas.height = canvas.clientHeight * ratio;
  const context = canvas.getContext("webgl2", options);
  if (!context) {
    find("stage").classList.add("without");
    find("stage").append(make("p", { class: "missing" }, NO_WEBGL));
    canvas.hidden = true;
    return null;
  }
  return new Stage(canvas, context, scene, {
    told: (found, where) => showTooltip(find("tooltip"), scene, found, where),
    arranged: (stacked) => find("captions").classList.toggle("stacked", stacked),
  });
}

const list = new DesignList(find("designs"), { chosen: (position) => select(position) });
designs.forEach((design) => list.add(design));
const stage = openStage();

function entries() {
  return [shown, ...(compared === null ? [] : [compared])].map(entry);
}

function say(text) {
  find("live").textContent = text;
}

/** Draw the shown designs; the words can follow. */
function draw() {
  document.querySelector("main").classList.toggle("comparing", compared !== null);
  const grasps = entries().flatMap(({ grasp }) => (grasp ? [grasp] : []));
  stage?.show(grasps);
  const names = grasps.length > 1 ? entries().map(({ design }) => design.name) : [];
  find("captions").replaceChildren(...names.map((name) => make("span", {}, name)));
}

function tell() {
  list.mark(shown, compared);
  fillPanel(find("panel"), scene, entries(), {
    copied,
    lit: (element) => stage?.light(element),
  });
  find("compare").setAttribute("aria-pressed", String(compared !== null));
  find("comparison").hidden = compared === null;
  find("with").value = compared === null ? "" : String(compared);
  document.title = `${designs[shown].name} – ${scene.title}`;
}

function show(nextShown, nextCompared) {
  shown = nextShown;
  compared = nextCompared;
  draw();
  tell();
  writeAddress(designs, given, shown, compared);
  const beside = compared === null ? "" : `, compared with ${designs[compared].name}`;
  say(`Shown: ${designs[shown].group}, ${designs[shown].name}${beside}`);
}

function select(position) {
  if (designs[position]) show(position, compared === position ? shown : compared);
}

/** The design that a comparison begins with: the benchmark, else the best other one. */
function usualComparison() {
  const others = designs.map((_, position) => position).filter((position) => position !== shown);
  const benchmark = others.find((position) => designs[position].group === "Benchmark");
  if (benchmark !== undefined) return benchmark;
  const value = (position) => entry(position).grasp?.value ?? Infinity;
  return others.length ? others.reduce((a, b) => (value(b) < value(a) ? b : a)) : null;
}

async function copied(field, design) {
  const done = await copyField(field);
  say(done ? `Genes of ${design.name} copied.` : "The genes are selected: press Ctrl+C.");
  const button = field.parentElement.querySelector("button");
  button.textContent = done ? "Copied" : "Selected";
  setTimeout(() => (button.textContent = "Copy"), 1500);
}

/** Position of genes that the page did not come with; they become a design at the end. */
function positionOf(genes) {
  const same = designs.findIndex(
    (design, position) => position >= given && genesText(design.genes) === genesText(genes),
  );
  if (same >= 0) return same;
  const position = designs.length;
  const name = position > given ? `${PASTED} ${position - given + 1}` : PASTED;
  designs.push({ group: PASTED, name, note: "", genes, card: null });
  list.add(designs[position]);
  list.judge(position, entry(position).grasp);
  addOption(position);
  return position;
}

/** Show pasted genes, or say what is wrong with them. */
function paste(text) {
  const { genes, fault } = readGenes(scene, text);
  find("fault").textContent = fault ?? "";
  find("fault").hidden = !fault;
  find("pasted").setAttribute("aria-invalid", String(Boolean(fault)));
  if (!fault) select(positionOf(genes));
}

function addOption(position) {
  const { group, name } = designs[position];
  const select = find("with");
  let box = [...select.children].find((each) => each.label === group);
  if (!box) {
    box = make("optgroup", { label: group });
    select.append(box);
  }
  box.append(make("option", { value: position }, name));
}

/** What the address of the page asks for, as far as it can be had. */
function asked() {
  const said = readAddress();
  const position = (each) => {
    if (!each) return null;
    if (each.text === undefined) return each.number < given ? each.number : null;
    const { genes } = readGenes(scene, each.text);
    return genes ? positionOf(genes) : null;
  };
  const first = position(said.shown) ?? Math.min(Math.max(scene.shown, 0), given - 1);
  const second = position(said.compared);
  return [first, second === first ? null : second];
}

function wireControls() {
  for (const button of document.querySelectorAll("[data-view]")) {
    button.addEventListener("click", () => stage?.view(button.dataset.view));
  }
  find("fit").addEventListener("click", () => stage?.fit());
  find("nearer").addEventListener("click", () => stage?.zoom(1.25));
  find("farther").addEventListener("click", () => stage?.zoom(0.8));
  find("perspective").addEventListener("change", (event) => {
    if (stage) stage.perspective = event.target.checked;
  });
  for (const box of document.querySelectorAll("[data-layer]")) {
    box.addEventListener("change", () => stage?.layer(box.dataset.layer, box.checked));
  }
  find("compare").addEventListener("click", () =>
    show(shown, compared === null ? usualComparison() : null),
  );
  find("with").addEventListener("change", (event) => {
    const position = Number(event.target.value);
    if (position === shown) show(compared, shown);
    else show(shown, position);
  });
  find("swap").addEventListener("click", () => show(compared, shown));
  find("paste").addEventListener("submit", (event) => {
    event.preventDefault();
    paste(find("pasted").value);
  });
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target.closest("textarea, select, input:not([type=checkbox])")) return;
    const views = { 1: "top", 2: "front", 3: "side", 4: "isometric" };
    if (views[event.key]) stage?.view(views[event.key]);
    else if (event.key === "0") stage?.fit();
  });
  addEventListener("hashchange", () => show(...asked()));
  addEventListener("beforeprint", () => stage?.print(find("paper")));
  onThemeChange(() => stage?.paint());
}

/** Work that nobody waits for: numbers of the list, edges of the part. */
function afterwards() {
  designs.forEach((_, position) => list.judge(position, entry(position).grasp));
  if (!stage) return;
  stage.around.addEdges();
  stage.draw();
}

function subtitle() {
  const { part } = scene;
  return [part.name, `${number(part.mass_g, 1)} g`, `${number(part.weight_n, 1)} N`]
    .filter(Boolean)
    .join(" · ");
}

function start() {
  find("title").textContent = scene.title;
  find("subtitle").textContent = subtitle();
  designs.forEach((_, position) => addOption(position));
  find("compare").disabled = designs.length < 2;
  [shown, compared] = asked();
  draw();
  stage?.render();
  performance.mark("first-picture");
  tell();
  wireControls();
  (window.requestIdleCallback ?? setTimeout)(afterwards);
}

start();

/** For tests: what is shown, as numbers. */
window.graspView = Object.freeze({
  designs: () => designs.map(({ group, name }) => ({ group, name })),
  shown: () => shown,
  compared: () => compared,
  card: (position = shown) => {
    const { grasp, fault } = entry(position);
    return fault ? { fault } : JSON.parse(JSON.stringify(grasp));
  },
  bars: (position = shown) => JSON.parse(JSON.stringify(frame(scene, entry(position).grasp))),
  genes: () => genesText(designs[shown].genes),
  select,
  /** Where an element of the shown design is in the picture. */
  spot: (number) => {
    const { place, kind } = entry(shown).grasp.elements[number];
    return stage.spot([place[0], place[1], place[2] + scene.kinds[kind].height_mm / 4]);
  },
  /** How many pixels of the picture are not of its most frequent colour, of how many, and that. */
  pixels: () => {
    stage.render();
    const gl = stage.renderer.getContext();
    const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
    const seen = new Uint32Array(width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(seen.buffer));
    const counts = new Map();
    for (const colour of seen) counts.set(colour, (counts.get(colour) ?? 0) + 1);
    const [ground, most] = [...counts].reduce((a, b) => (b[1] > a[1] ? b : a));
    const channels = [ground & 255, (ground >> 8) & 255, (ground >> 16) & 255];
    return { drawn: seen.length - most, all: seen.length, ground: channels };
  },
});
