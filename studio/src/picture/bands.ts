// The spectrum of a pixel: which of its layers are bands, and what their errors are.
import type { MeasuredSpectrum } from "../model/protocol.ts";

export interface Bands {
  /** [nm], increasing; empty: the film has no bands with edges. */
  wavelengths: number[];
  values: number[];
  /** Of response curves, by name. */
  responses: [string, number][];
}

/** The wavelength of a channel such as S0.412,5nm; null: it is no such band. */
export function wavelengthOf(channel: string): number | null {
  const found = /^S0\.(\d+(?:,\d+)?)nm$/.exec(channel);
  return found ? Number((found[1] as string).replace(",", ".")) : null;
}

export function isBand(channel: string): boolean {
  return wavelengthOf(channel) !== null || channel.startsWith("response.");
}

/** The bands among the layers of a pixel; null: there are none. */
export function bandsOf(layers: Record<string, number | number[] | string | null>): Bands | null {
  const bands: [number, number][] = [];
  const responses: [string, number][] = [];
  for (const [name, value] of Object.entries(layers)) {
    if (typeof value !== "number") continue;
    const wavelength = wavelengthOf(name);
    if (wavelength !== null) bands.push([wavelength, value]);
    else if (name.startsWith("response.")) responses.push([name.slice("response.".length), value]);
  }
  if (!bands.length && !responses.length) return null;
  bands.sort((a, b) => a[0] - b[0]);
  return { wavelengths: bands.map((b) => b[0]), values: bands.map((b) => b[1]), responses };
}

/** The standard error of each channel in a picture with so many samples per pixel. */
export function errorsOf(measured: MeasuredSpectrum, samples: number): Map<string, number> {
  return new Map(measured.channels.map((name, i) => [name, (measured.deviations[i] ?? 0) / Math.sqrt(Math.max(1, samples))]));
}
