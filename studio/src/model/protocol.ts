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
  names: { illuminants: string[]; glasses: string[]; metals: string[]; sensors: string[]; rgb_spaces: string[] };
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
  spectrum?: MeasuredSpectrum;
}

/** The spectrum of a pixel from independent renders of it alone. */
export interface MeasuredSpectrum {
  x: number;
  y: number;
  renders: number;
  samples: number;
  channels: string[];
  values: number[];
  /** The standard deviations of one sample. */
  deviations: number[];
}

/** The program is at something that takes long; `what` null: no longer. */
export interface WorkingEvent {
  what: string | null;
  file?: string | null;
  seconds?: number;
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
