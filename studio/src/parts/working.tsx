// What the program is at, when it takes long: a document being read, an edit of a large scene.
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect } from "preact/hooks";
import { duration } from "../model/numbers.ts";
import { document_, line, opening, working, type Working } from "../model/state.ts";
import { texts } from "../texts/texts.ts";

const t = texts.working;
/** What is over sooner is not told. */
const patience = 400;

/** Milliseconds since a moment of `performance.now`, counted on while it is shown. */
function useElapsed(begun: number): number {
  const now = useSignal(performance.now());
  useEffect(() => {
    now.value = performance.now();
    const timer = setInterval(() => (now.value = performance.now()), 200);
    return () => clearInterval(timer);
  }, [begun]);
  return now.value - begun;
}

function words({ file }: Working): string {
  return file === null ? t.other : t.reading(file.split("/").pop() ?? file);
}

function Elapsed({ begun }: { begun: number }): JSX.Element {
  const elapsed = useElapsed(begun);
  // Seconds that are read out one after another would be a nuisance.
  return <span class="elapsed" aria-hidden="true">{elapsed > 1000 ? duration(Math.floor(elapsed / 1000)).replace(".0", "") : ""}</span>;
}

/** In the bar at the top. */
export function WorkingBadge(): JSX.Element | null {
  const now = working.value;
  return now && <BadgeOf key={now.begun} now={now} />;
}

function BadgeOf({ now }: { now: Working }): JSX.Element | null {
  if (useElapsed(now.begun) < patience) return null;
  return (
    <span class="lock working" role="status">
      {words(now)} <Elapsed begun={now.begun} />
    </span>
  );
}

/** Where a document would be, while there is none yet; else what is given. */
export function Awaited({ details, children }: { details?: boolean; children: string }): JSX.Element {
  const now = working.value;
  if (now && opening.value) {
    return (
      <p class="empty-note">
        {words(now)} <Elapsed begun={now.begun} />
        {details && <span class="details">{t.readingLong}</span>}
      </p>
    );
  }
  const waiting = line.value === "connecting" || line.value === "lost" ? t.connecting : document_.value === null ? t.waiting : children;
  return <p class="empty-note">{waiting}</p>;
}
