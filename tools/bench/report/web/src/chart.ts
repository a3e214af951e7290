// A figure in the plane: axes, lines, bands, dots and bars by ECharts; zoom by dragging a box.
import { CustomChart, LineChart, ScatterChart } from "echarts/charts";
import { GridComponent } from "echarts/components";
import { init, use, type EChartsType } from "echarts/core";
import { SVGRenderer } from "echarts/renderers";

import type { Axis, Figure, Series } from "./data";
import { make, say } from "./dom";
import { equalised, marks, place, rangesOf, short, valueAt, type Range } from "./scale";
import { colourOf, kDashes, type Visible } from "./visible";

use([CustomChart, LineChart, ScatterChart, GridComponent, SVGRenderer]);

export const kMargin = { left: 58, right: 14, top: 10, bottom: 42 };

// Coordinates of the frame inside the margins, as ECharts hands them to what draws.
interface Api {
  coord(point: [number, number]): [number, number];
}

export class Chart {
  readonly frame: HTMLDivElement; // what the pointer and the keyboard work on
  protected readonly drawing: EChartsType;
  private zoomed?: { x: Range; y: Range };
  private readonly watchers: (() => void)[] = [];

  constructor(
    public figure: Figure,
    readonly visible: Visible,
    parent: HTMLElement,
    height: number,
  ) {
    this.frame = make("div", {
      class: "frame",
      tabindex: "0",
      role: "application",
      "aria-roledescription": "chart",
      "aria-label": `${figure.title}. ${figure.description} Arrow keys read out values, plus and minus zoom, 0 shows all.`,
    });
    const canvas = make("div", { class: "canvas", "aria-hidden": "true" });
    canvas.style.height = `${height}px`;
    this.frame.append(canvas);
    parent.append(this.frame);
    this.drawing = init(canvas, null, { renderer: "svg" });
    this.draw();
    visible.onChange(() => this.draw());
    new ResizeObserver(() => this.resize()).observe(canvas);
  }

  // Other numbers in the same series.
  update(figure: Figure): void {
    this.figure = figure;
    this.draw();
  }

  get element(): HTMLElement {
    return this.drawing.getDom();
  }
  onDraw(watcher: () => void): void {
    this.watchers.push(watcher);
  }

  shown(): Series[] {
    return this.figure.series.filter((series) => this.visible.shows(this.figure.id, series.name));
  }

  // Where a point of a series is drawn, in the units of the axes: what is infinite, on the edge.
  at(series: Series, index: number): [number, number] {
    return [place(this.figure.x, series.x[index] ?? NaN), this.placeY(series.y[index] ?? NaN)];
  }
  private placeY(value: number): number {
    if (value === Infinity) return this.ranges().y.high;
    return value === -Infinity ? this.ranges().y.low : place(this.figure.y, value);
  }

  protected whole(): { x: Range; y: Range } {
    return rangesOf(this.figure);
  }
  // How much of the figure is seen now.
  ranges(): { x: Range; y: Range } {
    if (this.zoomed) return this.zoomed;
    const ranges = this.whole();
    return this.figure.equal_scale ? equalised(ranges, this.inner().width, this.inner().height) : ranges;
  }
  inner(): { width: number; height: number } {
    return {
      width: Math.max(1, this.drawing.getWidth() - kMargin.left - kMargin.right),
      height: Math.max(1, this.drawing.getHeight() - kMargin.top - kMargin.bottom),
    };
  }

  // From a place on the screen, relative to the drawing, to the axes' units and back.
  toAxes(px: number, py: number): [number, number] {
    const { x, y } = this.ranges();
    const { width, height } = this.inner();
    const share = (at: number, of: number, reversed?: boolean) => (reversed ? 1 - at / of : at / of);
    return [
      x.low + share(px - kMargin.left, width, this.figure.x.reversed) * (x.high - x.low),
      y.low + (1 - share(py - kMargin.top, height, this.figure.y.reversed)) * (y.high - y.low),
    ];
  }
  toPixels([ax, ay]: [number, number]): [number, number] {
    const { x, y } = this.ranges();
    const { width, height } = this.inner();
    const along = (ax - x.low) / (x.high - x.low);
    const up = (ay - y.low) / (y.high - y.low);
    return [
      kMargin.left + (this.figure.x.reversed ? 1 - along : along) * width,
      kMargin.top + (this.figure.y.reversed ? up : 1 - up) * height,
    ];
  }

  zoomTo(ranges?: { x?: Range; y?: Range }): void {
    this.zoomed = ranges && { ...this.ranges(), ...ranges };
    this.draw();
    say(ranges ? `${this.figure.title} is zoomed` : `${this.figure.title} shows all`);
  }
  // About the middle; above 1 less is seen.
  zoomBy(factor: number): void {
    const about = ({ low, high }: Range): Range => {
      const half = (high - low) / 2 / factor;
      return { low: (low + high) / 2 - half, high: (low + high) / 2 + half };
    };
    const { x, y } = this.ranges();
    this.zoomTo({ x: about(x), y: about(y) });
  }
  isZoomed(): boolean {
    return this.zoomed !== undefined;
  }

  // Where the axis is marked: at the doses where it is one of stress, as far as there is room.
  private marksOf(axis: Axis, range: Range, pixels: number, horizontal: boolean): number[] {
    if (!axis.stress) return marks(axis, range, pixels / (horizontal ? 64 : 34));
    const doses = new Set(this.figure.series.filter((series) => series.draw === "line").flatMap((series) => [...series.x]));
    let last = -Infinity;
    return [...doses]
      .map((dose) => place(axis, dose))
      .sort((a, b) => a - b)
      .filter((mark) => {
        const at = ((mark - range.low) / (range.high - range.low)) * pixels;
        if (at - last < 34) return false;
        last = at;
        return true;
      });
  }

  private axisOption(axis: Axis, range: Range, horizontal: boolean) {
    const { width, height } = this.inner();
    const at = this.marksOf(axis, range, horizontal ? width : height, horizontal);
    return {
      type: "value",
      min: range.low,
      max: range.high,
      inverse: axis.reversed ?? false,
      name: axis.label,
      nameLocation: "middle",
      nameGap: horizontal ? 26 : 44,
      nameTextStyle: { color: "var(--dim)", fontSize: 12 },
      axisLine: { show: true, onZero: false, lineStyle: { color: "var(--dim)" } },
      axisTick: { show: true, lineStyle: { color: "var(--dim)" }, customValues: at },
      axisLabel: {
        color: "var(--dim)",
        fontSize: 11,
        customValues: at,
        hideOverlap: true,
        formatter: (mark: number) => short(valueAt(axis, mark)),
      },
      splitLine: { show: true, lineStyle: { color: "var(--rule)", width: 0.7 } },
    };
  }

  protected axes() {
    const { x, y } = this.ranges();
    return { xAxis: this.axisOption(this.figure.x, x, true), yAxis: this.axisOption(this.figure.y, y, false) };
  }

  private seriesOption(series: Series, all: Series[]) {
    const colour = colourOf(series.role, series.system);
    const points = Array.from(series.x, (_, i) => this.at(series, i).map((v) => (Number.isFinite(v) ? v : null)));
    const common = { name: series.name, silent: true, animation: false, clip: true, emphasis: { disabled: true } };
    switch (series.draw) {
      case "line": {
        const dash = series.role === "system" && !series.faint ? (kDashes[series.system % 5] ?? "solid") : "solid";
        const width = series.role === "truth" ? 2.4 : series.faint ? 0.8 : 1.6;
        const opacity = series.role === "truth" ? 0.6 : series.faint ? 0.4 : 1;
        const lineStyle = { color: colour, width, opacity, type: dash };
        const few = series.x.length <= 16 && !series.faint; // the points themselves are worth seeing
        return { ...common, type: "line", data: points, lineStyle, itemStyle: { color: colour }, showSymbol: few, symbol: "circle", symbolSize: 5 };
      }
      case "dots": {
        const size = !series.faint ? 9 : points.length > 300 ? 2.2 : 4;
        return { ...common, type: "scatter", data: points, symbolSize: size, large: true, largeThreshold: 100, itemStyle: { color: colour, opacity: series.faint ? 0.55 : 1 } };
      }
      default:
        return { ...common, type: "custom", data: points.slice(0, 1), renderItem: (_: unknown, api: Api) => this.shape(series, all, colour, api) };
    }
  }

  // Bands, bars and intervals: all of it at once.
  private shape(series: Series, all: Series[], colour: string, api: Api) {
    const point = (x: number, value: number) => api.coord([place(this.figure.x, x), this.placeY(value)]);
    const children: object[] = [];
    if (series.draw === "band") {
      let upper: [number, number][] = [];
      let lower: [number, number][] = [];
      const close = () => {
        if (upper.length > 1) {
          children.push({ type: "polygon", shape: { points: [...upper, ...lower.reverse()] }, style: { fill: colour, opacity: 0.18 } });
        }
        upper = [];
        lower = [];
      };
      series.x.forEach((x, i) => {
        const low = point(x, series.y[i] ?? NaN);
        const high = point(x, series.high?.[i] ?? NaN);
        if (low.every(Number.isFinite) && high.every(Number.isFinite)) {
          lower.push(low);
          upper.push(high);
        } else {
          close();
        }
      });
      close();
    } else if (series.draw === "bars") {
      const beside = all.filter((other) => other.draw === "bars");
      const width = 0.8 / beside.length;
      series.x.forEach((x, i) => {
        const left = x - 0.4 + width * beside.indexOf(series);
        const [x0, y0] = api.coord([left, 0]);
        const [x1, y1] = api.coord([left + width * 0.92, series.y[i] ?? 0]);
        children.push({ type: "rect", shape: { x: x0, y: y1, width: x1 - x0, height: y0 - y1 }, style: { fill: colour } });
      });
    } else {
      series.x.forEach((x, i) => {
        const [x0, y0] = point(x, series.y[i] ?? NaN);
        const [x1] = point(series.high?.[i] ?? NaN, series.y[i] ?? NaN);
        children.push({ type: "line", shape: { x1: x0, y1: y0, x2: x1, y2: y0 }, style: { stroke: colour, lineWidth: 4, opacity: 0.5 } });
      });
    }
    return { type: "group", children };
  }

  draw(): void {
    const shown = this.shown();
    this.drawing.setOption(
      {
        animation: false,
        grid: { ...kMargin, outerBoundsMode: "none" },
        textStyle: { fontFamily: "system-ui, -apple-system, 'Segoe UI', Roboto, 'Liberation Sans', sans-serif" },
        ...this.axes(),
        series: shown.map((series) => this.seriesOption(series, shown)),
      },
      { notMerge: true },
    );
    const svg = this.element.querySelector("svg"); // scales with its frame, on paper too
    svg?.setAttribute("viewBox", `0 0 ${this.drawing.getWidth()} ${this.drawing.getHeight()}`);
    for (const watcher of this.watchers) watcher();
  }

  private resize(): void {
    if (this.element.clientWidth === this.drawing.getWidth() || this.element.clientWidth === 0) return;
    this.drawing.resize();
    this.draw();
  }

  // The drawing as a file of its own, in the light colours.
  svgText(): string {
    const svg = this.element.querySelector("svg")?.cloneNode(true) as SVGElement;
    svg.setAttribute("xmlns", "http://www.w3.org/2000/svg");
    const colours = getComputedStyle(document.documentElement);
    return svg.outerHTML.replace(/var\((--[a-z0-9]+)\)/g, (_, name: string) => colours.getPropertyValue(`${name}-light`) || colours.getPropertyValue(name));
  }
}
