// Which names are shown: a system is shown or hidden on the whole page, anything else in its own figure.
import type { Figure, Series } from "./data";
import { make, say } from "./dom";

export class Visible {
  private readonly hidden = new Set<string>();
  private readonly listeners: (() => void)[] = [];
  constructor(private readonly systems: string[]) {}

  private key(figure: string, name: string): string {
    return this.systems.includes(name) ? name : `${figure}/${name}`;
  }
  shows(figure: string, name: string): boolean {
    return name === "" || !this.hidden.has(this.key(figure, name));
  }
  toggle(figure: string, name: string): void {
    const key = this.key(figure, name);
    if (!this.hidden.delete(key)) this.hidden.add(key);
    say(`${name} is ${this.hidden.has(key) ? "hidden" : "shown"}`);
    for (const listener of this.listeners) listener();
  }
  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }
}

export const colourOf = (role: string, system: number): string =>
  role === "system" ? `var(--s${system % 5})` : `var(--${role})`;

// Dashes of the systems: colour alone does not tell them apart.
export const kDashes: (number[] | "solid")[] = ["solid", [7, 3], [3, 2], [9, 3, 2, 3], [13, 4]];

// Buttons that show and hide, each with a piece of what it stands for.
export function legend(figure: Figure, visible: Visible): HTMLElement {
  const list = make("div", { class: "legend", role: "group", "aria-label": `Shown in ${figure.title}` });
  const names = new Set<string>();
  const last = (series: Series) => Number(series.faint) + 2 * Number(series.draw !== "line"); // lines stand for the rest
  for (const series of [...figure.series].sort((a, b) => last(a) - last(b))) {
    if (series.name === "" || names.has(series.name)) continue;
    names.add(series.name);
    const swatch = make("span", { class: `swatch ${series.draw}`, "aria-hidden": "true" });
    swatch.style.color = colourOf(series.role, series.system);
    const dash = series.role === "system" ? kDashes[series.system % 5] : "solid";
    if (dash !== "solid") swatch.classList.add("dashed");
    const button = make("button", { type: "button" }, swatch, series.name);
    const update = () => button.setAttribute("aria-pressed", String(visible.shows(figure.id, series.name)));
    button.addEventListener("click", () => visible.toggle(figure.id, series.name));
    visible.onChange(update);
    update();
    list.append(button);
  }
  return list;
}
