// Starting, stopping, goals, progress and the course of the error: the strip below the picture.
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { brief, duration, percent } from "../model/numbers.ts";
import { line, opening, progress, queue, readOnly, root } from "../model/state.ts";
import { ask, demand, report } from "../model/studio.ts";
import { remember, remembered } from "../model/memory.ts";
import { Button } from "../parts/parts.tsx";
import { texts } from "../texts/texts.ts";
import { components, document_, locked, notify, select } from "../model/state.ts";
import { chooseFile } from "../files/browser.tsx";
import { guarded } from "../parts/guarded.tsx";
import { choosing } from "../tree/actions.ts";
import { isUse } from "../tree/rows.ts";
import { ErrorCurve } from "./curve.tsx";
import { QueueView } from "./queue.tsx";
import { TasksView } from "./tasks.tsx";

const t = texts.control;

export function RenderButtons(): JSX.Element {
  const state = progress.value?.state ?? "empty";
  const off = readOnly.value || line.value !== "open" || root.value === null || opening.value;
  const running = state === "rendering";
  return (
    <div class="cluster" role="group" aria-label={t.label}>
      {running ? (
        <Button icon="pause" text label={t.pause} keys="Ctrl+Enter" disabled={off} onClick={() => void ask("pause")} />
      ) : (
        <Button icon="play" text primary label={state === "paused" || state === "stopped" ? t.goOn : t.start} keys="Ctrl+Enter" disabled={off} onClick={() => void ask("start")} />
      )}
      <Button icon="stop" label={t.stop} disabled={off || !running} onClick={() => void ask("stop")} />
      <Button icon="restart" label={t.restart} disabled={off} onClick={() => void ask("restart")} />
    </div>
  );
}

export function toggleRender(): void {
  if (!readOnly.value) void ask(progress.value?.state === "rendering" ? "pause" : "start");
}

const stateFiles = [".state"];

/** Keeps what is rendered so far in a file, from which any later session, or `etendue render --resume`, goes on. */
async function saveState(): Promise<void> {
  const base = (document_.value?.title ?? "scene").replace(/\.(etd|json)$/, "");
  const file = await chooseFile({ title: t.saveState, endings: stateFiles, save: `${base}.state` });
  if (file && (await guarded("save_state", { file }, { over: true }, "changed_on_disk", texts.top.exists(file), texts.top.over))) notify(texts.top.saved(file));
}

async function loadState(): Promise<void> {
  const file = await chooseFile({ title: t.loadState, endings: stateFiles });
  if (file && (await ask("load_state", { file }))) notify(t.loaded(file));
}

export function ControlStrip(): JSX.Element {
  const open = useSignal(remembered("control", false));
  const p = progress.value;
  const toggle = (): void => {
    open.value = !open.value;
    remember("control", open.value);
  };
  return (
    <section class="control" aria-label={t.label}>
      <div class="status">
        <span class={`state state-${p?.state ?? "empty"}`}>{opening.value ? t.opening : t.states[p?.state ?? "empty"]}</span>
        <progress max={1} value={p?.fraction ?? 0} aria-label={t.progress} />
        {p && p.state !== "empty" && (
          <div class="facts-row">
            <Fact label={t.samples} value={t.of(brief(p.samples), brief(p.samples_wanted))} />
            <Fact label={t.time} value={duration(p.seconds)} />
            {p.state === "rendering" && <Fact label={t.left} value={p.seconds_left === null ? "–" : duration(p.seconds_left)} />}
            <Fact label={t.error} value={p.error === null ? "–" : percent(p.error)} />
            <Fact label={t.rate} value={t.perSecond(brief(p.samples_per_second, 3))} />
            {p.bad_samples > 0 && <Fact label={t.bad} value={String(p.bad_samples)} />}
          </div>
        )}
        {(!p || p.state === "empty") && <span class="spring" />}
        <button type="button" class="button" aria-expanded={open.value} aria-controls="control-more" onClick={toggle}>
          {t.details}
          {queue.value.entries.length > 0 && <span class="badge">{queue.value.entries.length}</span>}
        </button>
      </div>
      {p && p.errors.length > 0 && (
        <p class="wrong" role="alert">
          {p.errors.map((e) => e.message).join(" ")}
        </p>
      )}
      {open.value && (
        <div id="control-more" class="control-more">
          <Goals />
          <div class="curve-box">
            <h2 class="small">{t.course}</h2>
            <ErrorCurve />
          </div>
          <QueueView />
          <TasksView />
        </div>
      )}
    </section>
  );
}

function Fact({ label, value }: { label: string; value: string }): JSX.Element {
  return (
    <span class="fact">
      <span class="dim">{label}</span> {value}
    </span>
  );
}

/** How far to go, for this session; and which algorithm, which stands in the document. */
function Goals(): JSX.Element {
  const samples = useSignal("");
  const time = useSignal("");
  const error = useSignal("");
  const job = root.value === null ? undefined : components.value.get(root.value);
  const value = job?.members.renderer?.value;
  const renderer = isUse(value) ? components.value.get(value.component) : undefined;
  const set = async (): Promise<void> => {
    const read = (text: string): number | null => (text.trim() === "" ? null : Number(text));
    const [s, seconds, e] = [read(samples.value), read(time.value), read(error.value)];
    if ([s, seconds, e].some((n) => n !== null && !(n > 0))) return report(t.notPositive);
    try {
      await demand("goals", { samples: s, time: seconds, error: e === null ? null : e / 100 });
    } catch (problem) {
      report(problem);
    }
  };
  const field = (label: string, signal: typeof samples, placeholder: string): JSX.Element => (
    <label class="inline">
      <span>{label}</span>
      <input type="number" min={0} step="any" class="narrow" placeholder={placeholder} value={signal.value} disabled={readOnly.value}
        onInput={(e) => (signal.value = e.currentTarget.value)} onChange={() => void set()} />
    </label>
  );
  return (
    <div class="goals">
      <h2 class="small">{t.goals}</h2>
      {renderer && job && (
        <div class="reference">
          <button type="button" class="go" onClick={() => select(renderer.id)}>{renderer.name ?? renderer.class}</button>
          <Button label={t.otherAlgorithm} disabled={locked.value !== null}
            onClick={() => (choosing.value = { what: "replace", component: renderer, use: { id: job.id, member: "renderer" } })} />
        </div>
      )}
      {field(t.goalSamples, samples, brief(progress.value?.samples_wanted ?? 0))}
      {field(t.goalTime, time, t.asWritten)}
      {field(t.goalError, error, t.asWritten)}
      <p class="dim">{t.goalsHelp}</p>
      <div class="cluster wrap">
        <Button icon="save" text label={t.saveState} disabled={readOnly.value || !progress.value?.samples} onClick={() => void saveState()} />
        <Button icon="open" text label={t.loadState} disabled={readOnly.value || root.value === null} onClick={() => void loadState()} />
      </div>
    </div>
  );
}
