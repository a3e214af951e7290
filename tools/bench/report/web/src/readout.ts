// Exact values where the pointer is, or where the arrow keys have gone.
import type { Chart } from "./chart";
import { kMargin } from "./chart";
import type { Series } from "./data";
import { exact, make, say } from "./dom";
import { colourOf } from "./visible";

interface Hit {
  series: Series;
  index: number;
  distance: number; // [px]
}

const kReach = 30; // [px] from a path

export class Readout {
  private readonly box = make("div", { class: "readout", hidden: "" });
  private readonly rule = make("div", { class: "rule", hidden: "" });
  private index = -1; // of the keyboard's place, in the longest series

  constructor(private readonly chart: Chart) {
    chart.frame.append(this.rule, this.box);
    chart.onDraw(() => this.hide());
  }

  hide(): void {
    this.box.hidden = this.rule.hidden = true;
  }

  // A path is read at its nearest point, anything else along x.
  private isPath(): boolean {
    return this.chart.figure.equal_scale || this.chart.figure.kind === "space";
  }

  private nearest(series: Series, px: number, py: number): Hit | undefined {
    let best: Hit | undefined;
    for (let index = 0; index < series.x.length; ++index) {
      const at = this.chart.at(series, index);
      const [x, y] = this.chart.toPixels(at);
      const distance = this.isPath() ? Math.hypot(x - px, y - py) : Math.abs(x - px);
      if (distance < (best?.distance ?? Infinity)) best = { series, index, distance };
    }
    return best;
  }

  // In the order of the figure; faint ones only where nothing else is near.
  private hits(px: number, py: number): Hit[] {
    const shown = this.chart.shown().filter((series) => this.isPath() || !series.faint);
    const found = shown.map((series) => this.nearest(series, px, py)).filter((hit): hit is Hit => hit !== undefined);
    if (this.isPath()) return found.filter((hit) => hit.distance < kReach).sort((a, b) => a.distance - b.distance).slice(0, 1);
    const closest = Math.min(...found.map((hit) => hit.distance));
    return found.filter((hit) => hit.distance <= closest + 4);
  }

  private describe({ series, index }: Hit): string {
    const { figure } = this.chart;
    const note = series.notes?.[index];
    const value = (column?: Float32Array) => exact(column?.[index] ?? NaN);
    const time = series.t ? ` at ${value(series.t)} s` : "";
    if (series.z) return `(${value(series.x)}, ${value(series.y)}, ${value(series.z)}) m${time}`;
    if (figure.equal_scale) return `(${value(series.x)}, ${value(series.y)}) m${time}`;
    if (note) return note;
    if (series.draw === "interval") return `${value(series.x)} to ${value(series.high)}`;
    return series.high ? `${value(series.y)} to ${value(series.high)}` : value(series.y);
  }

  // Shows what is near; its text.
  at(px: number, py: number): string {
    const hits = this.hits(px, py);
    const first = hits[0];
    if (!first) {
      this.hide();
      return "";
    }
    const { figure } = this.chart;
    const [x, y] = this.chart.toPixels(this.chart.at(first.series, first.index));
    const head = this.isPath() ? "" : `${figure.x.label.replace(/ \[.*/, "")} ${exact(first.series.x[first.index] ?? NaN)}${unitOf(figure.x.label)}`;
    this.box.replaceChildren(...(head ? [make("div", { class: "head" }, head)] : []));
    for (const hit of hits) {
      const swatch = make("span", { class: "dot" });
      swatch.style.background = colourOf(hit.series.role, hit.series.system);
      this.box.append(make("div", {}, swatch, `${hit.series.name} `, make("b", {}, this.describe(hit))));
    }
    this.box.hidden = false;
    this.rule.hidden = this.isPath();
    this.rule.style.left = `${x}px`;
    this.rule.style.top = `${kMargin.top}px`;
    this.rule.style.height = `${this.chart.inner().height}px`;
    const width = this.chart.frame.clientWidth;
    const left = x + 14 + this.box.offsetWidth > width ? x - 14 - this.box.offsetWidth : x + 14;
    this.box.style.left = `${Math.max(0, Math.min(left, width - this.box.offsetWidth))}px`;
    const above = this.isPath() ? y - 12 - this.box.offsetHeight : py - 10;
    this.box.style.top = `${Math.max(0, Math.min(above < 0 ? y + 12 : above, this.chart.frame.clientHeight - this.box.offsetHeight))}px`;
    return [head, ...hits.map((hit) => `${hit.series.name} ${this.describe(hit)}`)].filter(Boolean).join(", ");
  }

  // By the keyboard: to the next point of what is read first.
  step(by: number): void {
    const shown = this.chart.shown().filter((series) => !series.faint && series.draw !== "interval");
    const longest = shown.reduce<Series | undefined>((a, b) => (a && a.x.length >= b.x.length ? a : b), undefined);
    if (!longest) return;
    this.index = Math.max(0, Math.min(longest.x.length - 1, this.index + by));
    const [x, y] = this.chart.toPixels(this.chart.at(longest, this.index));
    say(this.at(x, Number.isFinite(y) ? y : kMargin.top));
  }
}

function unitOf(label: string): string {
  const found = label.match(/\[(.*)\]/);
  return found ? ` ${found[1]}` : "";
}

