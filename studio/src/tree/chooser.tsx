// The window in which a class is chosen: all that may stand in a place, with what they are and their members.
import { useComputed, useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { ownGroupsFirst, type ClassInfo } from "../model/classes.ts";
import type { Use } from "../model/protocol.ts";
import { classes, components, names } from "../model/state.ts";
import { Button, Dialog } from "../parts/parts.tsx";
import { inline } from "../parts/markdown.tsx";
import { texts } from "../texts/texts.ts";
import * as actions from "./actions.ts";
import { slots } from "./rows.ts";

const t = texts.chooser;
export function Chooser(): JSX.Element | null {
  const choice = actions.choosing.value;
  if (!choice) return null;
  const component = components.value.get(choice.component.id) ?? choice.component;
  return <ChooserFor key={component.id} what={choice.what} id={component.id} use={choice.use} member={choice.member} />;
}

function ChooserFor({ what, id, use, member }: { what: "add" | "replace"; id: number; use: Use | null; member?: string }): JSX.Element | null {
  const component = components.value.get(id);
  const search = useSignal("");
  const chosen = useSignal("");
  const slotAt = useSignal(0);
  const onlyHere = useSignal(false);
  const close = (): void => {
    actions.choosing.value = null;
  };
  const all = component && what === "add" ? slots(component, use, components.value, classes.value) : [];
  const places = member ? all.filter((s) => s.component === component && s.member.name === member) : all;
  const slot = places[slotAt.value] ?? places[0];
  const parent = use ? components.value.get(use.id) : undefined;
  const wanted = what === "add" ? slot?.member.class : parent && use ? classes.value.member(parent.class, use.member)?.class : component?.class;
  const offered = useComputed(() => (search.value, classes.value));
  const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
  // What is called so comes before what is only told of so.
  const list = (wanted ? offered.value.offered(wanted) : [])
    .filter((c) => words.every((w) => `${c.name} ${c.summary}`.toLowerCase().includes(w)))
    .sort((a, b) => rank(b.name, words[0]) - rank(a.name, words[0]));
  const named = names.value.filter((n) => n.component !== id && matchesName(n.component, wanted ?? ""));
  const takeNamed = (name: string, shared: number | null): void => {
    close();
    if (what === "add" && slot) void actions.add(slot.component.id, slot.member.name, { text: name }, slot.index);
    else if (use && shared !== null) void actions.share(use, shared);
  };
  const info = list.find((c) => c.name === chosen.value) ?? list[0];
  if (!component) return null;

  const take = (): void => {
    if (!info) return;
    close();
    if (what === "add" && slot) void actions.add(slot.component.id, slot.member.name, { class: info.name }, slot.index);
    else if (what === "replace") void actions.replace(component, info.name, onlyHere.value ? use : null);
  };
  const key = (event: KeyboardEvent): void => {
    const at = list.findIndex((c) => c === info);
    const by = { ArrowDown: 1, ArrowUp: -1, PageDown: 10, PageUp: -10 }[event.key];
    if (by !== undefined) {
      chosen.value = list[Math.min(list.length - 1, Math.max(0, at + by))]?.name ?? "";
      document.getElementById(`class-${chosen.value}`)?.scrollIntoView({ block: "nearest" });
    } else if (event.key === "Enter") take();
    else return;
    event.preventDefault();
  };

  return (
    <Dialog title={what === "add" ? t.add(component.name ?? component.class) : t.replace(component.name ?? component.class)} close={close} class="chooser">
      {what === "add" && (
        <label class="inline">
          <span>{t.where}</span>
          <select value={slotAt.value} onChange={(e) => (slotAt.value = Number(e.currentTarget.value))}>
            {places.map((p, i) => (
              <option key={i} value={i}>
                {t.place(p.component.name ?? p.component.class, p.member.name, p.index)}
              </option>
            ))}
          </select>
        </label>
      )}
      {what === "add" && places.length === 0 ? (
        <p class="empty-note">{t.noPlace}</p>
      ) : (
        <div class="columns">
          <div class="column list">
            <input
              type="search" data-focus placeholder={t.search(list.length)} aria-label={t.search(list.length)} role="combobox" aria-expanded="true"
              aria-controls="classes" aria-activedescendant={info ? `class-${info.name}` : undefined} value={search.value}
              onInput={(e) => (search.value = e.currentTarget.value)} onKeyDown={key}
            />
            <div id="classes" role="listbox" aria-label={t.classes} tabIndex={-1}>
              {list.map((c) => (
                <div
                  key={c.name} id={`class-${c.name}`} role="option" aria-selected={c === info} class="class-option"
                  onClick={() => (chosen.value = c.name)} onDblClick={take}
                >
                  <b>{c.name}</b>
                  <span>{c.summary}</span>
                </div>
              ))}
              {list.length === 0 && <p class="empty-note">{t.none}</p>}
            </div>
          </div>
          <div class="column page" tabIndex={0} role="region" aria-label={t.page}>
            {info && <Page info={info} />}
          </div>
        </div>
      )}
      {named.length > 0 && (slot || use) && (
        <div class="cluster wrap">
          <span class="dim">{t.orShared}</span>
          {named.slice(0, 12).map((n) => (
            <Button key={n.name} icon="link" text label={n.name} onClick={() => takeNamed(n.name, n.component)} />
          ))}
        </div>
      )}
      <footer>
        {what === "replace" && component.uses.length > 1 && (
          <label class="check">
            <input type="checkbox" checked={onlyHere.value} onChange={(e) => (onlyHere.value = e.currentTarget.checked)} />
            {t.onlyHere(component.uses.length)}
          </label>
        )}
        <Button label={texts.common.cancel} onClick={close} />
        <Button primary label={what === "add" ? t.addIt : t.replaceIt} disabled={!info} onClick={take} />
      </footer>
    </Dialog>
  );
}

function rank(name: string, word = ""): number {
  const lower = name.toLowerCase();
  return lower === word ? 3 : lower.startsWith(word) ? 2 : lower.includes(word) ? 1 : 0;
}

function matchesName(id: number | null, wanted: string): boolean {
  const component = id === null ? undefined : components.value.get(id);
  return component !== undefined && classes.value.isA(component.class, wanted);
}

function Page({ info }: { info: ClassInfo }): JSX.Element {
  return (
    <>
      <h3>{info.name}</h3>
      <p>{inline(info.summary)}</p>
      {info.source && <p class="dim">{info.source}</p>}
      {ownGroupsFirst(info).map((g) => (
        <section key={g.name}>
          {g.name && <h4>{g.name}</h4>}
          <dl class="members">
            {g.members.map((m) => (
              <div key={m.name}>
                <dt>
                  <code>{m.name}</code> <span class="dim">{m.class ?? m.type}{m.unit ? `, ${m.unit}` : ""}</span>
                </dt>
                <dd>{inline(m.text)}</dd>
              </div>
            ))}
          </dl>
        </section>
      ))}
    </>
  );
}

export function Renaming(): JSX.Element | null {
  const component = actions.renaming.value;
  return component ? <RenamingOf key={component.id} id={component.id} name={component.name} shared={component.uses.length > 1} /> : null;
}

function RenamingOf({ id, name, shared }: { id: number; name: string | null; shared: boolean }): JSX.Element {
  const value = useSignal(name ?? "");
  const close = (): void => {
    actions.renaming.value = null;
  };
  const submit = async (event: Event): Promise<void> => {
    event.preventDefault();
    const component = components.value.get(id);
    if (component && (await actions.rename(component, value.value.trim() || null))) close();
  };
  return (
    <Dialog title={t.rename} close={close}>
      <form onSubmit={(e) => void submit(e)}>
        <label class="stack">
          <span>{t.name}</span>
          <input type="text" data-focus spellcheck={false} value={value.value} onInput={(e) => (value.value = e.currentTarget.value)} />
        </label>
        <p class="dim">{shared ? t.renameShared : t.renameHelp}</p>
        <footer>
          <Button label={texts.common.cancel} onClick={close} />
          <button type="submit" class="button primary">{t.rename}</button>
        </footer>
      </form>
    </Dialog>
  );
}

/** Chooses with which other component a place is to be shared. */
export function Sharing(): JSX.Element | null {
  const what = actions.sharing.value;
  if (!what) return null;
  const close = (): void => {
    actions.sharing.value = null;
  };
  const parent = components.value.get(what.use.id);
  const wanted = parent ? (classes.value.member(parent.class, what.use.member)?.class ?? "") : "";
  const others = [...components.value.values()].filter(
    (c) => c.id !== what.component.id && c.written === "text" && classes.value.isA(c.class, wanted) && c.uses.length > 0,
  );
  return (
    <Dialog title={t.share(what.component.name ?? what.component.class)} close={close}>
      <p class="dim">{t.shareHelp}</p>
      <ul class="plain scroll">
        {others.map((c) => (
          <li key={c.id}>
            <Button icon="link" text label={`${c.name ?? c.class}${c.name ? ` (${c.class})` : ` ${t.number(c.id)}`}`} onClick={() => (close(), void actions.share(what.use, c.id))} />
          </li>
        ))}
      </ul>
      {others.length === 0 && <p class="empty-note">{t.nothingToShare}</p>}
      <footer>
        <Button label={texts.common.cancel} onClick={close} />
      </footer>
    </Dialog>
  );
}
