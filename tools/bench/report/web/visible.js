// Visible series: a system is shown or hidden on the whole page, any other name in its own figure.

class Visible {
  /** @param {string[]} systems @param {() => void} changed */
  constructor(systems, changed) {
    this.systems = systems;
    this.changed = changed;
    this.hidden = new Set();
  }
  /** @param {string} figure @param {string} name */
  key(figure, name) {
    return this.systems.includes(name) ? name : `${figure}/${name}`;
  }
  /** @param {string} figure @param {string} name */
  shows(figure, name) {
    return name === "" || !this.hidden.has(this.key(figure, name));
  }
  /** @param {string} figure @param {string} name */
  toggle(figure, name) {
    const key = this.key(figure, name);
    if (!this.hidden.delete(key)) this.hidden.add(key);
    say(`${name} is ${this.hidden.has(key) ? "hidden" : "shown"}`);
    this.changed();
  }
}

/** @type {(series: Series) => string} */
const colourOf = ({ role, system }) => (role === "system" ? `var(--s${system % 5})` : `var(--${role})`);

// Systems differ by dash as well as by colour.
const kDashes = ["", "7 3", "3 2", "9 3 2 3", "13 4"];
/** @type {(series: Series) => string} */
const dashOf = ({ role, system, faint }) => (role === "system" && !faint ? kDashes[system % 5] : "");

/** Buttons that show and hide, each with a swatch. @type {(figure: Figure, visible: Visible) => HTMLElement} */
function legend(figure, visible) {
  const list = make("div", { class: "legend", role: "group", "aria-label": `Shown in ${figure.title}` });
  /** @type {(series: Series) => number} */
  const rank = (series) => Number(series.faint ?? 0) + 2 * Number(series.draw !== "line"); // lines stand for the rest
  const names = new Set([""]);
  for (const series of [...figure.series].sort((a, b) => rank(a) - rank(b))) {
    if (names.has(series.name)) continue;
    names.add(series.name);
    const dashed = dashOf(series) === "" ? "" : "dashed";
    const swatch = make("span", { class: `swatch ${series.draw} ${dashed}`, "aria-hidden": "true" });
    swatch.style.color = colourOf(series);
    const press = () => visible.toggle(figure.id, series.name);
    list.append(makeButton(press, { "data-name": series.name }, swatch, series.name));
  }
  return list;
}
