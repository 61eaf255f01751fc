// The bar at the top: the document, undo, the render, appearance and help.
import { signal } from "@preact/signals";
import type { JSX } from "preact";
import { chooseFile } from "./files/browser.tsx";
import { document_, line, locked, notify, opening, readOnly, working } from "./model/state.ts";
import { ask } from "./model/studio.ts";
import { Button } from "./parts/parts.tsx";
import { WorkingBadge } from "./parts/working.tsx";
import { RenderButtons } from "./control/control.tsx";
import { guarded, Question } from "./parts/guarded.tsx";
import { settle } from "./text/editor.tsx";
import { texts } from "./texts/texts.ts";
import { isDark, theme } from "./model/theme.ts";

const t = texts.top;
export const helping = signal(false);
export async function newDocument(): Promise<void> {
  await guarded("new", {}, { discard: true }, "busy", t.unsaved, t.discard);
}

export async function openDocument(): Promise<void> {
  const file = await chooseFile({ title: t.open, endings: [".etd", ".json"] });
  if (file) await guarded("open", { file }, { discard: true }, "busy", t.unsaved, t.discard);
}

export async function save(): Promise<void> {
  await settle();
  if (!document_.value?.file) return saveAs();
  if (await guarded("save", {}, { over: true }, "changed_on_disk", t.changedOnDisk, t.over)) notify(t.saved(document_.value.title));
}

export async function saveAs(): Promise<void> {
  const file = await chooseFile({ title: t.saveAs, endings: [".etd", ".json"], save: document_.value?.title.includes(".") ? document_.value.title : "scene.etd" });
  if (file && (await guarded("save", { file }, { over: true }, "changed_on_disk", t.exists(file), t.over))) notify(t.saved(file));
}

export async function undo(): Promise<void> {
  await settle();
  await ask("undo");
}

export async function redo(): Promise<void> {
  await settle();
  await ask("redo");
}

export function TopBar(): JSX.Element {
  const now = document_.value;
  const off = readOnly.value || line.value !== "open" || opening.value;
  return (
    <header class="top" role="banner">
      <h1>
        <span class="brand">Étendue</span>
        <span class="title" title={now?.file ?? t.unnamed}>
          {now?.title ?? working.value?.file?.split("/").pop() ?? ""}
          {now?.changed && <span class="changed" title={t.changed}> •</span>}
        </span>
      </h1>
      <div class="cluster" role="group" aria-label={t.document}>
        <Button icon="new" label={t.new} disabled={off} onClick={() => void newDocument()} />
        <Button icon="open" label={t.open} keys="Ctrl+O" disabled={off} onClick={() => void openDocument()} />
        <Button icon="save" label={t.save} keys="Ctrl+S" disabled={off} onClick={() => void save()} />
        <Button label={t.saveAs} disabled={off} onClick={() => void saveAs()} />
      </div>
      <div class="cluster" role="group" aria-label={t.history}>
        <Button icon="undo" label={now?.undo ? t.undoWhat(now.undo) : t.undo} keys="Ctrl+Z" disabled={off || !now?.undo_count} onClick={() => void undo()} />
        <Button icon="redo" label={now?.redo ? t.redoWhat(now.redo) : t.redo} keys="Ctrl+Shift+Z" disabled={off || !now?.redo_count} onClick={() => void redo()} />
      </div>
      <RenderButtons />
      <span class="spring" />
      <WorkingBadge />
      {locked.value && locked.value !== "opening" && <span class={`lock lock-${locked.value}`} role="status">{t.locked[line.value === "closed" ? "closed" : locked.value]}</span>}
      <Button icon={isDark.value ? "light" : "dark"} label={isDark.value ? t.light : t.dark} onClick={() => (theme.value = isDark.value ? "light" : "dark")} />
      <Button icon="help" label={t.help} keys="F1" onClick={() => (helping.value = true)} />
      <Question />
    </header>
  );
}
