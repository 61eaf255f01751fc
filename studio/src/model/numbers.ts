// Numbers as people read and type them: units, sliders, digits.

/** What one of a unit is in the SI unit of its dimension; null for units that only stand alone. */
const UNITS: Record<string, [dimension: string, factor: number]> = {
  m: ["length", 1],
  km: ["length", 1e3],
  cm: ["length", 1e-2],
  mm: ["length", 1e-3],
  um: ["length", 1e-6],
  nm: ["length", 1e-9],
  deg: ["angle", Math.PI / 180],
  rad: ["angle", 1],
  W: ["power", 1],
  mW: ["power", 1e-3],
  kW: ["power", 1e3],
  s: ["time", 1],
  ms: ["time", 1e-3],
  K: ["temperature", 1],
  lm: ["luminous flux", 1],
  cd: ["luminous intensity", 1],
  lx: ["illuminance", 1],
};

export const unitNames = Object.keys(UNITS);

/** How many of the unit `to` one of `from` is, or undefined where they measure different things. */
export function convert(from: string, to: string): number | undefined {
  const a = UNITS[from];
  const b = UNITS[to];
  return a && b && a[0] === b[0] ? a[1] / b[1] : undefined;
}

/** A number with at most `digits` significant digits, without superfluous zeros. */
export function brief(value: number, digits = 6): string {
  if (!Number.isFinite(value)) return String(value);
  if (value === 0) return "0";
  const rounded = Number(value.toPrecision(digits));
  const size = Math.abs(rounded);
  if (size >= 1e-4 && size < 1e7) return String(rounded);
  return rounded.toExponential().replace("e+", "e");
}

/** `before` is what was written, as "30 cm"; gives `value`, which is in `memberUnit`, in the unit that was written. */
export function inUnitOf(before: string, value: number, memberUnit: string, digits = 6): string {
  const written = /^\s*[-+]?[\d.]+(?:[eE][-+]?\d+)?\s*([A-Za-z]+)\s*$/.exec(before)?.[1];
  if (!written) return brief(value, digits);
  const factor = convert(memberUnit, written);
  return factor === undefined ? brief(value, digits) : `${brief(value * factor, digits)} ${written}`;
}

export interface Scale {
  low: number;
  high: number;
  logarithmic: boolean;
  integer: boolean;
}

/** Where on its slider, from 0 to 1, a value stands. Logarithmic ones that start at 0 have it at their left end. */
export function toSlider(value: number, scale: Scale): number {
  const { low, high } = scale;
  if (!scale.logarithmic) return clamp01((value - low) / (high - low));
  const least = leastOf(scale);
  if (value < least) return 0;
  return clamp01(Math.log(value / least) / Math.log(high / least));
}

/** The value at a place of a slider, rounded to what a hand can mean: three digits of the slider's length. */
export function fromSlider(place: number, scale: Scale): number {
  const { low, high } = scale;
  const t = clamp01(place);
  if (t === 0) return low;
  if (t === 1) return high;
  const least = leastOf(scale);
  const value = scale.logarithmic ? least * Math.pow(high / least, t) : low + t * (high - low);
  if (scale.integer) return Math.min(high, Math.max(low, Math.round(value)));
  if (scale.logarithmic) return Number(value.toPrecision(3));
  const step = Math.pow(10, Math.floor(Math.log10(high - low)) - 3);
  return Number((Math.round(value / step) * step).toPrecision(6));
}

function leastOf({ low, high, integer }: Scale): number {
  return low > 0 ? low : integer ? 1 : high * 1e-6;
}

function clamp01(t: number): number {
  return Math.min(1, Math.max(0, t));
}

/** Seconds as people say them: 4.2 s, 3 min 20 s, 2 h 5 min. */
export function duration(seconds: number): string {
  if (!Number.isFinite(seconds) || seconds < 0) return "–";
  if (seconds < 10) return `${seconds.toFixed(1)} s`;
  const whole = Math.round(seconds);
  if (whole < 60) return `${whole} s`;
  const minutes = Math.floor(whole / 60);
  if (minutes < 60) return whole % 60 ? `${minutes} min ${whole % 60} s` : `${minutes} min`;
  return minutes % 60 ? `${Math.floor(minutes / 60)} h ${minutes % 60} min` : `${Math.floor(minutes / 60)} h`;
}

/** A part of 1 in per cent with two digits. */
export function percent(part: number): string {
  return Number.isFinite(part) ? `${brief(part * 100, 2)} %` : "–";
}
