// A figure in space: an orthographic view from a direction that can be turned.

const kView = { turn: -0.6, tilt: 0.5 }; // [rad]

/** @typedef {[number, number, number]} Vector */
/** @type {(a: Vector, b: Vector) => number} */
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
/** s a + t b. @type {(a: Vector, b: Vector, s: number, t: number) => Vector} */
const sum = (a, b, s, t) => [s * a[0] + t * b[0], s * a[1] + t * b[1], s * a[2] + t * b[2]];

class SpaceChart extends Chart {
  /** @param {Figure} figure @param {PageView} page @param {HTMLElement} holder */
  constructor(figure, page, holder) {
    super(figure, page, holder);
    this.view = { ...kView };
    this.left = 12;
    this.right = this.upwards = this.middle = /** @type {Vector} */ ([0, 0, 0]);
    this.reach = 1;
    /** Lines of a grid below the paths. @type {[Vector, Vector][]} */
    this.floor = [];
    this.note = make("div", { class: "note" });
    holder.append(this.note);
    this.measure();
  }
  keys() {
    return "Drag or press arrow keys to turn, plus and minus zoom, 0 goes back.";
  }
  showsAll() {
    return super.showsAll() && this.view.turn === kView.turn && this.view.tilt === kView.tilt;
  }

  // Extent of the paths and of nine tenths of the landmarks; and the floor: a grid below the paths in round units.
  measure() {
    /** @type {(keep: (series: Series) => boolean, cut: number) => Vector[]} */
    const extents = (keep, cut) => {
      const ranges = /** @type {const} */ (["x", "y", "z"]).map((name) => {
        const range = [Infinity, -Infinity];
        for (const series of this.figure.series.filter(keep)) {
          const sorted = (series[name] ?? new Float32Array()).filter(Number.isFinite).sort();
          const away = series.draw === "dots" ? Math.floor(sorted.length * cut) : 0;
          if (sorted.length === 0) continue;
          range[0] = Math.min(range[0], sorted[away]);
          range[1] = Math.max(range[1], sorted[sorted.length - 1 - away]);
        }
        return range[0] <= range[1] ? range : [0, 0];
      });
      return [0, 1].map((k) => /** @type {Vector} */ (ranges.map((range) => range[k])));
    };
    const [low, high] = extents(() => true, 0.05);
    this.middle = sum(low, high, 0.5, 0.5);
    this.reach = 1.02 * Math.max(1e-9, Math.hypot(...sum(high, low, 0.5, -0.5)));

    const [near, far] = extents((series) => series.draw === "line", 0);
    const step = roundStep((Math.max(...sum(far, near, 1, -1)) || 1) / 8);
    const up = "xyz".indexOf(this.figure.up.slice(-1));
    const [a, b] = [(up + 1) % 3, (up + 2) % 3];
    const [from, to] = [near.map((v) => Math.floor(v / step) * step), far.map((v) => Math.ceil(v / step) * step)];
    const below = (this.figure.up.startsWith("-") ? far : near)[up];
    this.floor = [];
    /** @type {(along: number, across: number) => void} */
    const rule = (along, across) => {
      for (let at = from[across]; at <= to[across] + step / 2; at += step) {
        const ends = [from, to].map((end) => end.map((v, k) => (k === along ? v : k === across ? at : below)));
        this.floor.push(/** @type {[Vector, Vector]} */ (ends));
      }
    };
    rule(a, b);
    rule(b, a);
    this.note.textContent = `Drag to turn; squares of the floor: ${short(step)} m.`;
  }

  /** @param {number} turn @param {number} tilt  [rad] */
  turnBy(turn, tilt) {
    this.view.turn += turn;
    this.view.tilt = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, this.view.tilt + tilt));
    this.draw();
  }
  showAll() {
    this.view = { ...kView };
    super.showAll();
  }

  // The rows of the rotation that the screen needs: to the right, and upwards.
  setScales() {
    const index = "xyz".indexOf(this.figure.up.slice(-1));
    const sign = this.figure.up.startsWith("-") ? -1 : 1;
    /** @type {(k: number, size?: number) => Vector} */
    const unit = (k, size = 1) => /** @type {Vector} */ ([0, 1, 2].map((i) => (i === k % 3 ? size : 0)));
    const [a, b] = sign > 0 ? [unit(index + 1), unit(index + 2)] : [unit(index + 2), unit(index + 1)];
    const { turn, tilt } = this.view;
    this.right = sum(a, b, Math.cos(turn), -Math.sin(turn));
    this.upwards = sum(sum(a, b, Math.sin(turn), Math.cos(turn)), unit(index, sign), Math.sin(tilt), Math.cos(tilt));
    this.scaleAxes();
  }
  /** @returns {Ranges} */
  whole() {
    return { x: [-this.reach, this.reach], y: [-this.reach, this.reach] };
  }
  /** @param {Vector} point @returns {Point} */
  project(point) {
    const from = sum(point, this.middle, 1, -1);
    return [this.x.pixel(dot(from, this.right)), this.y.pixel(dot(from, this.upwards))];
  }
  /** @param {Series} series @param {number} i */
  at(series, i) {
    return this.project([series.x[i], series.y[i], series.z?.[i] ?? NaN]);
  }
  axes() {
    const d = this.floor.map(([a, b]) => `M${textOf(this.project(a))}L${textOf(this.project(b))}`).join("");
    return [makeSvg("path", { class: "floor", d, stroke: "var(--context)", "stroke-width": 0.8, opacity: 0.4 })];
  }
}
