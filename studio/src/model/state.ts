// What the page knows, as signals: whoever reads one is drawn again when it changes. Only studio.ts writes what comes from the program.
import { batch, computed, signal } from "@preact/signals";
import { Classes } from "./classes.ts";
import type { Line } from "./connection.ts";
import type { Component, DocumentState, Name, Notice, PictureInfo, Progress, Queue, SideRender, Task, Unit, Use } from "./protocol.ts";

export const line = signal<Line>("connecting");
export const readOnly = signal(false);
export const version = signal("");
export const browser = signal(0);
export const classes = signal(new Classes([]));
export const units = signal<Unit[]>([]);
export const functions = signal<{ name: string; usage: string }[]>([]);
export const knownNames = signal<{ illuminants: string[]; glasses: string[]; metals: string[]; sensors: string[]; rgb_spaces: string[] }>({
  illuminants: [],
  glasses: [],
  metals: [],
  sensors: [],
  rgb_spaces: [],
});
export const folders = signal<string[]>([]);

export const document_ = signal<DocumentState | null>(null);
/** What takes the program long: by which request, of which file, and when it was begun, as `performance.now` counts. */
export interface Working {
  what: string;
  file: string | null;
  begun: number;
}
export const working = signal<Working | null>(null);
/** Another document is being read. */
export const opening = computed(() => working.value?.what === "open");
export const root = signal<number | null>(null);
export const components = signal<ReadonlyMap<number, Component>>(new Map());
export const names = signal<Name[]>([]);
export const progress = signal<Progress | null>(null);
export const renders = signal<SideRender[]>([]);
/** `etendue view`: pictures without a document. */
export const viewing = signal(false);
export const pictures = signal<PictureInfo[]>([]);
/** What runs in processes of its own, the newest last. */
export const tasks = signal<Task[]>([]);
export const queue = signal<Queue>({ running: false, entries: [] });

/** The course of the error: seconds and relative standard error, since the film was begun. */
export const errorCourse = signal<{ generation: number; seconds: number[]; errors: number[] }>({ generation: -1, seconds: [], errors: [] });

export interface Shown extends Notice {
  key: number;
}
export const notices = signal<Shown[]>([]);

export type Tab = "picture" | "text" | "paths" | "sides";
export const tab = signal<Tab>("picture");
export const selected = signal<number | null>(null);
/** In which of its places the selected component is meant; null: the first. */
export const selectedUse = signal<Use | null>(null);

export const selectedComponent = computed<Component | null>(() => {
  const id = selected.value ?? root.value;
  return (id !== null && components.value.get(id)) || null;
});

/** The place that is meant of the selected component. */
export const placeOfSelected = computed<Use | null>(() => {
  const component = selectedComponent.value;
  const wanted = selectedUse.value;
  if (!component) return null;
  const member = (u: Use): boolean => u.id === wanted?.id && u.member === wanted.member;
  return component.uses.find((u) => member(u) && u.index === wanted?.index) ?? component.uses.findLast(member) ?? component.uses[0] ?? null;
});

export function select(id: number | null, use: Use | null = null): void {
  batch(() => {
    selected.value = id;
    selectedUse.value = use;
  });
}

/** Why nothing can be edited, if so. */
export const locked = computed<"read_only" | "draft" | "invalid" | "offline" | "opening" | null>(() => {
  if (line.value !== "open") return "offline";
  if (opening.value) return "opening";
  if (readOnly.value) return "read_only";
  if (document_.value?.draft) return "draft";
  if (document_.value && !document_.value.valid) return "invalid";
  return null;
});

let lastNotice = 0;

/** Shows words in a corner; errors stay until they are closed. */
export function notify(text: string, kind: Notice["kind"] = "info"): void {
  const key = ++lastNotice;
  notices.value = [...notices.value.filter((n) => n.text !== text), { text, kind, key }].slice(-4);
  if (kind !== "error") setTimeout(() => dismiss(key), 6000);
}

export function dismiss(key: number): void {
  notices.value = notices.value.filter((n) => n.key !== key);
}
