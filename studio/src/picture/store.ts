// The pictures that are there: the one that grows, a coarse one while a camera moves, display values, and a pinned one.
import { computed, signal } from "@preact/signals";
import { readPixels, type Pixels } from "../model/pixels.ts";
import { automaticStops, Film, stretched } from "./film.ts";
import type { Toned } from "./screen.ts";
import type { Size } from "./view.ts";

export type Curve = "linear" | "filmic" | "reinhard" | "program";
export type Compare = "none" | "split" | "flicker" | "difference";

/** Grows with every change of pixels. */
export const pixelsVersion = signal(0);
export const film = signal<Film | null>(null);
export const coarse = signal<Film | null>(null);
/** Until every pixel has a sample: those that have one, over what was seen before. */
export const mixed = signal<Film | null>(null);
export const toned = signal<Toned | null>(null);
export const size = signal<Size>({ width: 0, height: 0 });
export const samplesShown = signal(0);

export const stops = signal(0);
/** Whether somebody has chosen the exposure; until then it follows the first samples. */
let exposed = false;
export function expose(to: number): void {
  exposed = true;
  stops.value = Number(to.toFixed(2));
}
export const curve = signal<Curve>("linear");
export const falseColor = signal(false);
export const falseRange = signal<[number, number]>([-8, 4]);
export const markBad = signal(true);
export const layer = signal("");

export const pinned = signal<{ film: Film; title: string } | null>(null);
export const compare = signal<Compare>("none");
/** From 0 to 1 over the canvas. */
export const split = signal(0.5);

/** The picture with its lights weighed anew: lights.ts. */
export const relit = signal<Film | null>(null);

export const shownFilm = computed(() => relit.value ?? coarse.value ?? mixed.value ?? film.value);
/** The curve as it is shown: the job's tone map knows nothing of lights that are weighed here. */
export const shownCurve = computed<Curve>(() => (relit.value && curve.value === "program" ? "filmic" : curve.value));

/** Pictures of renders beside the document's own, by slot. */
export const sideFilms = signal<ReadonlyMap<number, Film>>(new Map());

export function forgetSides(first: number, last: number): void {
  sideFilms.value = new Map([...sideFilms.value].filter(([slot]) => slot < first || slot > last));
}

function takeSide(pixels: Pixels): void {
  const { fullWidth, fullHeight, slot, coarse: isCoarse, x0: left, y0: top, width, height } = pixels;
  const [w, h, dx, dy] = isCoarse ? [width, height, 0, 0] : [fullWidth, fullHeight, left, top];
  const old = sideFilms.value.get(slot);
  const to = old?.width === w && old.height === h ? old : new Film(w, h);
  to.rescale(pixels.scale);
  for (const { x0, y0, x1, y1, values } of pixels.tiles) to.write({ x0: x0 + dx, y0: y0 + dy, x1: x1 + dx, y1: y1 + dy }, values as Uint16Array);
  sideFilms.value = new Map(sideFilms.value).set(slot, to);
}

export function takePixels(message: ArrayBuffer): void {
  const pixels = readPixels(message);
  if (pixels.slot > 0) return takeSide(pixels);
  size.value = { width: pixels.fullWidth, height: pixels.fullHeight };
  samplesShown.value = pixels.samples;
  if (pixels.kind === "linear") takeLinear(pixels);
  else takeToned(pixels);
  pixelsVersion.value += 1;
}

function takeLinear(pixels: Pixels): void {
  const target = pixels.coarse ? coarse : film;
  const wanted = pixels.coarse ? pixels : { width: pixels.fullWidth, height: pixels.fullHeight };
  let to = target.value;
  if (!to || to.width !== wanted.width || to.height !== wanted.height) target.value = to = new Film(wanted.width, wanted.height);
  to.rescale(pixels.scale);
  const first = !pixels.coarse && pixels.samples === 0;
  if (first && !mixed.value) {
    const seen = coarse.value ?? target.peek();
    mixed.value = seen ? stretched(seen, wanted.width, wanted.height) : null;
  } else if (!first) mixed.value = null;
  mixed.value?.rescale(pixels.scale);
  const [dx, dy] = pixels.coarse ? [0, 0] : [pixels.x0, pixels.y0];
  for (const { x0, y0, x1, y1, values } of pixels.tiles) {
    const tile = { x0: x0 + dx, y0: y0 + dy, x1: x1 + dx, y1: y1 + dy };
    to.write(tile, values as Uint16Array);
    mixed.value?.write(tile, values as Uint16Array, true);
  }
  if (!pixels.coarse) coarse.value = null;
  if (!exposed) {
    stops.value = Number(automaticStops(to).toFixed(2));
    exposed = pixels.samples >= 4 || pixels.finished;
  }
}

function takeToned(pixels: Pixels): void {
  const wanted = pixels.coarse ? pixels : { width: pixels.fullWidth, height: pixels.fullHeight };
  const old = toned.value;
  const same = old !== null && old.width === wanted.width && old.height === wanted.height;
  const values = same ? old.pixels : new Uint8Array(wanted.width * wanted.height * 4);
  const [dx, dy] = pixels.coarse ? [0, 0] : [pixels.x0, pixels.y0];
  for (const tile of pixels.tiles) {
    let from = 0;
    for (let y = tile.y0 + dy; y < tile.y1 + dy; ++y) {
      let to = (y * wanted.width + tile.x0 + dx) * 4;
      for (let x = tile.x0; x < tile.x1; ++x, to += 4) {
        values[to] = tile.values[from++] as number;
        values[to + 1] = tile.values[from++] as number;
        values[to + 2] = tile.values[from++] as number;
        values[to + 3] = 255;
      }
    }
  }
  toned.value = { width: wanted.width, height: wanted.height, pixels: values };
}

export function forgetPictures(): void {
  film.value = coarse.value = mixed.value = toned.value = relit.value = null;
  exposed = false;
  pixelsVersion.value += 1;
}

export function pin(title: string): void {
  const now = film.value;
  if (!now) return;
  pinned.value = { film: now.copy(), title };
  if (compare.value === "none") compare.value = "split";
  pixelsVersion.value += 1;
}

export function unpin(): void {
  pinned.value = null;
  compare.value = "none";
}
