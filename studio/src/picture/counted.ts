// What is counted of all pixels, anew when they change, but at most three times a second.
import { type Signal, useSignal, useSignalEffect } from "@preact/signals";
import { useRef } from "preact/hooks";
import { pixelsVersion, shownFilm } from "./store.ts";

type Film = NonNullable<typeof shownFilm.value>;

export function useCounted<T>(count: (film: Film) => T): Signal<T | null> {
  const counted = useSignal<T | null>(null);
  const last = useRef({ at: 0, timer: 0 });
  useSignalEffect(() => {
    void pixelsVersion.value;
    const now = shownFilm.value;
    if (!now) return;
    clearTimeout(last.current.timer);
    const wait = Math.max(0, last.current.at + 300 - performance.now());
    last.current.timer = window.setTimeout(() => {
      last.current.at = performance.now();
      counted.value = count(now);
    }, wait);
  });
  return counted;
}
