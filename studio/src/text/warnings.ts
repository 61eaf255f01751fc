// What a render of the text would warn of: asked for when the text rests and is looked at, since the whole scene is looked through for it.
import { effect, signal } from "@preact/signals";
import type { Problem } from "../model/protocol.ts";
import { document_, line, tab } from "../model/state.ts";
import { demand } from "../model/studio.ts";

export const warnings = signal<Problem[]>([]);
let asked = -1;
let timer = 0;

effect(() => {
  const now = document_.value;
  clearTimeout(timer);
  if (!now?.valid || now.draft || tab.value !== "text" || line.value !== "open" || now.revision === asked) return;
  timer = window.setTimeout(() => void look(now.revision), 600);
});

async function look(revision: number): Promise<void> {
  try {
    const said = await demand<{ warnings: Problem[] }>("warnings");
    if (document_.peek()?.revision !== revision) return;
    asked = revision;
    warnings.value = said.warnings;
  } catch {
    warnings.value = []; // what is wrong with the text is told where it was typed
  }
}
