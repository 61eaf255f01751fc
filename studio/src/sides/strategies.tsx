// What each strategy of a bidirectional method brings, as a pyramid of pictures: a row for each length of paths.
import { signal, useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { fromBase64 } from "../model/half.ts";
import { brief } from "../model/numbers.ts";
import type { PackedPicture, Strategy, Task } from "../model/protocol.ts";
import { Button, Dialog } from "../parts/parts.tsx";
import { Film } from "../picture/film.ts";
import { texts } from "../texts/texts.ts";
import { SmallPicture } from "./small_picture.tsx";

const t = texts.strategies;

/** The finished task whose pictures are shown. */
export const shownStrategies = signal<Task | null>(null);

function filmOf({ scale, halfs }: PackedPicture, width: number, height: number): Film {
  const film = new Film(width, height);
  film.rescale(scale);
  film.write({ x0: 0, y0: 0, x1: width, y1: height }, fromBase64(halfs));
  return film;
}

export function Strategies(): JSX.Element | null {
  const task = shownStrategies.value;
  const weighted = useSignal(true);
  if (!task?.strategies || !task.width || !task.height) return null;
  const { width, height, strategies } = task;
  const lengths = [...new Set(strategies.map((s) => s.length))].sort((a, b) => a - b);
  const view = (s: Strategy): Film => filmOf(weighted.value ? s.weighted : s.unweighted, width, height);
  return (
    <Dialog title={t.title} close={() => (shownStrategies.value = null)} class="wide">
      <p class="dim">{t.help}</p>
      <div class="cluster">
        <Button label={t.weighted} pressed={weighted.value} onClick={() => (weighted.value = true)} />
        <Button label={t.unweighted} pressed={!weighted.value} onClick={() => (weighted.value = false)} />
      </div>
      <div class="pyramid scroll" tabIndex={0} role="region" aria-label={t.title}>
        {lengths.map((length) => (
          <section key={length} aria-label={t.length(length)}>
            <h3>{t.length(length)}</h3>
            <div class="pyramid-row">
              {strategies.filter((s) => s.length === length).map((s) => (
                <figure key={`${s.strategy}.${weighted.value}`}>
                  <SmallPicture film={view(s)} label={s.strategy} />
                  <figcaption>
                    {s.strategy} <span class="dim">{t.mean(brief(s.mean, 3))}</span>
                  </figcaption>
                </figure>
              ))}
            </div>
          </section>
        ))}
      </div>
    </Dialog>
  );
}
