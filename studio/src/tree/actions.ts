// What can be done to a component in the tree.
import { signal } from "@preact/signals";
import { chooseFile, relative } from "../files/browser.tsx";
import { quote } from "../model/expressions.ts";
import { Refused, type Component, type Use } from "../model/protocol.ts";
import { classes, components, notify, placeOfSelected, select, selectedComponent } from "../model/state.ts";
import { ask, demand, report } from "../model/studio.ts";
import { texts } from "../texts/texts.ts";

/** What the window of classes is open for: adding to a component, or replacing one. */
export const choosing = signal<{ what: "add" | "replace"; component: Component; use: Use | null; member?: string } | null>(null);
export const sharing = signal<{ component: Component; use: Use } | null>(null);
export const renaming = signal<Component | null>(null);

interface Made {
  component?: number;
}

const place = (use: Use): Record<string, unknown> => ({ component: use.id, member: use.member, ...(use.index === undefined ? {} : { index: use.index }) });

export async function add(component: number, member: string, what: { class: string } | { text: string }, index?: number): Promise<void> {
  const where = { component, member, ...(index === undefined ? {} : { index }) };
  const made = await orWithFile("class" in what ? what.class : "", () => demand<Made>("add", { ...where, ...what }), (text) => ask<Made>("add", { ...where, text }));
  if (made?.component) select(made.component, { id: component, member, ...(index === undefined ? {} : { index }) });
}

export async function replace(component: Component, className: string, use: Use | null): Promise<void> {
  const at = use ?? component.uses[0];
  const made = await orWithFile(
    className,
    () => demand<Made>("replace", { component: component.id, class: className, ...(use ? { use } : {}) }),
    (text) => (at ? ask<Made>("edit", { ...place(at), text }) : Promise.resolve(null)),
  );
  if (made?.component) select(made.component, use);
}

/** What cannot be without a file is refused: then one is asked for, and it is made with that. */
async function orWithFile(className: string, first: () => Promise<Made>, again: (text: string) => Promise<Made | null>): Promise<Made | null> {
  try {
    return await first();
  } catch (error) {
    const member = classes.value.find(className)?.members.find((m) => m.type === "file" && !m.list);
    const file = member && error instanceof Refused ? await chooseFile({ title: texts.files.choose(`${className}: ${member.name}`) }) : null;
    if (member && file !== null) return again(`${className} { ${member.name}: ${quote(relative(file))} }`);
    report(error);
    return null;
  }
}

export async function remove(): Promise<void> {
  const use = placeOfSelected.value;
  if (!use) return;
  const parent = components.value.get(use.id);
  const done = await ask("remove", place(use));
  if (!done || !parent) return;
  // What stands there now is selected next, so that many can be removed one after another.
  const value = components.value.get(use.id)?.members[use.member]?.value;
  const next = Array.isArray(value) && use.index !== undefined ? value[Math.min(use.index, value.length - 1)] : undefined;
  if (typeof next === "object" && next !== null && "component" in next) {
    select(next.component as number, { ...use, index: Math.min(use.index ?? 0, (value as unknown[]).length - 1) });
  } else select(parent.id);
}

export async function duplicate(): Promise<void> {
  const use = placeOfSelected.value;
  if (use?.index === undefined) return notify(texts.tree.onlyInLists);
  const made = await ask<Made>("duplicate", place(use));
  if (made?.component) select(made.component, { ...use, index: use.index + 1 });
}

export async function moveBy(by: -1 | 1): Promise<void> {
  const use = placeOfSelected.value;
  if (use?.index === undefined) return;
  const list = components.value.get(use.id)?.members[use.member]?.value;
  const to = use.index + by;
  if (!Array.isArray(list) || to < 0 || to >= list.length) return;
  const component = selectedComponent.value;
  if (await ask("move", { ...place(use), to })) select(component?.id ?? null, { ...use, index: to });
}

/** Brings an entry of a list before another entry, of the same list or another one. */
export async function moveTo(use: Use, target: Use): Promise<void> {
  if (use.index === undefined || target.index === undefined) return;
  const same = use.id === target.id && use.member === target.member;
  const to = same && target.index > use.index ? target.index - 1 : target.index;
  if (same && to === use.index) return;
  await ask("move", { ...place(use), to, ...(same ? {} : { component_to: target.id, member_to: target.member }) });
}

/** The list of a component into which what stands in `use` can be dragged: not into itself, nor where it is. */
export function placeInside(use: Use, into: Component): Use | null {
  const value = components.value.get(use.id)?.members[use.member]?.value;
  const entry = Array.isArray(value) && use.index !== undefined ? value[use.index] : undefined;
  const moved = typeof entry === "object" && entry !== null && "component" in entry ? components.value.get(entry.component as number) : undefined;
  if (!moved || into.written !== "text" || into.id === use.id || isInside(into, moved.id)) return null;
  const list = classes.value.find(into.class)?.members.find((m) => m.type === "component" && m.list && classes.value.isA(moved.class, m.class ?? ""));
  const there = list && into.members[list.name]?.value;
  return list ? { id: into.id, member: list.name, index: Array.isArray(there) ? there.length : 0 } : null;
}

/** Whether a component is, or is held by, the one with a number. */
function isInside(component: Component | undefined, id: number): boolean {
  for (let at = component, i = 0; at && i < 1000; ++i) {
    if (at.id === id) return true;
    const use: Use | undefined = at.uses[0];
    at = use && components.value.get(use.id);
  }
  return false;
}

/** What is dropped on a row goes into what stands there, if that has a list for it; else before it. */
export async function drop(use: Use, onto: Component, place: Use | null): Promise<void> {
  const inside = placeInside(use, onto);
  if (inside) await moveTo(use, inside);
  else if (place) await moveTo(use, place);
}

export async function share(use: Use, with_: number): Promise<void> {
  if (await ask("share", { ...place(use), with: with_ })) select(with_, use);
}

export async function unshare(): Promise<void> {
  const use = placeOfSelected.value;
  if (!use) return;
  const made = await ask<Made>("unshare", place(use));
  if (made?.component) select(made.component, use);
}

export async function rename(component: Component, name: string | null): Promise<boolean> {
  return (await ask("rename", { component: component.id, name })) !== null;
}
