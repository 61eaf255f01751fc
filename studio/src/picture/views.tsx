// Saved views: cameras in the text that have names, and that nothing uses until one goes to them.
import { signal, useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect } from "preact/hooks";
import type { SavedView } from "../model/protocol.ts";
import { document_, locked } from "../model/state.ts";
import { ask, demand } from "../model/studio.ts";
import { Icon } from "../parts/icons.tsx";
import { Button } from "../parts/parts.tsx";
import { guarded } from "../parts/guarded.tsx";
import { texts } from "../texts/texts.ts";
import { cameraMoved } from "./camera.ts";

const t = texts.views;
const views = signal<SavedView[]>([]);

async function load(): Promise<void> {
  try {
    views.value = (await demand<{ views: SavedView[] }>("views")).views.filter((v) => !v.used);
  } catch {
    views.value = []; // there is no document
  }
}

export function Views(): JSX.Element {
  const name = useSignal("");
  const open = useSignal(false);
  const off = locked.value !== null;
  const revision = document_.value?.revision;
  // They stand in the text, so every edit may bring or take one.
  useEffect(() => {
    if (open.value) void load();
  }, [open.value, revision]);
  const save = async (event: Event): Promise<void> => {
    event.preventDefault();
    const given = name.value.trim();
    if (!given) return;
    await cameraMoved();
    if (await guarded("save_view", { name: given }, { over: true }, "changed_on_disk", texts.top.exists(given), texts.top.over)) name.value = "";
  };
  return (
    <details class="drop" onToggle={(e) => (open.value = e.currentTarget.open)}>
      <summary class="button square" aria-label={t.title} title={t.title}>
        <Icon name="Camera" />
      </summary>
      <div class="drop-content">
        <ul class="plain scroll" aria-label={t.title}>
          {views.value.map((v) => (
            <li key={v.name} class="cluster">
              <Button icon="Camera" text label={v.name} disabled={off} onClick={() => void cameraMoved().then(() => ask("use_view", { name: v.name }))} />
              <span class="spring" />
              <Button icon="remove" label={t.remove(v.name)} disabled={off} onClick={() => void ask("remove_view", { name: v.name })} />
            </li>
          ))}
          {views.value.length === 0 && <li class="dim">{t.none}</li>}
        </ul>
        <form class="cluster" onSubmit={(e) => void save(e)}>
          <input type="text" aria-label={t.name} placeholder={t.name} spellcheck={false} value={name.value} disabled={off} onInput={(e) => (name.value = e.currentTarget.value)} />
          <button type="submit" class="button" disabled={off}>{t.save}</button>
        </form>
      </div>
    </details>
  );
}
