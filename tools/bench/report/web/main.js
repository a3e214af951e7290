// The page: figures are drawn when they come near the screen, all of them before the page is printed.

class PageView {
  /** @param {PageData} data */
  constructor(data) {
    this.figures = figuresOf(data);
    /** @type {Map<string, Chart>} */
    this.charts = new Map();
    this.visible = new Visible(data.systems, () => this.charts.forEach((chart) => chart.draw()));
    /** The zoomed range of time, of all charts in time. @type {{range?: Interval}} */
    this.time = {};
    const frames = document.getElementById("frames");
    if (frames && data.frames) showFrames(frames, data.frames, data.systems);
    for (const table of document.querySelectorAll(".table")) enhance(table);

    const near = new IntersectionObserver(
      (entries) => entries.filter((entry) => entry.isIntersecting).forEach((entry) => this.drawFigure(entry.target)),
      { rootMargin: "600px" },
    );
    this.holders = [...document.querySelectorAll("figure.figure")];
    for (const holder of this.holders) near.observe(holder);
    window.addEventListener("beforeprint", () => this.drawAll());
  }

  /** @param {Element} holder */
  drawFigure(holder) {
    const figure = this.figures.find((f) => f.id === holder.id);
    if (!figure || this.charts.has(figure.id)) return;
    const Kind = figure.kind === "space" ? SpaceChart : Chart;
    const chart = new Kind(figure, this, /** @type {HTMLElement} */ (holder));
    this.charts.set(figure.id, chart);
    chart.draw();
  }
  drawAll() {
    for (const details of document.querySelectorAll("details.figures")) details.setAttribute("open", "");
    for (const holder of this.holders) this.drawFigure(holder);
  }
}

document.documentElement.classList.add("scripted");
// `vobench` is for tests, and for whoever wants the numbers in the browser's console.
Object.assign(window, { vobench: new PageView(JSON.parse(document.getElementById("data")?.textContent ?? "{}")) });
