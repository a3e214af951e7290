// Axis scales: from values to pixels and back, ranges, marks. The place of a value is its decimal logarithm on a
// logarithmic axis, and the value itself on any other; ranges are of places.

/** @typedef {[low: number, high: number]} Interval */
/** @typedef {{x: Interval, y: Interval}} Ranges */

/** @type {(axis: Axis, value: number) => number} */
const placeOf = (axis, value) => (!axis.logarithmic ? value : value > 0 ? Math.log10(value) : NaN);

class Scale {
  /** @param {Axis} axis @param {Interval} range @param {number} from @param {number} to  [px], where the range ends */
  constructor(axis, range, from, to) {
    this.axis = axis;
    this.low = range[0];
    this.high = range[1];
    this.from = axis.reversed ? to : from;
    this.to = axis.reversed ? from : to;
  }

  /** Infinite values lie on the edge. @param {number} value */
  pixel(value) {
    const place = Math.abs(value) === Infinity ? (value > 0 ? this.high : this.low) : placeOf(this.axis, value);
    return this.from + ((place - this.low) / (this.high - this.low)) * (this.to - this.from);
  }
  /** @param {number} pixel */
  placeAt(pixel) {
    return this.low + ((pixel - this.from) / (this.to - this.from)) * (this.high - this.low);
  }

  /** Round values, about `apart` [px] from each other. @param {number} apart @returns {number[]} */
  marks(apart) {
    const { low, high } = this;
    const wanted = Math.abs(this.to - this.from) / apart;
    if (!(high > low)) return [];
    if (this.axis.logarithmic && high - low > 1) {
      const every = Math.max(1, Math.ceil((high - low) / wanted)); // 1 is among the marks, wherever it is in the range
      const factors = high - low < 2 ? [1, 2, 5] : [1];
      const first = Math.floor(low / every);
      const powers = Array.from({ length: Math.ceil(high / every) - first + 1 }, (_, k) => 10 ** ((first + k) * every));
      const marks = powers.flatMap((power) => factors.map((factor) => factor * power));
      return marks.filter((mark) => Math.log10(mark) >= low && Math.log10(mark) <= high);
    }
    const [first, last] = this.axis.logarithmic ? [10 ** low, 10 ** high] : [low, high];
    const step = roundStep((last - first) / wanted);
    const count = Math.max(0, Math.floor(last / step) - Math.ceil(first / step) + 1);
    return Array.from({ length: count }, (_, k) => (Math.ceil(first / step) + k) * step);
  }
}

/** The smallest of 1, 2, 5 times a power of ten that is not below. @type {(least: number) => number} */
function roundStep(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return power * ([1, 2, 5].find((factor) => factor * power >= least) ?? 10);
}

/** @type {(columns: Iterable<number>[], axis: Axis) => Interval} */
function extent(columns, axis) {
  let [low, high] = [Infinity, -Infinity];
  for (const column of columns) {
    for (const value of column) {
      const place = placeOf(axis, value);
      if (!Number.isFinite(place)) continue;
      low = Math.min(low, place);
      high = Math.max(high, place);
    }
  }
  return low <= high ? [low, high] : [0, 1];
}

/** @type {(range: Interval, axis: Axis, margin: number) => Interval} */
function widened([low, high], axis, margin) {
  const size = high - low || (axis.logarithmic ? 1 : Math.abs(high) || 1);
  // An axis from zero begins a little below it, so that a line along zero is visible.
  return [low - (axis.from_zero && low >= 0 ? 0.02 : margin) * size, high + margin * size];
}

/** Ranges of all series, hidden ones too: a toggled series moves nothing. @type {(figure: Figure) => Ranges} */
function rangesOf(figure) {
  const bars = figure.series.some((series) => series.draw === "bars");
  /** @type {(horizontal: boolean) => Float32Array[]} */
  const columns = (horizontal) =>
    figure.series.flatMap((series) => [
      horizontal ? series.x : series.y,
      ...(series.high && (series.draw === "interval") === horizontal ? [series.high] : []),
    ]);
  const x = extent(columns(true), figure.x);
  const y = extent([...columns(false), figure.y.from_zero ? [0] : []], figure.y);
  const margin = figure.x.stress ? 0.04 : figure.equal_scale ? 0.06 : 0.01;
  const [low, high] = widened(y, figure.y, 0.05);
  /** @type {(value: number | undefined, otherwise: number) => number} */
  const given = (value, otherwise) => (value === undefined ? otherwise : placeOf(figure.y, value));
  return {
    x: bars ? [x[0] - 0.5, x[1] + 0.5] : widened(x, figure.x, margin),
    y: [given(figure.y.low, bars ? 0 : low), given(figure.y.high, high)],
  };
}

/** The same unit length in both directions. @type {(ranges: Ranges, width: number, height: number) => Ranges} */
function equalised({ x, y }, width, height) {
  const unit = Math.max((x[1] - x[0]) / width, (y[1] - y[0]) / height);
  /** @type {(range: Interval, pixels: number) => Interval} */
  const about = ([low, high], pixels) => [(low + high - unit * pixels) / 2, (low + high + unit * pixels) / 2];
  return { x: about(x, width), y: about(y, height) };
}

/** The text of a mark. @type {(value: number) => string} */
function short(value) {
  const size = Math.abs(value);
  const number = Number(value.toPrecision(4));
  const text = size !== 0 && (size >= 1e5 || size < 1e-4) ? number.toExponential().replace("+", "") : String(number);
  return text.replace(/-/g, "−");
}
