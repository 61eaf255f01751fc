// Renders side by side: the document's own and others of the same scene, live, with the courses of their errors.
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect } from "preact/hooks";
import { brief, duration, percent } from "../model/numbers.ts";
import type { Progress } from "../model/protocol.ts";
import { classes, progress, readOnly, renders, root } from "../model/state.ts";
import { ask, report, watchSide } from "../model/studio.ts";
import { forgetSides, shownFilm, sideFilms } from "../picture/store.ts";
import type { Film } from "../picture/film.ts";
import { Button } from "../parts/parts.tsx";
import { texts } from "../texts/texts.ts";
import { ErrorCurves, lineColors } from "./curves.tsx";
import { SmallPicture } from "./small_picture.tsx";

const t = texts.sides;
const most = 4;

/** `PATH: VALUE; PATH: VALUE` taken apart; throws what is neither. */
export function readSettings(text: string): Record<string, string> {
  const found: Record<string, string> = {};
  for (const part of text.split(";").map((p) => p.trim()).filter(Boolean)) {
    const colon = part.search(/[:=]/);
    const [path, value] = [part.slice(0, colon).trim(), part.slice(colon + 1).trim()];
    if (colon < 1 || !value) throw new Error(t.notSet(part));
    found[path] = value;
  }
  return found;
}

export function Sides(): JSX.Element {
  const all = renders.value;
  // Each has the slot of its place: they are watched as long as they are looked at.
  const numbers = all.map((r) => r.render).join(" ");
  useEffect(() => {
    all.forEach((r, i) => watchSide(i + 1, { render: r.render }));
    return () => {
      for (let slot = 1; slot <= all.length; ++slot) watchSide(slot, null);
      forgetSides(1, all.length);
    };
  }, [numbers]);
  return (
    <div class="sides">
      <Adding full={all.length >= most} />
      <div class="sides-grid" style={{ gridTemplateColumns: `repeat(${all.length === 0 ? 1 : all.length < 3 ? all.length + 1 : 3}, minmax(0, 1fr))` }}>
        <Side title={t.own} color={lineColors[0] as string} state={progress.value} film={shownFilm.value} />
        {all.map((r, i) => (
          <Side key={r.render} title={r.title} color={lineColors[(i + 1) % lineColors.length] as string} state={r} film={sideFilms.value.get(i + 1) ?? null} remove={r.render} />
        ))}
      </div>
      {all.length === 0 ? <p class="empty-note">{t.none}</p> : <ErrorCurves />}
    </div>
  );
}

interface SideProps {
  title: string;
  color: string;
  state: Progress | null;
  film: Film | null;
  remove?: number;
}

function Side({ title, color, state, film: shown, remove }: SideProps): JSX.Element {
  return (
    <figure class="side">
      <figcaption>
        <span class="dot" style={{ background: color }} />
        <b>{title}</b>
        <span class="spring" />
        {remove !== undefined && <Button icon="close" label={t.remove(title)} disabled={readOnly.value} onClick={() => void ask("renders", { remove })} />}
      </figcaption>
      <SmallPicture film={shown} label={t.picture(title)} />
      {state && (
        <p class="facts-row">
          <span>{brief(state.samples)} {texts.control.samples.toLowerCase()}</span>
          <span>{duration(state.seconds)}</span>
          <span>{texts.control.error} {state.error === null ? "–" : percent(state.error)}</span>
        </p>
      )}
      {state?.errors.map((e) => <p class="wrong" role="alert" key={e.message}>{e.message}</p>)}
    </figure>
  );
}

function Adding({ full }: { full: boolean }): JSX.Element {
  const renderer = useSignal("");
  const settings = useSignal("");
  const off = readOnly.value || root.value === null || full;
  const add = async (event: Event): Promise<void> => {
    event.preventDefault();
    try {
      const set = readSettings(settings.value);
      await ask("renders", { add: { ...(renderer.value ? { renderer: renderer.value } : {}), ...(Object.keys(set).length ? { set } : {}) } });
    } catch (error) {
      report(error instanceof Error ? error.message : error);
    }
  };
  return (
    <form class="toolbar" aria-label={t.with} onSubmit={(e) => void add(e)}>
      <label class="inline">
        <span>{t.renderer}</span>
        <select value={renderer.value} disabled={off} onChange={(e) => (renderer.value = e.currentTarget.value)}>
          <option value="">{t.same}</option>
          {classes.value.offered("Renderer").map((c) => <option key={c.name}>{c.name}</option>)}
        </select>
      </label>
      <label class="inline">
        <span>{t.set}</span>
        <input type="text" spellcheck={false} placeholder="renderer.max_depth: 3" title={t.setHelp} disabled={off} value={settings.value} onInput={(e) => (settings.value = e.currentTarget.value)} />
      </label>
      <button type="submit" class="button" disabled={off}>{t.add}</button>
      <span class="dim">{full ? t.most : t.help}</span>
    </form>
  );
}
