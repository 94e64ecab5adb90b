// Colours of the picture, taken from the page's style sheet so that both change together.

const dark = matchMedia("(prefers-color-scheme: dark)");

export function theme() {
  const style = getComputedStyle(document.documentElement);
  const colour = (name) => style.getPropertyValue(`--${name}`).trim();
  return {
    stage: colour("stage"),
    ink: colour("ink"),
    paper: colour("paper"),
    part: colour("part"),
    edge: colour("edge"),
    main: colour("main-truss"),
    branches: colour("branch"),
    posts: colour("post"),
    partPolygon: colour("part-polygon"),
    idealPolygon: colour("ideal-polygon"),
    force: colour("force"),
  };
}

/** Call when the person's machine turns dark or light. */
export function onThemeChange(changed) {
  dark.addEventListener("change", changed);
}
