// Which tools still have their names beside their icons: each until it was used once, or all until somebody hides them.
import { computed, effect, signal } from "@preact/signals";
import { remember, remembered } from "../model/memory.ts";
import { mode, type Mode } from "./state.ts";

const all: Mode[] = ["look", "pick", "orbit", "fly", "crop", "paths"];
const known = signal<ReadonlySet<string>>(new Set(remembered("tools", "").split(" ").filter(Boolean)));

export const unknownTools = computed<ReadonlySet<Mode>>(() => new Set(all.filter((m) => !known.value.has(m))));

/** They have been used, or need no names any more: in this browser, from now on. */
export function learn(tools: Mode[]): void {
  if (tools.every((m) => known.peek().has(m))) return;
  known.value = new Set([...known.peek(), ...tools]);
  remember("tools", [...known.peek()].join(" "));
}

// Others than its button choose a tool too; the one it begins with was chosen by nobody.
effect(() => {
  if (mode.value !== "look") learn([mode.value]);
});
