// What the page and the program say to each other: docs/studio-protocol.md.
import type { ClassInfo } from "./classes.ts";

export interface Problem {
  message: string;
  code?: string;
  file?: string;
  line?: number;
  column?: number;
  begin?: number;
  end?: number;
  shown?: string;
}

export interface ColorValue {
  text: string;
  srgb: [number, number, number];
  xyz?: [number, number, number];
  wavelengths?: number[];
  values?: number[];
}

export interface ComponentUse {
  component: number;
}

export type Data =
  | number
  | boolean
  | string
  | null
  | Data[]
  | ComponentUse
  | { color: ColorValue }
  | { transform: { matrix?: number[]; text?: string } }
  | { large: { rows: number; width: number } };

export interface MemberState {
  written: boolean;
  /** As it is written, or would be; left out where a component's is long. */
  text: string;
  begin?: number;
  end?: number;
  value: Data;
  matters: boolean;
}

export interface Use {
  id: number;
  member: string;
  index?: number;
}

export interface Component {
  id: number;
  class: string;
  name: string | null;
  written: "text" | "literal" | "default" | "elsewhere";
  file?: string;
  begin?: number;
  end?: number;
  uses: Use[];
  members: Record<string, MemberState>;
}

export interface Name {
  name: string;
  begin?: number;
  end?: number;
  component: number | null;
  text: string;
  parameter: boolean;
  used: boolean;
}

export interface DocumentState {
  file: string | null;
  title: string;
  revision: number;
  saved_revision: number;
  changed: boolean;
  undo: string | null;
  redo: string | null;
  undo_count: number;
  redo_count: number;
  valid: boolean;
  draft: boolean;
  errors: Problem[];
  warnings: Problem[];
  changed_on_disk: boolean;
}

export interface TextChange {
  begin: number;
  end: number;
  insert: string;
}

export interface TextState {
  revision: number;
  text?: string;
  changes?: TextChange[];
  by?: number;
  request?: number;
  draft?: { text: string; errors: Problem[] } | null;
}

export interface TreeState {
  revision: number;
  root?: number;
  components?: Record<string, Component>;
  names?: Name[];
  update?: Record<string, Component>;
}

export interface Progress {
  state: "rendering" | "paused" | "finished" | "stopped" | "empty";
  ended: "samples" | "time" | "error" | null;
  samples: number;
  samples_wanted: number;
  fraction: number;
  seconds: number;
  seconds_left: number | null;
  samples_per_second: number;
  error: number | null;
  bad_samples: number;
  generation: number;
  width: number;
  height: number;
  layers: string[];
  errors: Problem[];
  coarse: boolean;
}

/** A render beside the document's own: its text with another renderer, or other members. */
export interface SideRender extends Progress {
  render: number;
  title: string;
  renderer: string | null;
  set: Record<string, string>;
}

/** A picture that is pinned, or a file that is viewed. */
export interface PictureInfo {
  name: string;
  width: number;
  height: number;
  channels: string[];
}

export interface SavedView {
  name: string;
  class: string;
  used: boolean;
}

/** Values as halves, in base64: linear sRGB is half × scale. */
export interface PackedPicture {
  scale: number;
  halfs: string;
}

export interface Strategy {
  strategy: string;
  length: number;
  mean: number;
  weighted: PackedPicture;
  unweighted: PackedPicture;
}

export interface QueueEntry {
  entry: number;
  file: string;
  state: "waiting" | "rendering" | "done" | "failed";
  fraction: number;
  outputs: string[];
  errors: Problem[];
}

export interface Queue {
  running: boolean;
  entries: QueueEntry[];
}

export interface Unit {
  name: string;
  dimension: string;
  factor: number;
}

export interface Hello {
  protocol: number;
  version: string;
  read_only: boolean;
  browser: number;
  classes: ClassInfo[];
  units: Unit[];
  functions: { name: string; usage: string }[];
  names: { illuminants: string[]; glasses: string[]; metals: string[]; rgb_spaces: string[] };
  folders: string[];
  document: DocumentState;
  text: TextState;
  tree: TreeState | null;
  progress: Progress;
  queue: Queue;
  renders?: SideRender[];
  viewing?: boolean;
  pictures?: PictureInfo[];
}

export interface Task {
  task: number;
  title?: string;
  state: "running" | "done" | "failed" | "ended";
  text?: string;
  fraction?: number;
  passed?: boolean;
  width?: number;
  height?: number;
  strategies?: Strategy[];
}

export interface Notice {
  text: string;
  kind: "info" | "warning" | "error";
}

export interface Reply {
  id: number;
  ok: boolean;
  errors?: Problem[];
  [other: string]: unknown;
}

export type Event = { event: string } & Record<string, unknown>;

/** A refusal: what the program said is wrong. Nothing has changed. */
export class Refused extends Error {
  constructor(readonly problems: Problem[]) {
    super(problems.map((p) => p.message).join("\n"));
  }

  get code(): string | undefined {
    return this.problems.find((p) => p.code)?.code;
  }
}

/** One message of pixels, taken apart. */
export interface Pixels {
  kind: "linear" | "toned";
  generation: number;
  width: number;
  height: number;
  x0: number;
  y0: number;
  fullWidth: number;
  fullHeight: number;
  scale: number;
  samples: number;
  coarse: boolean;
  finished: boolean;
  /** Of which `watch` it is. */
  slot: number;
  tiles: { x0: number; y0: number; x1: number; y1: number; values: Uint16Array | Uint8Array }[];
}

export const tileSize = 64;

/** Throws a RangeError where the message is shorter than it says. */
export function readPixels(message: ArrayBuffer): Pixels {
  const view = new DataView(message);
  const word = (at: number): number => view.getUint32(at, true);
  const kind = word(0);
  if (kind !== 1 && kind !== 2) throw new RangeError(`pixels of kind ${kind}`);
  const width = word(8);
  const height = word(12);
  const flags = word(40);
  const count = word(44);
  const pixels: Pixels = {
    kind: kind === 1 ? "linear" : "toned",
    generation: word(4),
    width,
    height,
    x0: word(16),
    y0: word(20),
    fullWidth: word(24),
    fullHeight: word(28),
    scale: view.getFloat32(32, true),
    samples: word(36),
    coarse: (flags & 1) !== 0,
    finished: (flags & 2) !== 0,
    slot: (flags >>> 8) & 255,
    tiles: [],
  };
  let at = (48 + 4 * count + 3) & ~3;
  for (let i = 0; i < count; ++i) {
    const x0 = view.getUint16(48 + 4 * i, true) * tileSize;
    const y0 = view.getUint16(50 + 4 * i, true) * tileSize;
    const x1 = Math.min(width, x0 + tileSize);
    const y1 = Math.min(height, y0 + tileSize);
    if (x1 <= x0 || y1 <= y0) throw new RangeError("a tile outside the picture");
    const length = (x1 - x0) * (y1 - y0) * 3;
    const values = kind === 1 ? new Uint16Array(message, at, length) : new Uint8Array(message, at, length);
    at += values.byteLength;
    pixels.tiles.push({ x0, y0, x1, y1, values });
  }
  return pixels;
}
