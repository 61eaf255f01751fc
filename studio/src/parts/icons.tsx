// Small pictures, 16 by 16, drawn with strokes of the text's colour.
import type { JSX } from "preact";

const shapes = {
  play: "M5 3.500v9l7.500-4.500z",
  pause: "M5 3.500v9M11 3.500v9",
  stop: "M4 4h8v8H4z",
  restart: "M12.800 8a4.800 4.800 0 1 1-1.500-3.500M12.800 2.500v2.800H10",
  undo: "M6 4 3 7l3 3M3.500 7H10a3 3 0 0 1 0 6H7",
  redo: "m10 4 3 3-3 3M12.500 7H6a3 3 0 0 0 0 6h3",
  save: "M3 3h8l2 2v8H3zM5.500 3v3.500h4V3M5.500 13V9.500h5V13",
  open: "M2.500 12.500v-9h4l1.500 2h5.500v7z",
  new: "M4 2.500h5l3 3v8H4zM9 2.500v3h3",
  add: "M8 3v10M3 8h10",
  remove: "M3 4.500h10M6 4.500v-2h4v2M4.500 4.500l.6 9h5.800l.6-9",
  copy: "M5.500 5.500h7.500V13H5.500zM10.500 5.500V3H3v7.500h2.500",
  up: "M8 13V3M4 7l4-4 4 4",
  down: "M8 3v10M4 9l4 4 4-4",
  more: "M3.500 8h.01M8 8h.01M12.500 8h.01",
  close: "m4 4 8 8M12 4l-8 8",
  right: "m6 3.500 4.500 4.500L6 12.500",
  search: "M7 11.500a4.500 4.500 0 1 0 0-9 4.500 4.500 0 0 0 0 9M10.500 10.500l3 3",
  fit: "M2.500 6V2.500H6M10 2.500h3.500V6M13.500 10v3.500H10M6 13.500H2.500V10",
  crop: "M4.500 1.500v10h10M1.500 4.500h10v10",
  target: "M8 12a4 4 0 1 0 0-8 4 4 0 0 0 0 8M8 1.500V5M8 11v3.500M1.500 8H5M11 8h3.500",
  pin: "M8 9.500v4.500M5 9.500h6L10 7V3h.5V2h-5v1H6v4z",
  swap: "M3 5.500h9M9.500 3 12 5.500 9.500 8M13 10.500H4M6.500 8 4 10.500 6.500 13",
  reset: "M3.200 8a4.800 4.800 0 1 0 1.500-3.500M3.200 2.500v2.800H6",
  link: "M6.500 9.500a2.500 2.500 0 0 0 3.500 0l2.500-2.500A2.500 2.500 0 0 0 9 3.500l-1 1M9.500 6.500a2.500 2.500 0 0 0-3.500 0L3.500 9A2.500 2.500 0 0 0 7 12.500l1-1",
  light: "M8 11a3 3 0 1 0 0-6 3 3 0 0 0 0 6M8 1v1.500M8 13.500V15M1 8h1.500M13.500 8H15M3 3l1 1M12 12l1 1M13 3l-1 1M4 12l-1 1",
  dark: "M13 9.500A5.500 5.500 0 0 1 6.500 3a5.500 5.500 0 1 0 6.500 6.500z",
  help: "M6 6a2 2 0 1 1 2.800 1.900c-.6.3-.8.700-.8 1.600M8 12h.01",
  folder: "M2.500 12.500v-9h4l1.500 2h5.500v7z",
  file: "M4 2.500h5l3 3v8H4zM9 2.500v3h3",
  warning: "M8 2.500 14 13H2zM8 6.500v3M8 11.300h.01",
  orbit: "M8 5.500c3.600 0 6.500 1.100 6.500 2.500S11.600 10.500 8 10.500 1.500 9.400 1.500 8 4.400 5.500 8 5.500M8 1.500c1.400 0 2.500 2.900 2.500 6.500S9.400 14.500 8 14.500 5.500 11.600 5.500 8 6.600 1.500 8 1.500",
  check: "M3 8.500 6.500 12 13 4.500",
  fly: "M1.500 8.500 14 2.500 10 13.500 7.500 9.500zM7.500 9.500 14 2.500",
  contrast: "M8 2.500a5.500 5.500 0 1 0 0 11z M8 2.500a5.500 5.500 0 0 1 0 11",
  // kinds of components
  Job: "M2.500 3.500h11v9h-11zM2.500 6h11",
  Camera: "M2 5h2.500L6 3.500h4L11.500 5H14v8H2zM8 11a2.200 2.200 0 1 0 0-4.400A2.200 2.200 0 0 0 8 11",
  Renderer: "M2 13 6 6l3 4 2-3 3 6z M11.500 4.500a1 1 0 1 0 0-2 1 1 0 0 0 0 2",
  SceneObject: "M8 2 13.500 5v6L8 14 2.500 11V5zM2.500 5 8 8l5.500-3M8 8v6",
  Shader: "M8 13.500a5.500 5.500 0 1 0 0-11 5.500 5.500 0 0 0 0 11M5.500 6.500A3 3 0 0 1 8 5",
  EmissionShader: "M8 10.500a3 3 0 1 0-3-3c0 1.500 1.200 2 1.500 3.500h3M6.500 13h3M8 2.500v-1M2.500 7.500h-1M14.500 7.500h-1M4 3.500l-.7-.7M12 3.500l.7-.7",
  VolumeShader: "M4.500 12h7a2.500 2.500 0 0 0 .3-5A4 4 0 0 0 4.300 6.500 2.800 2.800 0 0 0 4.500 12",
  PhaseFunction: "M2 8h4M6 8l7-4.500M6 8h8M6 8l7 4.500",
  ObjectMap: "M2.500 2.500h11v11h-11zM8 2.500v11M2.500 8h11",
  ToneMap: "M2.500 13.500c5 0 4-11 11-11M2.500 2.500v11h11",
  Output: "M2.500 9v4.500h11V9M8 2.500v8M5 7.500l3 3 3-3",
  ImageBuffer: "M2.500 3h11v10h-11zM2.500 11l3.500-4 3 3 1.500-1.500 3 3",
  Sampler: "M4 4h.01M9 3.500h.01M12 7h.01M6 8.500h.01M10 11h.01M4 12.500h.01M13 13h.01",
  other: "M4 4h8v8H4z",
} as const;

export type IconName = keyof typeof shapes;

const kinds = new Set(Object.keys(shapes));

export function Icon({ name }: { name: IconName }): JSX.Element {
  return (
    <svg class="icon" viewBox="0 0 16 16" width="16" height="16" aria-hidden="true" focusable="false">
      <path d={shapes[name]} fill="none" stroke="currentColor" stroke-width="1.35" stroke-linecap="round" stroke-linejoin="round" />
    </svg>
  );
}

/** The icon of a kind of component. */
export function kindIcon(kind: string): IconName {
  const near: Record<string, IconName> = { LightSampler: "Sampler", WavelengthSampler: "Sampler", Filter: "ImageBuffer" };
  return near[kind] ?? (kinds.has(kind) ? (kind as IconName) : "other");
}
