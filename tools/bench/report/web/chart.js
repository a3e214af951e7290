// A figure in the plane as SVG: axes, lines, bands, dots, bars and intervals. interact.js has pointer and keyboard.

const kFont = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Liberation Sans', sans-serif";
const kDigit = 7.2; // [px], width of a digit of the widest usual font at the size of the marks
const kTop = 24; // [px], above the axes: the y label
const kBottom = 38; // [px], below them: marks and the x label

/** @typedef {[x: number, y: number]} Point  in pixels inside the axes */

/** @type {(point: Point) => string} */
const textOf = ([x, y]) => `${x.toFixed(1)} ${y.toFixed(1)}`;

/** Stretches of finite coordinates. @template {number[]} Row @param {Row[]} rows @returns {Row[][]} */
function stretches(rows) {
  /** @type {Row[][]} */
  const found = [[]];
  for (const row of rows) {
    if (row.every(Number.isFinite)) found[found.length - 1].push(row);
    else found.push([]);
  }
  return found.filter((stretch) => stretch.length > 0);
}

class Chart {
  /** @param {Figure} figure @param {PageView} page @param {HTMLElement} holder */
  constructor(figure, page, holder) {
    this.figure = figure;
    this.page = page;
    this.isPath = figure.kind === "space" || Boolean(figure.equal_scale);
    this.isOfTime = figure.x.label.startsWith("time");
    /** Zoomed ranges; that of time is one for all charts in time. @type {Record<"x" | "y", {range?: Interval}>} */
    this.zoom = { x: this.isOfTime ? page.time : {}, y: {} };
    this.svg = makeSvg("svg", { "aria-hidden": "true", "font-family": kFont, height: this.isPath ? 380 : 240 });
    this.overlay = makeSvg("path", { fill: "var(--s0)", "fill-opacity": 0.25, stroke: "var(--dim)" });
    this.frame = make("div", { class: "frame", tabindex: "0", role: "application" }, this.svg);
    this.frame.setAttribute("aria-roledescription", "chart");
    this.frame.setAttribute("aria-label", `${figure.title}. ${figure.description} ${this.keys()}`);
    this.all = makeButton(() => this.showAll(), { title: "Show all (double click, or the key 0)" }, "Show all");
    this.all.setAttribute("aria-label", `Show all of ${figure.title}`);
    const saved = makeButton(() => this.save(), { title: "Save as a drawing (SVG)" }, "SVG");
    saved.setAttribute("aria-label", `Save ${figure.title} as SVG`);
    holder.querySelector("figcaption")?.append(make("span", { class: "tools" }, this.all, saved));
    this.legend = legend(figure, page.visible);
    holder.append(this.legend, this.frame);
    this.width = 0; // [px], of the drawing; and what is left of the axes
    this.left = 30;
    this.x = this.y = new Scale(figure.x, [0, 1], 0, 1);
    this.readout = new Readout(this);
    interact(this);
    new ResizeObserver(() => this.frame.clientWidth !== this.width && this.draw()).observe(this.frame);
  }
  keys() {
    return "Arrow keys read out values, plus and minus zoom, 0 shows all.";
  }

  shown() {
    return this.figure.series.filter((series) => this.page.visible.shows(this.figure.id, series.name));
  }
  /** @returns {Ranges} */
  whole() {
    return rangesOf(this.figure);
  }
  ranges() {
    const { x, y } = this.isPath ? equalised(this.whole(), this.inner.width, this.inner.height) : this.whole();
    return { x: this.zoom.x.range ?? x, y: this.zoom.y.range ?? y };
  }
  showsAll() {
    return !this.zoom.x.range && !this.zoom.y.range;
  }
  /** @param {Partial<Ranges>} ranges */
  zoomTo(ranges) {
    const now = this.ranges();
    this.zoom.x.range = ranges.x ?? (this.isPath ? now.x : this.zoom.x.range);
    this.zoom.y.range = ranges.y ?? (this.isPath ? now.y : this.zoom.y.range);
    this.zoomChanged(`${this.figure.title} is zoomed`);
  }
  showAll() {
    this.zoom.x.range = this.zoom.y.range = undefined;
    this.zoomChanged(`${this.figure.title} shows all`);
  }
  /** @param {string} text */
  zoomChanged(text) {
    for (const chart of this.page.charts.values()) {
      if (chart === this || (this.isOfTime && chart.isOfTime)) chart.draw();
    }
    say(text);
  }

  // Inside the axes [px].
  get inner() {
    const height = Number(this.svg.getAttribute("height")) - kTop - kBottom;
    return { width: Math.max(1, this.width - this.left - 12), height };
  }
  /** A point of a series; `end`: the other end of a band or an interval. @param {Series} series @param {number} i
   *  @returns {Point} */
  at(series, i, end = false) {
    const value = (series.high ?? series.y)[i];
    if (series.draw === "interval") return [this.x.pixel(end ? value : series.x[i]), this.y.pixel(series.y[i])];
    return [this.x.pixel(series.x[i]), this.y.pixel(end ? value : series.y[i])];
  }

  /** @param {Series} series @param {Series[]} shown @returns {SVGElement} */
  drawingOf(series, shown) {
    const { draw, role, faint } = series;
    const points = Array.from(series.x, (_, i) => this.at(series, i));
    const ends = series.high ? points.map((_, i) => this.at(series, i, true)) : [];
    /** @type {(d: string[], width: number, style?: Record<string, string>) => SVGElement} */
    const stroke = (d, width, style = {}) => makeSvg("path", { d: d.join(""), "stroke-width": width, ...style });
    /** @type {(width: number) => SVGElement} */
    const dots = (width) => {
      const d = points.filter((point) => point.every(Number.isFinite)).map((point) => `M${textOf(point)}h0`);
      return stroke(d, width, { "stroke-linecap": "round" });
    };
    /** @type {(opacity: number, ...children: SVGElement[]) => SVGElement} */
    const group = (opacity, ...children) =>
      makeSvg("g", { class: draw, fill: "none", stroke: colourOf(series), opacity }, ...children);
    const filled = { fill: colourOf(series), stroke: "none" };
    switch (draw) {
      case "line": {
        const d = stretches(points).map((stretch) => `M${stretch.map(textOf).join("L")}`);
        const line = stroke(d, role === "truth" ? 2.4 : faint ? 0.8 : 1.6, { "stroke-dasharray": dashOf(series) });
        const few = points.length <= 16 && !faint; // the points themselves are worth seeing
        return group(role === "truth" ? 0.6 : faint ? 0.4 : 1, line, ...(few ? [dots(5)] : []));
      }
      case "dots":
        return group(faint ? 0.55 : 1, dots(!faint ? 9 : points.length > 300 ? 2.2 : 4));
      case "band": {
        const d = stretches(points.map((point, i) => [...point, ...ends[i]])).map((stretch) => {
          const low = stretch.map(([x, y]) => textOf([x, y]));
          const high = stretch.map(([, , x, y]) => textOf([x, y])).reverse();
          return `M${[...low, ...high].join("L")}Z`;
        });
        return group(0.18, stroke(d, 0, filled));
      }
      case "bars": {
        const beside = shown.filter((other) => other.draw === "bars");
        const unit = this.x.pixel(1) - this.x.pixel(0);
        const width = (0.8 / beside.length) * unit;
        const [left, base] = [width * beside.indexOf(series) - 0.4 * unit, this.y.pixel(0)];
        const d = points.map(([x, y]) => `M${x + left} ${base}V${y}h${0.92 * width}V${base}Z`);
        return group(1, stroke(d, 0, filled));
      }
      case "interval":
        return group(0.5, stroke(points.map((point, i) => `M${textOf(point)}L${textOf(ends[i])}`), 4));
    }
  }

  // Marks of x: of a campaign's stress its doses, as far as there is room.
  xMarks() {
    if (!this.figure.x.stress) return this.x.marks(64);
    const doses = new Set(this.figure.series.filter((s) => s.draw === "line").flatMap((s) => [...s.x]));
    const marks = [];
    for (const dose of [...doses].sort((a, b) => this.x.pixel(a) - this.x.pixel(b))) {
      if (marks.length === 0 || this.x.pixel(dose) - this.x.pixel(marks[marks.length - 1]) >= 34) marks.push(dose);
    }
    return marks;
  }

  // What is left of the axes is as wide as the marks of y; where both axes have one scale, these depend on it in turn.
  setScales() {
    this.scaleAxes();
    this.left = 12 + kDigit * Math.max(2, ...this.y.marks(34).map((mark) => short(mark).length));
    this.scaleAxes();
  }
  scaleAxes() {
    const { x, y } = this.ranges();
    this.x = new Scale(this.figure.x, x, 0, this.inner.width);
    this.y = new Scale(this.figure.y, y, this.inner.height, 0);
  }

  // Axes around (0, 0) to (width, height).
  axes() {
    const { width, height } = this.inner;
    const [xs, ys] = [this.xMarks(), this.y.marks(34)];
    const [px, py] = [xs.map((mark) => this.x.pixel(mark)), ys.map((mark) => this.y.pixel(mark))];
    /** @type {(text: string, x: number, y: number, anchor: string, size?: number) => SVGElement} */
    const words = (text, x, y, anchor, size = 11) =>
      makeSvg("text", { x, y, "text-anchor": anchor, "font-size": size, fill: "var(--dim)" }, text);
    /** @type {(d: string[], colour: string, width: number) => SVGElement} */
    const lines = (d, stroke, width) => makeSvg("path", { d: d.join(""), stroke, "stroke-width": width, fill: "none" });
    const ticks = [...px.map((x) => `M${x} ${height}v5`), ...py.map((y) => `M0 ${y}h-5`)];
    return [
      lines([...px.map((x) => `M${x} 0V${height}`), ...py.map((y) => `M0 ${y}H${width}`)], "var(--rule)", 0.7),
      lines([`M0 0V${height}H${width}`, ...ticks], "var(--dim)", 1),
      ...xs.map((mark, i) => {
        const text = short(mark);
        return words(text, Math.min(px[i], width + 12 - (kDigit * text.length) / 2), height + 17, "middle");
      }),
      ...ys.map((mark, i) => words(short(mark), -8, py[i] + 4, "end")),
      words(this.figure.x.label, this.width / 2 - this.left, height + kBottom - 5, "middle", 12),
      words(this.figure.y.label, -this.left, -11, "start", 12),
    ];
  }

  draw() {
    this.width = this.frame.clientWidth || this.width;
    if (this.width === 0) return; // folded away
    this.setScales();
    const { width, height } = this.inner;
    const shown = this.shown();
    // The view box scales the drawing on paper; the inner svg cuts it at the axes.
    this.svg.setAttribute("viewBox", `${-this.left} ${-kTop} ${this.width} ${height + kTop + kBottom}`);
    const inside = makeSvg("svg", { width, height }, ...shown.map((series) => this.drawingOf(series, shown)));
    this.readout.hide();
    this.svg.replaceChildren(...this.axes(), inside, this.overlay);
    this.all.hidden = this.showsAll();
    for (const button of this.legend.querySelectorAll("button")) {
      button.setAttribute("aria-pressed", String(this.page.visible.shows(this.figure.id, button.dataset.name ?? "")));
    }
  }

  // The drawing as a file, in the light colours.
  svgText() {
    const copy = /** @type {SVGElement} */ (this.svg.cloneNode(true));
    copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
    copy.setAttribute("width", String(this.width));
    const colours = getComputedStyle(document.documentElement);
    /** @type {(whole: string, name: string) => string} */
    const light = (_, name) => colours.getPropertyValue(`${name}-light`) || colours.getPropertyValue(name);
    return copy.outerHTML.replace(/var\((--\w+)\)/g, light);
  }
  save() {
    const address = URL.createObjectURL(new Blob([this.svgText()], { type: "image/svg+xml" }));
    const download = `${this.figure.title.toLowerCase().replace(/[^a-z0-9]+/g, "_")}.svg`;
    make("a", { href: address, download }).click();
    URL.revokeObjectURL(address);
  }
}
