// The tree as rows: what is shown of the components, in which order, how deep.
import type { Classes, Member } from "../model/classes.ts";
import type { Component, ComponentUse, Data, Use } from "../model/protocol.ts";

export interface Row {
  component: Component;
  use: Use | null;
  depth: number;
  /** null: it has no children. */
  expanded: boolean | null;
  /** Its place among its siblings, from 1, and how many there are. */
  position: number;
  siblings: number;
}

export function isUse(data: Data | undefined): data is ComponentUse {
  return typeof data === "object" && data !== null && "component" in data && typeof data.component === "number";
}

/** The components that stand in a component's members, with their places. */
export function children(component: Component, all: ReadonlyMap<number, Component>, defaults: boolean): { child: Component; use: Use }[] {
  const found: { child: Component; use: Use }[] = [];
  const take = (data: Data, use: Use): void => {
    const child = isUse(data) ? all.get(data.component) : undefined;
    if (child && (defaults || (child.written !== "default" && child.written !== "literal"))) found.push({ child, use });
  };
  for (const [member, { value }] of Object.entries(component.members)) {
    if (Array.isArray(value)) value.forEach((data, index) => take(data, { id: component.id, member, index }));
    else take(value, { id: component.id, member });
  }
  return found;
}

export interface Wanted {
  /** Opened or closed by hand; others are as `opensByItself` says. */
  opened: ReadonlyMap<number, boolean>;
  defaults: boolean;
  search: string;
}

export function opensByItself(component: Component, classes: Classes): boolean {
  return component.class === "Job" || classes.isA(component.class, "Scene");
}

/** All rows that are seen, from above. With words to search for: every component they are found in, without depth. */
export function rows(root: number | null, all: ReadonlyMap<number, Component>, classes: Classes, wanted: Wanted): Row[] {
  const first = root === null ? undefined : all.get(root);
  if (!first) return [];
  if (wanted.search.trim()) return found(first, all, wanted);
  const result: Row[] = [];
  const visit = (component: Component, use: Use | null, depth: number, position: number, siblings: number): void => {
    const inside = children(component, all, wanted.defaults);
    const expanded = inside.length === 0 ? null : (wanted.opened.get(component.id) ?? opensByItself(component, classes));
    result.push({ component, use, depth, expanded, position, siblings });
    if (expanded) inside.forEach(({ child, use: place }, i) => visit(child, place, depth + 1, i + 1, inside.length));
  };
  visit(first, null, 0, 1, 1);
  return result;
}

function found(first: Component, all: ReadonlyMap<number, Component>, wanted: Wanted): Row[] {
  const words = wanted.search.toLowerCase().split(/\s+/).filter(Boolean);
  const seen = new Set<number>();
  const result: Row[] = [];
  const visit = (component: Component, use: Use | null): void => {
    if (seen.has(component.id)) return;
    seen.add(component.id);
    const text = `${component.name ?? ""} ${component.class} ${use?.member ?? ""}`.toLowerCase();
    if (words.every((w) => text.includes(w))) result.push({ component, use, depth: 0, expanded: null, position: 0, siblings: 0 });
    for (const { child, use: place } of children(component, all, wanted.defaults)) visit(child, place);
  };
  visit(first, null);
  result.forEach((row, i) => {
    row.position = i + 1;
    row.siblings = result.length;
  });
  return result;
}

/** A member that takes components: where something can be added. */
export interface Slot {
  component: Component;
  member: Member;
  /** Behind which entry of a list; undefined: at its end. */
  index?: number;
}

/** Where something can be added to a component, or beside it; what is most likely meant comes first. */
export function slots(component: Component, use: Use | null, all: ReadonlyMap<number, Component>, classes: Classes): Slot[] {
  const own = (classes.find(component.class)?.members ?? []).filter((m) => m.type === "component");
  const lists = own.filter((m) => m.list);
  const empty = own.filter((m) => !m.list && component.members[m.name]?.value === null);
  const rest = own.filter((m) => !m.list && !empty.includes(m));
  const result: Slot[] = lists.map((member) => ({ component, member }));
  const parent = use && all.get(use.id);
  const beside = parent && use.index !== undefined ? classes.member(parent.class, use.member) : undefined;
  if (parent && beside && use.index !== undefined) {
    const slot = { component: parent, member: beside, index: use.index + 1 };
    if (classes.isA(component.class, "Scene")) result.push(slot);
    else result.unshift(slot);
  }
  for (const member of [...empty, ...rest]) result.push({ component, member });
  return result;
}
