// Brings what the program says into the page's state, and asks the program for what people do.
import { Classes } from "./classes.ts";
import { Connection } from "./connection.ts";
import { Refused } from "./protocol.ts";
import type { Component, DocumentState, Event, Hello, Notice, Progress, Queue, Reply, SideRender, Task, TextChange, TextState, TreeState, WorkingEvent } from "./protocol.ts";
import * as state from "./state.ts";
import { texts } from "../texts/texts.ts";

type TextListener = (text: TextState) => void;
const textListeners = new Set<TextListener>();
let latestText: TextState = { revision: 0, text: "" };
const eventListeners = new Map<string, Set<(event: Event) => void>>();
/** What to ask again after the line was lost. */
let watched: Record<string, unknown> = { what: "linear" };

/** Stores the pictures whose pixels the program sends. */
export interface PictureStore {
  takePixels: (message: ArrayBuffer) => void;
  /** Pixels of another document, or of another layer, follow. */
  forgetPictures: () => void;
}
let pictureStore: PictureStore | null = null;

const protocol = location.protocol === "https:" ? "wss" : "ws";
export const connection = new Connection(`${protocol}://${location.host}/socket${location.search}`, {
  opened: () => void hello(),
  line: (line) => {
    state.line.value = line;
    if (line !== "open") state.working.value = null;
  },
  event: take,
  pixels: (message) => pictureStore?.takePixels(message),
});

/** Connects to the program. */
export function connect(store: PictureStore): void {
  pictureStore = store;
  connection.connect();
}

/** Says who is here, and takes all there is to know. */
export async function hello(): Promise<void> {
  try {
    const said = await connection.ask<Hello & Reply>("hello", { protocol: 1 });
    state.version.value = said.version;
    state.readOnly.value = said.read_only;
    state.browser.value = said.browser;
    state.classes.value = new Classes(said.classes);
    state.units.value = said.units;
    state.functions.value = said.functions;
    state.knownNames.value = said.names;
    state.folders.value = said.folders;
    state.document_.value = said.document;
    takeText(said.text);
    if (said.tree) takeTree(said.tree);
    takeProgress(said.progress);
    state.queue.value = said.queue;
    state.renders.value = said.renders ?? [];
    state.viewing.value = said.viewing ?? false;
    state.pictures.value = said.pictures ?? [];
    if (state.viewing.value && state.pictures.value[0] && watched.layer === undefined) watched = { what: "linear", layer: pictureLayer(state.pictures.value[0].name) };
    await connection.ask("watch", watched);
    for (const more of sides.values()) await connection.ask("watch", more);
  } catch (error) {
    report(error);
  }
}

function take(event: Event): void {
  switch (event.event) {
    case "document":
      state.document_.value = event as unknown as DocumentState;
      if (!state.document_.value.valid) clearTree();
      break;
    case "text":
      if (event.text !== undefined) pictureStore?.forgetPictures(); // another document
      takeText(event as unknown as TextState);
      break;
    case "tree":
      takeTree(event as unknown as TreeState);
      if (!state.classes.value.describe(state.components.value.values())) void hello(); // a plugin has brought or changed classes
      break;
    case "progress":
      takeProgress(event as unknown as Progress);
      break;
    case "working":
      takeWorking(event as unknown as WorkingEvent);
      break;
    case "queue":
      state.queue.value = event as unknown as Queue;
      break;
    case "renders":
      state.renders.value = (event as unknown as { renders: SideRender[] }).renders;
      break;
    case "task":
      takeTask(event as unknown as Task);
      break;
    case "notice":
      state.notify((event as unknown as Notice).text, (event as unknown as Notice).kind);
      break;
    case "goodbye":
      connection.end();
      break;
  }
  for (const listener of eventListeners.get(event.event) ?? []) listener(event);
}

/** Calls `listener` for every event of this name; gives what ends that. */
export function onEvent(name: string, listener: (event: Event) => void): () => void {
  const listeners = eventListeners.get(name) ?? new Set();
  eventListeners.set(name, listeners.add(listener));
  return () => listeners.delete(listener);
}

function takeText(text: TextState): void {
  if (text.text !== undefined) latestText = { ...text };
  else if (text.changes && text.revision === latestText.revision + 1 && fits(text.changes, latestText.text ?? "")) {
    let whole = latestText.text ?? "";
    for (const { begin, end, insert } of [...text.changes].sort((a, b) => b.begin - a.begin)) {
      whole = whole.slice(0, begin) + insert + whole.slice(end);
    }
    latestText = { revision: text.revision, text: whole };
  } else if (text.changes && text.revision > latestText.revision) {
    void hello(); // something was missed
    return;
  }
  if (text.draft !== undefined) latestText.draft = text.draft;
  for (const listener of textListeners) listener(text);
}

/** Whether changes can be of this text; if not, something was missed. */
function fits(changes: TextChange[], whole: string): boolean {
  return changes.every(({ begin, end }) => begin >= 0 && begin <= end && end <= whole.length);
}

/** The text as it is now and every change after it. */
export function followText(listener: TextListener): () => void {
  textListeners.add(listener);
  listener(latestText);
  return () => textListeners.delete(listener);
}

export function textNow(): { revision: number; text: string } {
  return { revision: latestText.revision, text: latestText.text ?? "" };
}

function clearTree(): void {
  state.root.value = null;
  state.components.value = new Map();
  state.names.value = [];
}

function takeTree(tree: TreeState): void {
  if (tree.components) {
    state.components.value = new Map(Object.values(tree.components).map((c): [number, Component] => [c.id, c]));
    state.root.value = tree.root ?? null;
    if (tree.names) state.names.value = tree.names;
    const chosen = state.selected.value;
    if (chosen !== null && !state.components.value.has(chosen)) state.selected.value = null;
  } else if (tree.update) {
    const updated = new Map(state.components.value);
    for (const component of Object.values(tree.update)) updated.set(component.id, component);
    state.components.value = updated;
  }
}

function takeProgress(progress: Progress): void {
  const before = state.errorCourse.value;
  let course = before.generation === progress.generation ? before : { generation: progress.generation, seconds: [], errors: [] };
  const last = course.seconds[course.seconds.length - 1] ?? -1;
  if (progress.error !== null && progress.error > 0 && progress.seconds > last) {
    course = { ...course, seconds: [...course.seconds, progress.seconds], errors: [...course.errors, progress.error] };
    if (course.seconds.length > 600) {
      const kept = (_: number, i: number): boolean => i % 2 === 0;
      course = { ...course, seconds: course.seconds.filter(kept), errors: course.errors.filter(kept) };
    }
  }
  if (course !== before) state.errorCourse.value = course;
  state.progress.value = progress;
}

function takeWorking({ what, file, seconds }: WorkingEvent): void {
  state.working.value = what === null ? null : { what, file: file ?? null, begun: performance.now() - 1000 * (seconds ?? 0) };
}

function takeTask(task: Task): void {
  const before = state.tasks.value.find((t) => t.task === task.task);
  state.tasks.value = before ? state.tasks.value.map((t) => (t === before ? { ...t, ...task } : t)) : [...state.tasks.value, task].slice(-12);
}

/** Shows why something could not be done. */
export function report(error: unknown): void {
  if (error instanceof Refused) state.notify(error.message, "error");
  else if (error instanceof Error && error.message === "offline") state.notify(texts.notices.offline, "warning");
  else state.notify(String(error), "error");
}

/** Asks; what is refused is shown, and gives null. */
export async function ask<T = Reply>(what: string, with_: Record<string, unknown> = {}): Promise<T | null> {
  try {
    return await connection.ask<T>(what, with_);
  } catch (error) {
    report(error);
    return null;
  }
}

/** Asks; throws what is refused. */
export function demand<T = Reply>(what: string, with_: Record<string, unknown> = {}): Promise<T> {
  return connection.ask<T>(what, with_);
}

/** The layer by which a picture that is pinned, or viewed, is watched. */
export function pictureLayer(name: string): string {
  return `pin:${name}`;
}

/** What is watched beside the picture, by slot. */
const sides = new Map<number, Record<string, unknown>>();

/** Watches another render, or a layer, in a slot from 1 on; null: no longer. */
export function watchSide(slot: number, of: { render: number } | { layer: string } | null): void {
  const what = { slot, ...(of === null ? { what: "none" } : { what: "linear", ...of }) };
  if (of === null) sides.delete(slot);
  else sides.set(slot, what);
  if (state.line.value === "open") void ask("watch", what);
}

export function watch(what: Record<string, unknown>): void {
  if (JSON.stringify(watched) === JSON.stringify(what)) return;
  if (watched.layer !== what.layer) pictureStore?.forgetPictures();
  watched = what;
  if (state.line.value === "open") void ask("watch", what);
}
