// The window in which a file is chosen, from the folders the program was given.
import { signal, useSignal, useSignalEffect } from "@preact/signals";
import type { JSX } from "preact";
import { Refused } from "../model/protocol.ts";
import { document_, folders, line } from "../model/state.ts";
import { demand } from "../model/studio.ts";
import { Icon } from "../parts/icons.tsx";
import { Button, Dialog } from "../parts/parts.tsx";
import { texts } from "../texts/texts.ts";

const t = texts.files;

export interface Wish {
  title: string;
  endings?: string[];
  /** A name for a file that is to be written. */
  save?: string;
}

const wish = signal<(Wish & { done: (file: string | null) => void }) | null>(null);

/** Gives the whole name of the chosen file, or null. */
export function chooseFile(what: Wish): Promise<string | null> {
  return new Promise((done) => (wish.value = { ...what, done }));
}

function folderOf(file: string): string {
  return file.slice(0, Math.max(1, file.lastIndexOf("/")));
}

/** A file as the document would name it: from its own folder on, where it can. */
export function relative(file: string): string {
  const own = document_.value?.file;
  if (!own) return file;
  const from = folderOf(own).split("/");
  const to = file.split("/");
  let same = 0;
  while (same < from.length && from[same] === to[same]) ++same;
  if (same <= 1) return file;
  return [...from.slice(same).map(() => ".."), ...to.slice(same)].join("/");
}

interface Entry {
  name: string;
  folder: boolean;
  size?: number;
  modified?: string | number;
}

interface Listing {
  folder: string;
  parent: string | null;
  entries: Entry[];
}

let lastFolder: string | null = null;

export function FileBrowser(): JSX.Element | null {
  const what = wish.value;
  return what ? <Browser key={what.title} what={what} done={what.done} /> : null;
}

function Browser({ what, done }: { what: Wish; done: (file: string | null) => void }): JSX.Element {
  const listing = useSignal<Listing | null>(null);
  const problem = useSignal("");
  const chosen = useSignal(what.save ?? "");
  const finish = (file: string | null): void => {
    wish.value = null;
    done(file);
  };
  const go = async (folder: string | null): Promise<void> => {
    try {
      problem.value = "";
      listing.value = await demand<Listing>("files", { ...(folder ? { folder } : {}), ...(what.endings ? { endings: what.endings } : {}) });
      lastFolder = listing.value.folder;
    } catch (error) {
      problem.value = error instanceof Refused ? error.message : texts.notices.offline;
    }
  };
  // At first, and again when the line to the program is back, if it was lost before the folder was read.
  useSignalEffect(() => {
    problem.value = line.value === "open" ? "" : texts.notices.offline;
    if (line.value === "open" && !listing.peek()) {
      const own = document_.peek()?.file;
      void go(lastFolder ?? (own ? folderOf(own) : (folders.peek()[0] ?? null)));
    }
  });
  const full = (name: string): string => (name.startsWith("/") ? name : `${listing.value?.folder ?? ""}/${name}`);
  const take = (entry: Entry): void => {
    if (entry.folder) void go(full(entry.name));
    else if (what.save === undefined) finish(full(entry.name));
    else chosen.value = entry.name;
  };
  const entries = [...(listing.value?.entries ?? [])].sort((a, b) => Number(b.folder) - Number(a.folder) || a.name.localeCompare(b.name));
  return (
    <Dialog title={what.title} close={() => finish(null)} class="browser">
      <div class="cluster">
        <Button icon="up" label={t.up} disabled={!listing.value?.parent} onClick={() => void go(listing.value?.parent ?? null)} />
        <select aria-label={t.folders} value="" onChange={(e) => void go(e.currentTarget.value)}>
          <option value="" disabled>{t.folders}</option>
          {folders.value.map((f) => (
            <option key={f}>{f}</option>
          ))}
        </select>
        <output class="where">{listing.value?.folder}</output>
      </div>
      {problem.value && <p class="wrong" role="alert">{problem.value}</p>}
      <ul class="files" aria-label={t.files}>
        {entries.map((e) => (
          <li key={e.name}>
            <button type="button" class={e.name === chosen.value ? "chosen" : ""} onClick={() => take(e)}>
              <Icon name={e.folder ? "folder" : "file"} />
              <span>{e.name}</span>
              <span class="dim">{e.folder || e.size === undefined ? "" : t.size(e.size)}</span>
            </button>
          </li>
        ))}
        {listing.value && entries.length === 0 && <li class="empty-note">{t.empty}</li>}
      </ul>
      <form
        onSubmit={(e) => {
          e.preventDefault();
          if (chosen.value && listing.value) finish(full(chosen.value));
        }}
      >
        <label class="stack">
          <span>{t.name}</span>
          <input type="text" spellcheck={false} value={chosen.value} onInput={(e) => (chosen.value = e.currentTarget.value)} />
        </label>
        <footer>
          <Button label={texts.common.cancel} onClick={() => finish(null)} />
          <button type="submit" class="button primary" disabled={!chosen.value || !listing.value}>{what.save === undefined ? texts.common.open : texts.common.save}</button>
        </footer>
      </form>
    </Dialog>
  );
}
