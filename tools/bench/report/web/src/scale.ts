// Ranges and marks of axes. A logarithmic axis is drawn in powers of ten: `place` is what the drawing sees.
import type { Axis, Figure, Series } from "./data";

export interface Range {
  low: number;
  high: number;
}

export function place(axis: Axis, value: number): number {
  if (!axis.logarithmic) return value;
  return value > 0 ? Math.log10(value) : NaN;
}

export function valueAt(axis: Axis, placed: number): number {
  return axis.logarithmic ? 10 ** placed : placed;
}

function extent(columns: Float32Array[], axis: Axis): Range | undefined {
  let low = Infinity;
  let high = -Infinity;
  for (const column of columns) {
    for (const value of column) {
      const at = place(axis, value);
      if (!Number.isFinite(at)) continue;
      low = Math.min(low, at);
      high = Math.max(high, at);
    }
  }
  return low <= high ? { low, high } : undefined;
}

function widened(range: Range, axis: Axis, margin: number): Range {
  const size = range.high - range.low || (axis.logarithmic ? 1 : Math.abs(range.high) || 1);
  const low = range.low - margin * size;
  const high = range.high + margin * size;
  // An axis that begins at zero begins a little below, so that what lies on it is seen.
  return axis.from_zero && range.low >= 0 ? { low: -0.02 * size, high } : { low, high };
}

const kNothing: Range = { low: 0, high: 1 };

// What all series take, hidden ones too: toggling moves nothing.
export function rangesOf(figure: Figure): { x: Range; y: Range } {
  const bars = figure.series.some((series) => series.draw === "bars");
  const ends = (series: Series, horizontal: boolean) =>
    series.high && (series.draw === "interval") === horizontal ? [series.high] : [];
  const x = extent(figure.series.flatMap((series) => [series.x, ...ends(series, true)]), figure.x) ?? kNothing;
  const y = extent(figure.series.flatMap((series) => [series.y, ...ends(series, false)]), figure.y) ?? kNothing;
  if (figure.y.from_zero) {
    y.low = Math.min(y.low, 0);
    y.high = Math.max(y.high, 0);
  }
  const margin = figure.x.stress ? 0.04 : figure.equal_scale ? 0.06 : 0.01;
  const ranges = {
    x: bars ? { low: x.low - 0.5, high: x.high + 0.5 } : widened(x, figure.x, margin),
    y: widened(y, figure.y, 0.05),
  };
  if (bars) ranges.y.low = 0;
  if (figure.y.low !== undefined) ranges.y.low = place(figure.y, figure.y.low);
  if (figure.y.high !== undefined) ranges.y.high = place(figure.y, figure.y.high);
  return ranges;
}

// The same measure in both directions, for a frame of this shape.
export function equalised(ranges: { x: Range; y: Range }, width: number, height: number): { x: Range; y: Range } {
  const unit = Math.max((ranges.x.high - ranges.x.low) / width, (ranges.y.high - ranges.y.low) / height);
  const about = (range: Range, pixels: number): Range => {
    const middle = (range.low + range.high) / 2;
    return { low: middle - (unit * pixels) / 2, high: middle + (unit * pixels) / 2 };
  };
  return { x: about(ranges.x, width), y: about(ranges.y, height) };
}

// Round values inside the range, about so many; of a logarithmic axis powers of ten, with 2 and 5 where there are few.
export function marks(axis: Axis, range: Range, wanted: number): number[] {
  const size = range.high - range.low;
  if (!(size > 0)) return [];
  if (axis.logarithmic && size > 0.5) {
    const every = Math.max(1, Math.ceil(size / wanted));
    const between = size < 2 ? [1, 2, 5] : [1];
    const found: number[] = [];
    for (let power = Math.floor(range.low); power <= range.high; power += every) {
      for (const factor of between) found.push(power + Math.log10(factor));
    }
    return found.filter((mark) => mark >= range.low && mark <= range.high);
  }
  // Over less than half a decade the values themselves are evenly spread, nearly.
  const low = valueAt(axis, range.low);
  const high = valueAt(axis, range.high);
  const rough = (high - low) / wanted;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * ([1, 2, 5, 10].find((factor) => factor * power >= rough) ?? 10);
  const found: number[] = [];
  for (let k = Math.ceil(low / step); k * step <= high; ++k) found.push(place(axis, k * step));
  return found;
}

// As short as it may be, at marks.
export function short(value: number): string {
  const size = Math.abs(value);
  const text = size !== 0 && (size >= 1e5 || size < 1e-4) ? value.toExponential() : String(Number(value.toPrecision(4)));
  return text.replace("-", "−");
}
