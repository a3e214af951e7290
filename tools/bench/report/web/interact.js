// Pointer and keyboard on a chart: hover reads, dragging a box zooms (in space it turns), a double click shows all.

const kTurn = 0.01; // [rad/px]
const kLeastBox = 6; // [px]: less was a click

/** @type {(chart: Chart) => void} */
function interact(chart) {
  const { frame, readout } = chart;
  /** @type {(event: PointerEvent) => Point} */
  const inside = (event) => {
    const { left, top } = chart.svg.getBoundingClientRect();
    const { width, height } = chart.inner;
    /** @type {(value: number, high: number) => number} */
    const within = (value, high) => Math.max(0, Math.min(high, value));
    return [within(event.clientX - left - chart.left, width), within(event.clientY - top - kTop, height)];
  };

  /** @type {Point | undefined} */
  let from;
  frame.addEventListener("pointerdown", (event) => {
    const scrolls = event.pointerType === "touch" && !(chart instanceof SpaceChart);
    if (event.button !== 0 || scrolls) return;
    from = inside(event);
    readout.hide();
    frame.setPointerCapture(event.pointerId);
  });
  frame.addEventListener("pointermove", (event) => {
    const at = inside(event);
    if (!from) {
      readout.show(at);
    } else if (chart instanceof SpaceChart) {
      chart.turnBy((at[0] - from[0]) * kTurn, (at[1] - from[1]) * kTurn);
      from = at;
    } else {
      chart.overlay.setAttribute("d", `M${from}H${at[0]}V${at[1]}H${from[0]}Z`);
    }
  });
  /** @type {(event: PointerEvent) => void} */
  const end = (event) => {
    const [start, at] = [from, inside(event)];
    from = undefined;
    if (event.type !== "pointerup" || chart instanceof SpaceChart) return;
    if (event.pointerType === "touch") readout.show(at); // a tap
    if (!start) return;
    chart.overlay.removeAttribute("d");
    /** @type {(scale: Scale, k: 0 | 1) => Interval | undefined} */
    const between = (scale, k) => {
      const [a, b] = [scale.placeAt(start[k]), scale.placeAt(at[k])];
      return Math.abs(at[k] - start[k]) > kLeastBox ? [Math.min(a, b), Math.max(a, b)] : undefined;
    };
    const [x, y] = [between(chart.x, 0), between(chart.y, 1)];
    if (x || y) chart.zoomTo({ x, y });
  };
  frame.addEventListener("pointerup", end);
  frame.addEventListener("pointercancel", end);
  frame.addEventListener("pointerleave", (event) => event.pointerType !== "touch" && readout.hide());
  frame.addEventListener("blur", () => readout.hide());
  frame.addEventListener("dblclick", () => chart.showAll());

  /** About the middle; above 1 less is shown. @type {(factor: number) => void} */
  const zoomBy = (factor) => {
    /** @type {(range: Interval) => Interval} */
    const about = ([low, high]) => {
      const [middle, half] = [(low + high) / 2, (high - low) / 2 / factor];
      return [middle - half, middle + half];
    };
    const { x, y } = chart.ranges();
    chart.zoomTo({ x: about(x), y: about(y) });
  };
  /** @type {(right: number, up: number) => void} */
  const arrow = (right, up) => {
    if (chart instanceof SpaceChart) chart.turnBy(0.1 * right, 0.1 * up);
    else readout.step(right);
  };
  /** @type {Record<string, (many: number) => void>} */
  const keys = {
    ArrowLeft: (many) => arrow(-many, 0),
    ArrowRight: (many) => arrow(many, 0),
    "+": () => zoomBy(1.5),
    "=": () => zoomBy(1.5),
    "-": () => zoomBy(1 / 1.5),
    0: () => chart.showAll(),
    Escape: () => chart.showAll(),
    ...(chart instanceof SpaceChart && { ArrowUp: (many) => arrow(0, many), ArrowDown: (many) => arrow(0, -many) }),
  };
  frame.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || !keys[event.key]) return;
    keys[event.key](event.shiftKey ? 10 : 1);
    event.preventDefault();
  });
}
