// Pointer and keyboard on a chart: hover reads, dragging a box zooms (in space it turns), a double click shows all.
import { kMargin, type Chart } from "./chart";
import { make } from "./dom";
import { Readout } from "./readout";
import type { Range } from "./scale";
import { SpaceChart } from "./space";

const kTurn = 0.01; // [rad/px]
const kLeastBox = 6; // [px]: less was a click

// Zooming along time is for all charts of time.
export class TimeZoom {
  private readonly charts: Chart[] = [];
  add(chart: Chart): void {
    if (isOfTime(chart)) this.charts.push(chart);
  }
  apply(chart: Chart, ranges?: { x: Range; y: Range }): void {
    chart.zoomTo(ranges);
    if (!isOfTime(chart)) return;
    for (const other of this.charts) {
      if (other !== chart) other.zoomTo(ranges && { x: ranges.x });
    }
  }
}

const isOfTime = (chart: Chart): boolean => chart.figure.x.label.startsWith("time");

export function interact(chart: Chart, zoom: TimeZoom): void {
  const readout = new Readout(chart);
  const box = make("div", { class: "box", hidden: "" });
  chart.frame.append(box);
  const { frame } = chart;
  const inside = (event: PointerEvent): [number, number] => {
    const rectangle = chart.element.getBoundingClientRect();
    const within = (value: number, low: number, size: number) => Math.max(low, Math.min(low + size, value));
    const { width, height } = chart.inner();
    return [within(event.clientX - rectangle.left, kMargin.left, width), within(event.clientY - rectangle.top, kMargin.top, height)];
  };

  let from: [number, number] | undefined;
  let before: [number, number] = [0, 0];
  frame.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || (event.pointerType === "touch" && !(chart instanceof SpaceChart))) return; // touch scrolls
    from = before = inside(event);
    frame.setPointerCapture(event.pointerId);
  });
  frame.addEventListener("pointermove", (event) => {
    const at = inside(event);
    if (!from) {
      readout.at(...at);
    } else if (chart instanceof SpaceChart) {
      chart.turnBy((at[0] - before[0]) * kTurn, (before[1] - at[1]) * -kTurn);
      before = at;
    } else {
      readout.hide();
      box.hidden = false;
      box.style.left = `${Math.min(from[0], at[0])}px`;
      box.style.top = `${Math.min(from[1], at[1])}px`;
      box.style.width = `${Math.abs(at[0] - from[0])}px`;
      box.style.height = `${Math.abs(at[1] - from[1])}px`;
    }
  });
  const end = (event: PointerEvent) => {
    box.hidden = true;
    if (!from) return;
    const [start, at] = [from, inside(event)];
    from = undefined;
    if (event.type !== "pointerup" || chart instanceof SpaceChart) return;
    const wide = Math.abs(at[0] - start[0]) > kLeastBox;
    const high = Math.abs(at[1] - start[1]) > kLeastBox;
    if (!wide && !high) return;
    const a = chart.toAxes(...start);
    const b = chart.toAxes(...at);
    const between = (k: 0 | 1): Range => ({ low: Math.min(a[k], b[k]), high: Math.max(a[k], b[k]) });
    const { x, y } = chart.ranges();
    zoom.apply(chart, { x: wide ? between(0) : x, y: high ? between(1) : y });
  };
  frame.addEventListener("pointerup", end);
  frame.addEventListener("pointercancel", end);
  frame.addEventListener("pointerleave", () => readout.hide());
  frame.addEventListener("blur", () => readout.hide());
  frame.addEventListener("dblclick", () => zoom.apply(chart));
  frame.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (!press(event.key, event.shiftKey ? 10 : 1)) return;
    event.preventDefault();
  });

  function press(key: string, many: number): boolean {
    const turns: Record<string, [number, number]> = {
      ArrowLeft: [-0.1, 0],
      ArrowRight: [0.1, 0],
      ArrowUp: [0, 0.1],
      ArrowDown: [0, -0.1],
    };
    const turn = turns[key];
    if (turn && chart instanceof SpaceChart) {
      chart.turnBy(turn[0] * many, turn[1] * many);
    } else if (key === "ArrowLeft" || key === "ArrowRight") {
      readout.step(key === "ArrowLeft" ? -many : many);
    } else if (key === "+" || key === "=") {
      chart.zoomBy(1.5);
    } else if (key === "-") {
      chart.zoomBy(1 / 1.5);
    } else if (key === "0" || key === "Escape") {
      zoom.apply(chart);
    } else {
      return false;
    }
    return true;
  }
}
