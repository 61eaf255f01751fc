// How much of each column of a picture has what brightness: a waveform.
import { luminance, type Film } from "./film.ts";

export interface Waveform {
  columns: number;
  rows: number;
  /** How many pixels of luminance fall into each step of each column, from the darkest step on: `rows` of the first column, then of the next. */
  counts: Uint32Array;
  /** The powers of two at the ends. */
  low: number;
  high: number;
}

/** At most about 200,000 pixels are looked at, evenly chosen. What is darker or brighter than the ends is in none. */
export function waveform(film: Film, columns = 240, low = -12, high = 8, rows = 80): Waveform {
  const counts = new Uint32Array(columns * rows);
  const step = Math.max(1, Math.ceil(Math.sqrt((film.width * film.height) / 200000)));
  for (let y = 0; y < film.height; y += step) {
    for (let x = 0; x < film.width; x += step) {
      const value = luminance(film.rgb(x, y));
      if (!(value > 0)) continue; // black, or no number
      const row = Math.floor(((Math.log2(value) - low) / (high - low)) * rows);
      const at = Math.floor((x / film.width) * columns) * rows + row;
      if (row >= 0 && row < rows) counts[at] = (counts[at] as number) + 1;
    }
  }
  return { columns, rows, counts, low, high };
}
