// A picture as it grows: red, green and blue in half floats, and what is shown of it elsewhere (numbers, histogram).
import { fromHalf, halfTimesPowerOfTwo } from "../model/half.ts";

/** A rectangle of pixels, x1 and y1 excluded. */
export interface Rectangle {
  x0: number;
  y0: number;
  x1: number;
  y1: number;
}

export class Film {
  /** Red, green, blue, alpha of each pixel, from the upper left, as bits of half floats: values are these times `scale`. */
  readonly pixels: Uint16Array;
  scale = 1;
  /** What has changed since it was last taken. */
  private changed: Rectangle | null;

  constructor(
    readonly width: number,
    readonly height: number,
  ) {
    this.pixels = new Uint16Array(width * height * 4);
    this.changed = { x0: 0, y0: 0, x1: width, y1: height };
  }

  /** Makes values that are already there be in another scale, a power of two. */
  rescale(scale: number): void {
    if (scale === this.scale) return;
    const power = Math.round(Math.log2(this.scale / scale));
    for (let i = 0; i < this.pixels.length; ++i) {
      if (i % 4 !== 3) this.pixels[i] = halfTimesPowerOfTwo(this.pixels[i] as number, power);
    }
    this.scale = scale;
    this.changed = { x0: 0, y0: 0, x1: this.width, y1: this.height };
  }

  /** Takes a tile of three half floats a pixel. What is outside the picture is left out; black pixels too, if that is asked. */
  write(tile: Rectangle, values: Uint16Array, keepWhereBlack = false): void {
    const columns = tile.x1 - tile.x0;
    const width = Math.min(tile.x1, this.width) - tile.x0;
    for (let y = tile.y0; y < Math.min(tile.y1, this.height); ++y) {
      let to = (y * this.width + tile.x0) * 4;
      let from = (y - tile.y0) * columns * 3;
      for (let x = 0; x < width; ++x, to += 4, from += 3) {
        if (keepWhereBlack && values[from] === 0 && values[from + 1] === 0 && values[from + 2] === 0) continue;
        this.pixels[to] = values[from] as number;
        this.pixels[to + 1] = values[from + 1] as number;
        this.pixels[to + 2] = values[from + 2] as number;
        this.pixels[to + 3] = 0x3c00;
      }
    }
    this.changed = this.changed ? union(this.changed, tile) : { ...tile };
  }

  takeChanged(): Rectangle | null {
    const changed = this.changed;
    this.changed = null;
    return changed;
  }

  /** Somebody has written into `pixels`, anywhere. */
  touch(): void {
    this.changed = { x0: 0, y0: 0, x1: this.width, y1: this.height };
  }

  rgb(x: number, y: number): [number, number, number] {
    const at = (y * this.width + x) * 4;
    const s = this.scale;
    return [s * fromHalf(this.pixels[at] ?? 0), s * fromHalf(this.pixels[at + 1] ?? 0), s * fromHalf(this.pixels[at + 2] ?? 0)];
  }

  copy(): Film {
    const film = new Film(this.width, this.height);
    film.pixels.set(this.pixels);
    film.scale = this.scale;
    return film;
  }
}

/** The same picture with more, or fewer, pixels: each takes the nearest. */
export function stretched(film: Film, width: number, height: number): Film {
  if (film.width === width && film.height === height) return film.copy();
  const result = new Film(width, height);
  result.scale = film.scale;
  for (let y = 0; y < height; ++y) {
    const row = Math.floor((y * film.height) / height) * film.width;
    for (let x = 0; x < width; ++x) {
      const from = (row + Math.floor((x * film.width) / width)) * 4;
      result.pixels.set(film.pixels.subarray(from, from + 4), (y * width + x) * 4);
    }
  }
  return result;
}

export function union(a: Rectangle, b: Rectangle): Rectangle {
  return { x0: Math.min(a.x0, b.x0), y0: Math.min(a.y0, b.y0), x1: Math.max(a.x1, b.x1), y1: Math.max(a.y1, b.y1) };
}

/** Luminance of linear sRGB. */
export function luminance([r, g, b]: readonly [number, number, number]): number {
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

/** Whether a pixel cannot be light: not a number, infinite, or clearly negative in all of its channels. */
export function isBad([r, g, b]: readonly [number, number, number]): boolean {
  return !Number.isFinite(r) || !Number.isFinite(g) || !Number.isFinite(b) || (r < 0 && g < 0 && b < 0);
}

export interface Histogram {
  /** How many pixels of each channel and of luminance fall into each step of a half of a power of two. */
  counts: [Uint32Array, Uint32Array, Uint32Array, Uint32Array];
  /** The powers of two at the ends. */
  low: number;
  high: number;
  bad: number;
}

/** How much there is of what brightness. At most about 200,000 pixels are looked at, evenly chosen. */
export function histogram(film: Film, low = -12, high = 8, bins = 80): Histogram {
  const counts: Histogram["counts"] = [new Uint32Array(bins), new Uint32Array(bins), new Uint32Array(bins), new Uint32Array(bins)];
  let bad = 0;
  const pixels = film.width * film.height;
  const step = Math.max(1, Math.floor(pixels / 200000));
  for (let i = 0; i < pixels; i += step) {
    const rgb = film.rgb(i % film.width, Math.floor(i / film.width));
    if (isBad(rgb)) {
      ++bad;
      continue;
    }
    const values = [rgb[0], rgb[1], rgb[2], luminance(rgb)];
    for (let c = 0; c < 4; ++c) {
      const value = values[c] as number;
      if (value <= 0) continue;
      const bin = Math.floor(((Math.log2(value) - low) / (high - low)) * bins);
      const counted = counts[c] as Uint32Array;
      if (bin >= 0 && bin < bins) counted[bin] = (counted[bin] as number) + 1;
    }
  }
  return { counts, low, high, bad };
}

/** Stops that bring the mean logarithm of luminance of what is lit to middle grey. */
export function automaticStops(film: Film): number {
  let sum = 0;
  let count = 0;
  const pixels = film.width * film.height;
  const step = Math.max(1, Math.floor(pixels / 50000));
  for (let i = 0; i < pixels; i += step) {
    const y = luminance(film.rgb(i % film.width, Math.floor(i / film.width)));
    if (!(y > 1e-7) || !Number.isFinite(y)) continue;
    sum += Math.log2(y);
    ++count;
  }
  return count ? Math.log2(0.18) - sum / count : 0;
}
