// Files that are rendered one after another, to the pictures they name.
import type { JSX } from "preact";
import { queue, readOnly } from "../model/state.ts";
import { ask } from "../model/studio.ts";
import { percent } from "../model/numbers.ts";
import { Button } from "../parts/parts.tsx";
import { chooseFile } from "../files/browser.tsx";
import { texts } from "../texts/texts.ts";

const t = texts.queue;

export function QueueView(): JSX.Element {
  const { running, entries } = queue.value;
  const add = async (): Promise<void> => {
    const file = await chooseFile({ title: t.add, endings: [".etd", ".json"] });
    if (file) await ask("queue", { add: [file] });
  };
  return (
    <div class="queue">
      <h2 class="small">{t.title}</h2>
      <ul class="plain scroll">
        {entries.map((e) => (
          <li key={e.entry} class={`queue-${e.state}`}>
            <span class="what" title={e.errors.map((p) => p.message).join("\n") || e.file}>{e.file.split("/").pop()}</span>
            <span class="dim">{e.state === "rendering" ? percent(e.fraction) : t.states[e.state]}</span>
            <Button icon="close" label={t.remove(e.file.split("/").pop() ?? "")} disabled={readOnly.value} onClick={() => void ask("queue", { remove: e.entry })} />
          </li>
        ))}
        {entries.length === 0 && <li class="dim">{t.empty}</li>}
      </ul>
      <div class="cluster">
        <Button icon="add" text label={t.add} disabled={readOnly.value} onClick={() => void add()} />
        {running ? (
          <Button icon="stop" text label={t.stop} disabled={readOnly.value} onClick={() => void ask("queue", { stop: true })} />
        ) : (
          <Button icon="play" text label={t.start} disabled={readOnly.value || entries.length === 0} onClick={() => void ask("queue", { start: true })} />
        )}
      </div>
    </div>
  );
}
