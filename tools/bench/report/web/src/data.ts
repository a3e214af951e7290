// The data of a page: docs/report_data.md. The C++ side is tools/bench/report/figure_json.cpp and frame_viewer.cpp.

export type Draw = "line" | "band" | "dots" | "bars" | "interval";
export type Role = "system" | "truth" | "expected" | "context" | "warning";

export interface Axis {
  label: string;
  logarithmic?: boolean;
  reversed?: boolean;
  from_zero?: boolean;
  stress?: boolean;
  low?: number;
  high?: number;
}

interface Coded {
  name: string;
  draw: Draw;
  role: Role;
  system?: number;
  faint?: boolean;
  x: number;
  y: number;
  high?: number;
  z?: number;
  t?: number;
  notes?: string[];
}

interface CodedFigure {
  id: string;
  title: string;
  description: string;
  kind: "plane" | "space";
  up?: string;
  x?: Axis;
  y?: Axis;
  equal_scale?: boolean;
  series: Coded[];
}

// Matched, missed, rejected, new; predicted u v; found u v; innovation covariance uu uv vv. All [px].
export type Feature = [number, number, number, number, number, number, number, number];

export interface Frame {
  t: number;
  picture: string;
  depth?: string;
  flow?: string;
  features: Feature[][];
}

export interface Frames {
  width: number;
  height: number;
  depth_m?: [number, number];
  flow_px?: number;
  frames: Frame[];
}

export interface PageData {
  format: string;
  systems: string[];
  figures: CodedFigure[];
  columns: string[];
  frames?: Frames;
  summary?: string; // of a live page, as HTML
}

export interface Series {
  name: string;
  draw: Draw;
  role: Role;
  system: number;
  faint: boolean;
  x: Float32Array;
  y: Float32Array;
  high?: Float32Array;
  z?: Float32Array;
  t?: Float32Array;
  notes?: string[];
}

export interface Figure {
  id: string;
  title: string;
  description: string;
  kind: "plane" | "space";
  up: string;
  x: Axis;
  y: Axis;
  equal_scale: boolean;
  series: Series[];
}

const kFormat = "vobench figures 1";

function decode(column: string): Float32Array {
  const text = atob(column);
  const bytes = new DataView(new ArrayBuffer(text.length));
  for (let i = 0; i < text.length; ++i) bytes.setUint8(i, text.charCodeAt(i));
  return Float32Array.from({ length: text.length / 4 }, (_, i) => bytes.getFloat32(4 * i, true));
}

export function figuresOf(data: PageData): Figure[] {
  if (data.format !== kFormat) throw new Error(`these figures are '${data.format}', not '${kFormat}'`);
  const columns = data.columns.map(decode);
  const column = (index: number): Float32Array => {
    const found = columns[index];
    if (!found) throw new Error(`there is no column ${index}`);
    return found;
  };
  const optional = (index: number | undefined) => (index === undefined ? undefined : column(index));
  return data.figures.map((figure) => ({
    id: figure.id,
    title: figure.title,
    description: figure.description,
    kind: figure.kind,
    up: figure.up ?? "z",
    x: figure.x ?? { label: "" },
    y: figure.y ?? { label: "" },
    equal_scale: figure.equal_scale ?? false,
    series: figure.series.map((series) => ({
      name: series.name,
      draw: series.draw,
      role: series.role,
      system: series.system ?? 0,
      faint: series.faint ?? false,
      x: column(series.x),
      y: column(series.y),
      high: optional(series.high),
      z: optional(series.z),
      t: optional(series.t),
      notes: series.notes,
    })),
  }));
}
