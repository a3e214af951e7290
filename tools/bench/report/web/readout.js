// Exact values at the pointer, or at the point that the arrow keys have reached.

/** @typedef {{series: Series, index: number, distance: number}} Hit  distance in pixels */

const kReach = 30; // [px] from a path

class Readout {
  /** @param {Chart} chart */
  constructor(chart) {
    this.chart = chart;
    this.box = make("div", { class: "readout", hidden: "" });
    this.index = -1; // of the arrow keys, in the longest series
    chart.frame.append(this.box);
  }
  hide() {
    this.box.hidden = true;
    this.chart.overlay.removeAttribute("d");
  }

  /** Of a path the nearest point, else of each series the nearest along x. @param {Point} at @returns {Hit[]} */
  hits([px, py]) {
    const { chart } = this;
    /** @type {(series: Series) => Hit} */
    const nearest = (series) => {
      const hit = { series, index: 0, distance: Infinity };
      for (let index = 0; index < series.x.length; ++index) {
        const [x, y] = chart.at(series, index);
        const distance = chart.isPath ? Math.hypot(x - px, y - py) : Math.abs(x - px);
        if (distance < hit.distance) Object.assign(hit, { index, distance });
      }
      return hit;
    };
    const read = chart.shown().filter((series) => chart.isPath || !series.faint);
    const hits = read.map(nearest);
    const closest = Math.min(...hits.map((hit) => hit.distance));
    if (chart.isPath) return hits.filter((hit) => hit.distance === closest && closest < kReach).slice(0, 1);
    return hits.filter((hit) => hit.distance < closest + 4);
  }

  /** @param {Hit} hit */
  describe({ series, index }) {
    const [x, y, high] = [series.x, series.y, series.high].map((column) => exact(column?.[index]));
    if (this.chart.isPath) {
      const z = series.z ? `, ${exact(series.z[index])}` : "";
      return `(${x}, ${y}${z}) m${series.t ? ` at ${exact(series.t[index])} s` : ""}`;
    }
    if (series.notes?.[index]) return series.notes[index];
    return series.draw === "interval" ? `${x} to ${high}` : series.high ? `${y} to ${high}` : y;
  }

  /** Shows what is near; its text. @param {Point} at */
  show(at) {
    const hits = this.hits(at);
    if (hits.length === 0) {
      this.hide();
      return "";
    }
    const { chart, box } = this;
    const [x, y] = chart.at(hits[0].series, hits[0].index);
    const [, quantity, unit] = chart.figure.x.label.match(/^([^[]*?)(?: \[(.*)\])?$/) ?? [];
    const head = chart.isPath ? "" : `${quantity} ${exact(hits[0].series.x[hits[0].index])}${unit ? ` ${unit}` : ""}`;
    box.replaceChildren(make("div", { class: "head" }, head));
    for (const hit of hits) {
      const swatch = make("span", { class: "dot" });
      swatch.style.background = colourOf(hit.series);
      box.append(make("div", {}, swatch, `${hit.series.name} `, make("b", {}, this.describe(hit))));
    }
    box.hidden = false;
    const mark = chart.isPath ? `M${x - 4} ${y}a4 4 0 1 0 8 0a4 4 0 1 0 -8 0` : `M${x} 0V${chart.inner.height}`;
    chart.overlay.setAttribute("d", mark);
    // To the right of the point where there is room, and inside the frame.
    const { clientWidth, clientHeight } = chart.frame;
    const right = x + chart.left + 14;
    const left = right + box.offsetWidth > clientWidth ? right - 28 - box.offsetWidth : right;
    box.style.left = `${Math.max(0, Math.min(left, clientWidth - box.offsetWidth))}px`;
    const top = kTop + (chart.isPath ? y : at[1]) - box.offsetHeight;
    box.style.top = `${Math.max(0, Math.min(top, clientHeight - box.offsetHeight))}px`;
    return [head, ...hits.map((hit) => `${hit.series.name} ${this.describe(hit)}`)].filter(Boolean).join(", ");
  }

  /** By the keyboard: `by` points on in the longest series. @param {number} by */
  step(by) {
    const shown = this.chart.shown().filter((series) => !series.faint && series.draw !== "interval");
    const [longest] = shown.sort((a, b) => b.x.length - a.x.length);
    if (!longest) return;
    this.index = Math.max(0, Math.min(longest.x.length - 1, this.index + by));
    const [x, y] = this.chart.at(longest, this.index);
    say(this.show([x, Number.isFinite(y) ? y : 0]));
  }
}
