// Light adds up: a picture is the sum of its light groups, each multiplied by what it is weighed with.
import { halves, toHalf } from "../model/half.ts";
import { Film } from "./film.ts";

export type Rgb = [number, number, number];

/** How a group is shown. */
export interface Gain {
  on: boolean;
  /** Powers of two. */
  stops: number;
  /** As the page writes colours, "#rrggbb" in sRGB. */
  color: string;
}

export const asItIs: Gain = { on: true, stops: 0, color: "#ffffff" };

/** What the light of a group is multiplied by, in linear sRGB (the curve: IEC 61966-2-1). */
export function factorsOf({ on, stops, color }: Gain): Rgb {
  const part = (i: number): number => {
    const c = parseInt(color.slice(1 + 2 * i, 3 + 2 * i), 16) / 255;
    return on ? 2 ** stops * (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4) : 0;
  };
  return [part(0), part(1), part(2)];
}

/** The sum of films of one size, each multiplied, into another of that size. */
export function mix(parts: readonly { film: Film; factors: Rgb }[], into: Film): void {
  into.scale = Math.max(...parts.map((p) => p.film.scale));
  const many = parts.map(({ film, factors }) => ({ from: film.pixels, by: factors.map((f) => (f * film.scale) / into.scale) as Rgb }));
  const { pixels } = into;
  for (let i = 0; i < pixels.length; i += 4) {
    let [r, g, b] = [0, 0, 0];
    for (const { from, by } of many) {
      r += by[0] * (halves[from[i] as number] as number);
      g += by[1] * (halves[from[i + 1] as number] as number);
      b += by[2] * (halves[from[i + 2] as number] as number);
    }
    pixels[i] = toHalf(r);
    pixels[i + 1] = toHalf(g);
    pixels[i + 2] = toHalf(b);
    pixels[i + 3] = 0x3c00;
  }
  into.touch();
}
