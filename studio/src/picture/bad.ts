// Samples that were no light (not numbers, infinite) never reach the picture: the program counts them, and says where they were.
import { computed, effect, signal } from "@preact/signals";
import { line, progress } from "../model/state.ts";
import { demand } from "../model/studio.ts";

export interface BadSample {
  x: number;
  y: number;
  sample: number;
  kind: string;
}

export const badMarks = signal<BadSample[]>([]);

/** Which bad samples there are: other ones when one of these has changed. */
const version = computed(() => `${progress.value?.generation ?? 0} ${progress.value?.bad_samples ?? 0}`);
let timer = 0;

effect(() => {
  void version.value;
  clearTimeout(timer);
  if (!progress.peek()?.bad_samples) {
    badMarks.value = [];
    return;
  }
  timer = window.setTimeout(() => void look(), 500); // they come in numbers: not for each anew
});

async function look(): Promise<void> {
  if (line.peek() !== "open") return;
  try {
    badMarks.value = (await demand<{ samples: BadSample[] }>("bad_samples")).samples;
  } catch {
    badMarks.value = []; // there is no picture any more
  }
}
