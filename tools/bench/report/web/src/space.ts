// A figure in space: lines and dots seen from a direction that one can turn, without perspective. A 3 x 3 rotation is all it
// takes, and the same drawing, reading and saving as in the plane.
import { Chart } from "./chart";
import type { Figure, Series } from "./data";
import { short, type Range } from "./scale";
import type { Visible } from "./visible";

type Vector = [number, number, number];

const kStart = { turn: -0.6, tilt: 0.5 }; // [rad]

// Two horizontal axes and the upward one, right-handed.
function basisOf(up: string): [Vector, Vector, Vector] {
  const index = "xyz".indexOf(up.slice(-1));
  const sign = up.startsWith("-") ? -1 : 1;
  const unit = (k: number, size = 1): Vector => [k === 0 ? size : 0, k === 1 ? size : 0, k === 2 ? size : 0];
  const [a, b] = [unit((index + 1) % 3), unit((index + 2) % 3)];
  return sign > 0 ? [a, b, unit(index)] : [b, a, unit(index, -1)];
}

const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const sum = (a: Vector, b: Vector, s: number, t: number): Vector => [s * a[0] + t * b[0], s * a[1] + t * b[1], s * a[2] + t * b[2]];

export class SpaceChart extends Chart {
  private turn = kStart.turn;
  private tilt = kStart.tilt;
  private right: Vector = [1, 0, 0];
  private upwards: Vector = [0, 0, 1];
  private middle: Vector = [0, 0, 0];
  private radius = 1;

  // Beside what is drawn: how large a square of the floor is.
  readonly floor: string;

  constructor(figure: Figure, visible: Visible, parent: HTMLElement, height: number) {
    super(withAxes(figure), visible, parent, height);
    this.frame.setAttribute(
      "aria-label",
      `${figure.title}. ${figure.description} Drag or press arrow keys to turn, plus and minus zoom, 0 goes back.`,
    );
    this.floor = this.figure.series.find((series) => series.role === "context")?.name ?? "";
    this.measure();
    this.turnBy(0, 0);
  }

  override update(figure: Figure): void {
    this.figure = withAxes(figure);
    this.measure();
    this.draw();
  }

  // All of the paths, and of the landmarks nine of ten: a few far away must not make the rest small.
  private measure(): void {
    const low: Vector = [Infinity, Infinity, Infinity];
    const high: Vector = [-Infinity, -Infinity, -Infinity];
    for (const series of this.figure.series.filter((s) => s.role !== "context")) {
      [series.x, series.y, series.z].forEach((column, k) => {
        const sorted = Array.from(column ?? []).filter(Number.isFinite).sort((a, b) => a - b);
        const cut = series.draw === "dots" ? Math.floor(sorted.length / 20) : 0;
        low[k] = Math.min(low[k] ?? Infinity, sorted[cut] ?? Infinity);
        high[k] = Math.max(high[k] ?? -Infinity, sorted[sorted.length - 1 - cut] ?? -Infinity);
      });
    }
    if (!(low[0] <= high[0])) return;
    this.middle = sum(low, high, 0.5, 0.5);
    this.radius = Math.max(1e-9, Math.hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]) / 2);
  }

  turnBy(turn: number, tilt: number): void {
    this.turn += turn;
    this.tilt = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, this.tilt + tilt));
    const [a, b, up] = basisOf(this.figure.up);
    this.right = sum(a, b, Math.cos(this.turn), -Math.sin(this.turn));
    const ahead = sum(a, b, Math.sin(this.turn), Math.cos(this.turn));
    this.upwards = sum(ahead, up, Math.sin(this.tilt), Math.cos(this.tilt));
    this.draw();
  }

  override zoomTo(ranges?: { x?: Range; y?: Range }): void {
    if (!ranges) {
      this.turn = kStart.turn;
      this.tilt = kStart.tilt;
      this.turnBy(0, 0);
    }
    super.zoomTo(ranges);
  }

  override at(series: Series, index: number): [number, number] {
    const point: Vector = [series.x[index] ?? NaN, series.y[index] ?? NaN, series.z?.[index] ?? NaN];
    const from = sum(point, this.middle ?? [0, 0, 0], 1, -1);
    return [dot(from, this.right ?? [1, 0, 0]), dot(from, this.upwards ?? [0, 0, 1])];
  }

  protected override whole(): { x: Range; y: Range } {
    const reach = 1.02 * (this.radius ?? 1);
    return { x: { low: -reach, high: reach }, y: { low: -reach, high: reach } };
  }

  protected override axes() {
    const { x, y } = this.ranges();
    const hidden = { type: "value", show: false };
    return { xAxis: { ...hidden, min: x.low, max: x.high }, yAxis: { ...hidden, min: y.low, max: y.high } } as unknown as ReturnType<Chart["axes"]>;
  }
}

const withAxes = (figure: Figure): Figure => ({ ...figure, equal_scale: true, series: [...axesOf(figure), ...figure.series] });

// A grid below the paths, in whole units, and an arrow along each axis of the world from its corner: what is large and what is up.
function axesOf(figure: Figure): Series[] {
  const columns = (["x", "y", "z"] as const).map((name) =>
    figure.series.filter((s) => s.draw === "line").flatMap((s) => Array.from(s[name] ?? []).filter(Number.isFinite)),
  );
  const low = columns.map((values) => values.reduce((a, b) => Math.min(a, b), Infinity));
  const high = columns.map((values) => values.reduce((a, b) => Math.max(a, b), -Infinity));
  if (!low.every(Number.isFinite)) return [];
  const size = Math.max(...high.map((h, k) => h - (low[k] ?? h))) || 1;
  const power = 10 ** Math.floor(Math.log10(size / 3));
  const step = power * ([1, 2, 5].find((factor) => size / (factor * power) <= 8) ?? 10);
  const upIndex = "xyz".indexOf(figure.up.slice(-1));
  const floor = figure.up.startsWith("-") ? (high[upIndex] ?? 0) : (low[upIndex] ?? 0);
  const [a, b] = [(upIndex + 1) % 3, (upIndex + 2) % 3];
  const from = (k: number) => Math.floor((low[k] ?? 0) / step) * step;
  const to = (k: number) => Math.ceil((high[k] ?? 0) / step) * step;
  const points: number[][] = [];
  const add = (along: number, across: number, at: number) => {
    for (const end of [from(along), to(along)]) {
      const point = [0, 0, 0];
      point[along] = end;
      point[across] = at;
      point[upIndex] = floor;
      points.push(point);
    }
    points.push([NaN, NaN, NaN]);
  };
  for (let at = from(b); at <= to(b) + step / 2; at += step) add(a, b, at);
  for (let at = from(a); at <= to(a) + step / 2; at += step) add(b, a, at);
  const column = (k: number) => Float32Array.from(points, (point) => point[k] ?? NaN);
  return [{ name: `squares of the floor: ${short(step)} m`, draw: "line", role: "context", system: 0, faint: true, x: column(0), y: column(1), z: column(2) }];
}
