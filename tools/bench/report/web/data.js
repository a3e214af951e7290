// Data of a page, as in docs/report_data.md; written by tools/bench/report/figure.cpp and frame_viewer.cpp.

/** @typedef {{label: string, logarithmic?: boolean, reversed?: boolean, from_zero?: boolean, stress?: boolean,
 *             low?: number, high?: number}} Axis */
/** @typedef {{name: string, draw: "line" | "band" | "dots" | "bars" | "interval",
 *             role: "system" | "truth" | "expected" | "context" | "warning", system: number, faint?: boolean,
 *             x: Float32Array, y: Float32Array, high?: Float32Array, z?: Float32Array, t?: Float32Array,
 *             notes?: string[]}} Series */
/** @typedef {{id: string, title: string, description: string, kind: "plane" | "space", up: string, x: Axis, y: Axis,
 *             equal_scale?: boolean, series: Series[]}} Figure */
/** Status (matched, missed, rejected, new); predicted u v; found u v; innovation covariance uu uv vv. All [px].
 *  @typedef {[number, number, number, number, number, number, number, number]} Feature */
/** @typedef {{t: number, picture: string, depth?: string, flow?: string, features: Feature[][]}} Frame */
/** @typedef {{width: number, height: number, depth_m?: [number, number], flow_px?: number, frames: Frame[]}} Frames */
/** Series of `figures` have numbers of `columns` in the place of their arrays.
 *  @typedef {{format: string, systems: string[], figures: any[], columns: string[], frames?: Frames}} PageData */

const kFormat = "vobench figures 1";

/** @type {(data: PageData) => Figure[]} */
function figuresOf(data) {
  if (data.format !== kFormat) throw new Error(`the format of the figures is '${data.format}', not '${kFormat}'`);
  // Base64 of little-endian floats, which is the order of bytes of every machine that runs a browser.
  const columns = data.columns.map((c) => new Float32Array(Uint8Array.from(atob(c), (b) => b.charCodeAt(0)).buffer));
  /** @type {(index?: number) => Float32Array | undefined} */
  const column = (index) => (index === undefined ? undefined : columns[index]);
  return data.figures.map((figure) => ({
    ...{ up: "z", x: { label: "" }, y: { label: "" }, ...figure },
    series: figure.series.map((/** @type {any} */ series) => ({
      ...{ system: 0, ...series },
      ...Object.fromEntries(["x", "y", "high", "z", "t"].map((key) => [key, column(series[key])])),
    })),
  }));
}
