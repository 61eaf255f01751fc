// The numbers of a pixel: at once what is on the page, and after a moment what the program knows of it.
import { computed, signal } from "@preact/signals";
import type { JSX } from "preact";
import { brief, percent } from "../model/numbers.ts";
import { line, pictures, viewing } from "../model/state.ts";
import { demand } from "../model/studio.ts";
import { texts } from "../texts.ts";
import { zoom } from "./state.ts";
import { luminance } from "./film.ts";
import { pixelsVersion, relit, samplesShown, shownFilm, size } from "./store.ts";

export interface Pixel {
  x: number;
  y: number;
}

interface Probe extends Pixel {
  xyz: [number, number, number];
  rgb: [number, number, number];
  samples: number;
  error: number | null;
  layers?: Record<string, number | number[]>;
}

/** The pixel under the mouse, or where the arrow keys have brought the cursor. */
export const cursor = signal<Pixel | null>(null);
/** The picture that has been chosen in `etendue view`. */
export const chosenPicture = signal<string | null>(null);
export const probe = signal<Probe | null>(null);

/** The name of the picture that is viewed; null for the render. */
export const watchedPicture = computed(() => (viewing.value ? (chosenPicture.value ?? pictures.value[0]?.name ?? null) : null));

let asking = false;
let next: Pixel | null = null;
let timer = 0;

/** Asks the program for a pixel, after a moment of rest or now. */
export function probeAt(pixel: Pixel, now = false): void {
  next = pixel;
  clearTimeout(timer);
  timer = window.setTimeout(() => void askProbe(), now ? 0 : 120);
}

async function askProbe(): Promise<void> {
  if (asking || !next || line.value !== "open") return;
  asking = true;
  const { x, y } = next;
  next = null;
  try {
    const picture = watchedPicture.value;
    probe.value = picture === null ? await demand<Probe>("probe", { x, y }) : { ...(await demand<Probe>("picture_probe", { picture, x, y })), samples: 0, error: null };
  } catch {
    probe.value = null; // there is no picture yet
  } finally {
    asking = false;
  }
  if (next) void askProbe();
}

cursor.subscribe((pixel) => pixel && probeAt(pixel));

const here = computed(() => {
  void pixelsVersion.value;
  const pixel = cursor.value;
  const film = shownFilm.value;
  if (!pixel || !film) return null;
  const x = Math.floor((pixel.x / size.value.width) * film.width);
  const y = Math.floor((pixel.y / size.value.height) * film.height);
  return { ...pixel, rgb: film.rgb(x, y) };
});

const number = (v: number | string): string => (typeof v === "number" && Number.isFinite(v) ? brief(v, 4) : String(v));

export function PixelNumbers(): JSX.Element {
  const now = here.value;
  const weighed = relit.value !== null;
  const known = probe.value && now && probe.value.x === now.x && probe.value.y === now.y ? probe.value : null;
  return (
    <div class="pixel-numbers" id="picture-numbers" aria-live="off">
      {now ? (
        <dl>
          <Item label={texts.picture.pixel} value={`${now.x}, ${now.y}`} width={9} />
          <Item label="RGB" value={(weighed ? now.rgb : (known?.rgb ?? now.rgb)).map(number).join("  ")} width={22} />
          {!weighed && <Item label="XYZ" value={known ? known.xyz.map(number).join("  ") : "…"} width={22} />}
          <Item label="Y" value={number(known && !weighed ? known.xyz[1] : luminance(now.rgb))} width={7} />
          {!viewing.value && <Item label={texts.picture.samples} value={brief(known?.samples ?? samplesShown.value)} width={6} />}
          {!viewing.value && <Item label={texts.picture.error} value={known?.error != null ? percent(known.error) : "–"} width={7} />}
          {Object.entries(known?.layers ?? {}).map(([name, v]) => (
            <Item key={name} label={name} value={(Array.isArray(v) ? v : [v]).map(number).join("  ")} width={6} />
          ))}
        </dl>
      ) : (
        <span class="dim">{size.value.width ? texts.picture.size(size.value.width, size.value.height, samplesShown.value, percent(zoom.value)) : ""}</span>
      )}
    </div>
  );
}

function Item({ label, value, width }: { label: string; value: string; width: number }): JSX.Element {
  return (
    <div>
      <dt>{label}</dt>
      <dd style={{ minWidth: `${width}ch` }}>{value}</dd>
    </div>
  );
}
