// The light groups of the picture, watched as layers as long as they are weighed, and the picture that they make together.
import { computed, effect, signal } from "@preact/signals";
import { progress } from "../model/state.ts";
import { watchSide } from "../model/studio.ts";
import { Film } from "./film.ts";
import { asItIs, factorsOf, mix, type Gain, type Rgb } from "./mix.ts";
import { coarse, forgetSides, layer, pixelsVersion, relit, sideFilms } from "./store.ts";

const prefix = "light.";
/** Slots of `watch`: those before belong to renders side by side. */
const firstSlot = 8;
export const most = 16;

const joined = computed(() => (progress.value?.layers ?? []).filter((l) => l.startsWith(prefix)).map((l) => l.slice(prefix.length)).join("\n"));
/** Names of the groups that the render keeps. */
export const groups = computed(() => (joined.value ? joined.value.split("\n") : []));

const wanted = signal(false);
/** Whether the picture is shown with its lights weighed. A layer is shown as it is. */
export const relighting = computed(() => wanted.value && groups.value.length > 0 && layer.value === "");
export function relight(on: boolean): void {
  wanted.value = on;
}

export const gains = signal<ReadonlyMap<string, Gain>>(new Map());
export const gainOf = (name: string): Gain => gains.value.get(name) ?? asItIs;
export function setGain(name: string, change: Partial<Gain>): void {
  gains.value = new Map(gains.value).set(name, { ...gainOf(name), ...change });
  wanted.value = true;
}
export function resetGains(): void {
  gains.value = new Map();
}

/** What each group is multiplied by, as the program is told. */
export const factors = computed<Record<string, Rgb>>(() => Object.fromEntries(groups.value.map((g) => [g, factorsOf(gainOf(g))])));

effect(() => {
  if (!relighting.value) return;
  const shown = groups.value.slice(0, most);
  shown.forEach((name, i) => watchSide(firstSlot + i, { layer: prefix + name }));
  return () => {
    shown.forEach((_, i) => watchSide(firstSlot + i, null));
    forgetSides(firstSlot, firstSlot + most);
    relit.value = null;
    pixelsVersion.value += 1;
  };
});

let frame = 0;
effect(() => {
  void [relighting.value, factors.value, sideFilms.value, coarse.value];
  if (!frame) frame = requestAnimationFrame(show);
});

/** Makes the picture of the groups, when all are there in one size; before that the last one stays. */
function show(): void {
  frame = 0;
  if (!relighting.value) return;
  const parts = groups.value.slice(0, most).map((name, i) => ({ film: sideFilms.value.get(firstSlot + i), factors: factors.value[name] as Rgb }));
  const [width, height] = [parts[0]?.film?.width ?? 0, parts[0]?.film?.height ?? 0];
  const whole = parts.filter((p): p is { film: Film; factors: Rgb } => p.film?.width === width && p.film.height === height);
  if (!width || whole.length < parts.length) return;
  const old = relit.value;
  const into = old?.width === width && old.height === height ? old : new Film(width, height);
  mix(whole, into);
  relit.value = into;
  pixelsVersion.value += 1;
}
