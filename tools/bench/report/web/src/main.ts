// The page: figures are drawn when they come near the screen, all of them before the page is printed.
import { Chart } from "./chart";
import { figuresOf, type Figure, type Frames, type PageData } from "./data";
import { make, save } from "./dom";
import { showFrames } from "./frames";
import { interact, TimeZoom } from "./interact";
import { SpaceChart } from "./space";
import { enhance } from "./table";
import { follow } from "./live";
import { legend, Visible } from "./visible";

const kHeight = 240;
const kPathHeight = 380;

function draw(figure: Figure, holder: HTMLElement, visible: Visible, zoom: TimeZoom): Chart {
  const tall = figure.kind === "space" || figure.equal_scale;
  holder.append(legend(figure, visible));
  const Kind = figure.kind === "space" ? SpaceChart : Chart;
  const chart = new Kind(figure, visible, holder, tall ? kPathHeight : kHeight);
  zoom.add(chart);
  interact(chart, zoom);
  const all = make("button", { type: "button", title: "Show all (double click, or the key 0)" }, "Show all");
  all.addEventListener("click", () => zoom.apply(chart));
  const saving = make("button", { type: "button", title: "Save as a drawing (SVG)" }, "SVG");
  saving.setAttribute("aria-label", `Save ${figure.title} as SVG`);
  all.setAttribute("aria-label", `Show all of ${figure.title}`);
  const name = figure.title.toLowerCase().replace(/[^a-z0-9]+/g, "_");
  saving.addEventListener("click", () => save(`${name}.svg`, "image/svg+xml", chart.svgText()));
  chart.onDraw(() => (all.hidden = !(chart.isZoomed() || chart instanceof SpaceChart)));
  all.hidden = !(chart instanceof SpaceChart);
  holder.querySelector("figcaption")?.append(make("span", { class: "tools" }, all, saving));
  if (chart instanceof SpaceChart) holder.append(make("div", { class: "note" }, `Drag to turn; ${chart.floor}.`));
  return chart;
}

class PageView {
  readonly charts = new Map<string, Chart>();
  figures: Figure[];
  private readonly visible: Visible;
  private readonly zoom = new TimeZoom();
  private showNext?: (frames: Frames) => void;

  constructor(private readonly data: PageData) {
    this.figures = figuresOf(data);
    this.visible = new Visible(data.systems);
  }

  drawFigure(figure: Figure): void {
    const holder = document.getElementById(figure.id);
    if (!holder || this.charts.has(figure.id)) return;
    this.charts.set(figure.id, draw(figure, holder, this.visible, this.zoom));
  }
  drawAll(): void {
    for (const figure of this.figures) this.drawFigure(figure);
  }

  // What has come since. Figures that were not there, or have other series, need another page.
  update(data: PageData): void {
    const figures = figuresOf(data);
    if (shape(figures) !== shape(this.figures)) {
      location.reload();
      return;
    }
    this.figures = figures;
    const summary = document.getElementById("summary");
    if (summary && data.summary !== undefined) summary.innerHTML = data.summary;
    if (data.frames) this.showNext?.(data.frames);
    for (const figure of figures) this.charts.get(figure.id)?.update(figure);
  }

  start(): void {
    document.documentElement.classList.add("scripted");
    const seen = new IntersectionObserver(
      (entries) => {
        for (const entry of entries.filter((e) => e.isIntersecting)) {
          seen.unobserve(entry.target);
          const figure = this.figures.find((f) => f.id === entry.target.id);
          if (figure) this.drawFigure(figure);
        }
      },
      { rootMargin: "600px" },
    );
    for (const figure of this.figures) {
      const holder = document.getElementById(figure.id);
      if (holder) seen.observe(holder);
    }
    for (const table of document.querySelectorAll<HTMLElement>(".table")) enhance(table);
    const frames = document.getElementById("frames");
    if (frames && this.data.frames) this.showNext = showFrames(frames, this.data.frames, this.data.systems);
    window.addEventListener("beforeprint", () => {
      for (const details of document.querySelectorAll<HTMLDetailsElement>("details.figures")) details.open = true;
      this.drawAll();
    });
  }
}

const shape = (figures: Figure[]): string =>
  JSON.stringify(figures.map((figure) => [figure.id, figure.title, [...new Set(figure.series.map((series) => series.name))]]));

const data = JSON.parse(document.getElementById("data")?.textContent ?? "{}") as PageData;
const view = new PageView(data);
view.start();
if (data.summary !== undefined) follow((next) => view.update(next));
// For whoever tests the page, or wants its numbers in the browser's console.
(window as unknown as { vobench: PageView }).vobench = view;
