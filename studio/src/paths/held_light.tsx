// What the renderer holds of light, beside the paths: its photons, and its guide's directions at the chosen pixel.
import { effect, signal } from "@preact/signals";
import type { JSX } from "preact";
import { brief, percent } from "../model/numbers.ts";
import { Refused } from "../model/protocol.ts";
import { progress } from "../model/state.ts";
import { demand } from "../model/studio.ts";
import { Button } from "../parts/parts.tsx";
import { pathPixel } from "../picture/state.ts";
import { texts } from "../texts/texts.ts";
import type { Lobes, Photons } from "./light.ts";

const t = texts.heldLight;

export const photons = signal<Photons | null>(null);
export const lobes = signal<Lobes | null>(null);
const problem = signal("");

async function ask<T>(what: string, with_: Record<string, unknown>): Promise<T | null> {
  problem.value = "";
  try {
    return await demand<T>(what, with_);
  } catch (error) {
    problem.value = error instanceof Refused ? error.message : texts.notices.offline;
    return null;
  }
}

// They are of a render that is no more once another has begun.
let generation = 0;
effect(() => {
  const now = progress.value?.generation ?? 0;
  if (now !== generation) photons.value = lobes.value = null;
  generation = now;
});

export function HeldLight(): JSX.Element {
  const pixel = pathPixel.value;
  return (
    <section aria-label={t.title}>
      <h2 class="small">{t.title}</h2>
      <div class="cluster">
        <Button label={t.photons} pressed={photons.value !== null}
          onClick={() => void (photons.value ? (photons.value = null) : ask<Photons>("photons", { most: 10000 }).then((p) => (photons.value = p)))} />
        <Button label={t.lobes} pressed={lobes.value !== null} disabled={!pixel}
          onClick={() => void (lobes.value ? (lobes.value = null) : ask<Lobes>("lobes", { ...pixel }).then((l) => (lobes.value = l)))} />
      </div>
      {problem.value && <p class="dim" role="status">{problem.value}</p>}
      {photons.value && <p class="dim photon-count">{t.some(photons.value.segments.length, photons.value.all, photons.value.caustic.filter(Boolean).length)}</p>}
      {lobes.value && <p class="dim">{lobes.value.share > 0 ? t.share(percent(lobes.value.share), brief(Math.max(...lobes.value.density), 3)) : t.nothingLearned}</p>}
    </section>
  );
}
