// Edits of members from panels: what is wrong is shown at the field; a slider that is dragged sends no more than the program takes.
import { signal } from "@preact/signals";
import { Refused } from "../model/protocol.ts";
import { demand } from "../model/studio.ts";
import { texts } from "../texts/texts.ts";

/** What is wrong with the last edit of a member, by `key`. */
export const wrong = signal<ReadonlyMap<string, string>>(new Map());

export const key = (component: number, member: string, index?: number): string => `${component}.${member}${index === undefined ? "" : `.${index}`}`;

function setWrong(at: string, message: string | null): void {
  if (message === null && !wrong.value.has(at)) return;
  const next = new Map(wrong.value);
  if (message === null) next.delete(at);
  else next.set(at, message);
  wrong.value = next;
}

interface Kept {
  component: number;
  member: string;
  index?: number;
  text: string;
}

/** What was refused stays in its field, by `key`: values that are valid only together are typed one after another. */
export const kept = signal<ReadonlyMap<string, Kept>>(new Map());

function keep(at: string, what: Kept | null): void {
  if (what === null && !kept.value.has(at)) return;
  const next = new Map(kept.value);
  if (what === null) next.delete(at);
  else next.set(at, what);
  kept.value = next;
}

export function forgetWrong(): void {
  if (wrong.value.size) wrong.value = new Map();
  if (kept.value.size) kept.value = new Map();
}

/** Drops what was refused of a member: its field shows what holds. */
export function dropKept(component: number, member: string, index?: number): void {
  keep(key(component, member, index), null);
  setWrong(key(component, member, index), null);
}

/** Edits of members that the program has not answered yet. */
export const unanswered = signal(0);

async function answered<T>(edit: Promise<T>): Promise<T> {
  ++unanswered.value;
  try {
    return await edit;
  } finally {
    --unanswered.value;
  }
}

/** Sets a member; with what was refused before if both together are valid, in one step of undo. */
export function setMember(component: number, member: string, text: string, more: { index?: number; merge?: string } = {}): Promise<boolean> {
  return answered(set(component, member, text, more));
}

async function set(component: number, member: string, text: string, more: { index?: number; merge?: string }): Promise<boolean> {
  const at = key(component, member, more.index);
  const before = [...kept.value].filter(([k, e]) => k !== at && e.component === component);
  const one = { component, member, text, ...(more.index === undefined ? {} : { index: more.index }) };
  if (before.length && !more.merge) {
    try {
      await demand("edits", { edits: [...before.map(([, edit]) => edit), one] });
      for (const done of [at, ...before.map(([k]) => k)]) {
        keep(done, null);
        setWrong(done, null);
      }
      return true;
    } catch {
      // then it is tried alone
    }
  }
  try {
    await demand("edit", { ...one, ...more });
    keep(at, null);
    setWrong(at, null);
    return true;
  } catch (error) {
    if (error instanceof Refused && !more.merge) keep(at, one);
    setWrong(at, error instanceof Refused ? error.message : texts.notices.offline);
    return false;
  }
}

export function resetMember(component: number, member: string): Promise<void> {
  return answered(reset(component, member));
}

async function reset(component: number, member: string): Promise<void> {
  keep(key(component, member), null);
  try {
    await demand("reset", { component, member });
    setWrong(key(component, member), null);
  } catch (error) {
    setWrong(key(component, member), error instanceof Refused ? error.message : texts.notices.offline);
  }
}

let drags = 0;
const sending = new Set<Promise<void>>();

/** What was dragged is with the program after this: what undoes it, or saves, comes behind it. */
export async function dragged(): Promise<void> {
  await Promise.all(sending);
}

/** Edits while something is dragged: one at a time, the newest value next, all of them one step of undo. */
export class Dragging {
  private readonly merge = `drag ${Date.now()} ${++drags}`;
  private waiting: string | null = null;
  private busy = false;

  constructor(
    private readonly component: number,
    private readonly member: string,
    private readonly index?: number,
  ) {}

  set(text: string): void {
    this.waiting = text;
    if (this.busy) return;
    const sent = this.send().finally(() => sending.delete(sent));
    sending.add(sent);
  }

  private async send(): Promise<void> {
    this.busy = true;
    while (this.waiting !== null) {
      const text = this.waiting;
      this.waiting = null;
      await setMember(this.component, this.member, text, { merge: this.merge, ...(this.index === undefined ? {} : { index: this.index }) });
    }
    this.busy = false;
  }
}
