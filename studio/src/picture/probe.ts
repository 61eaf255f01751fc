// The pixel at the cursor, and the values of it that the program is asked for.
import { computed, signal } from "@preact/signals";
import { line, pictures, viewing } from "../model/state.ts";
import { demand } from "../model/studio.ts";

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
