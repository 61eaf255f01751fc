// The spectrum of the pixel that was looked at last, with the band of its standard error once that was measured.
import { computed, signal } from "@preact/signals";
import type { JSX } from "preact";
import { brief } from "../model/numbers.ts";
import type { MeasuredSpectrum } from "../model/protocol.ts";
import { readOnly, tasks, viewing } from "../model/state.ts";
import { ask } from "../model/studio.ts";
import { SpectrumPlot } from "../panel/spectrum.tsx";
import { Button } from "../parts/parts.tsx";
import { texts } from "../texts/texts.ts";
import { bandsOf, errorsOf } from "./bands.ts";
import { probe } from "./probe.ts";

const t = texts.picture.spectrum;

/** The task that measures an error at present. */
const asked = signal<number | null>(null);

const measured = computed<MeasuredSpectrum | null>(() => {
  const pixel = probe.value;
  if (!pixel) return null;
  const known = tasks.value.filter((task) => task.spectrum && task.spectrum.x === pixel.x && task.spectrum.y === pixel.y);
  return known.at(-1)?.spectrum ?? null;
});

async function measure(x: number, y: number): Promise<void> {
  const reply = await ask<{ task: number }>("spectrum", { x, y });
  asked.value = reply?.task ?? null;
}

export function PixelSpectrum(): JSX.Element | null {
  const pixel = probe.value;
  const bands = pixel?.layers ? bandsOf(pixel.layers) : null;
  if (!pixel || !bands) return null;
  const errors = measured.value && pixel.samples > 0 ? errorsOf(measured.value, pixel.samples) : null;
  const inOrder = errors && [...errors].filter(([name]) => !name.startsWith("response.")).map(([, error]) => error);
  const running = tasks.value.some((task) => task.task === asked.value && task.state === "running");
  return (
    <section class="pixel-spectrum" aria-label={t.title(pixel.x, pixel.y)}>
      <h2 class="small">{t.title(pixel.x, pixel.y)}</h2>
      {bands.wavelengths.length > 0 && (
        <SpectrumPlot wavelengths={bands.wavelengths} values={bands.values} {...(inOrder?.length === bands.values.length ? { errors: inOrder } : {})} />
      )}
      {bands.responses.map(([name, value]) => (
        <p key={name}>
          {name} <b>{brief(value, 4)}</b> {errors && <span class="dim">± {brief(errors.get(`response.${name}`) ?? 0, 2)}</span>}
        </p>
      ))}
      <p class="dim">{errors ? t.error(measured.value?.renders ?? 0) : t.noError}</p>
      {!viewing.value && <Button icon="target" text label={running ? t.measuring : t.measure} hint={t.measureHelp} disabled={readOnly.value || running} onClick={() => void measure(pixel.x, pixel.y)} />}
    </section>
  );
}
