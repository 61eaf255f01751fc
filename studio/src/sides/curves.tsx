// The courses of the errors of all renders over time, both by their logarithms.
import { signal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";
import type UPlot from "uplot";
import { percent } from "../model/numbers.ts";
import { errorPlot } from "../parts/error_plot.ts";
import { renders } from "../model/state.ts";
import { demand } from "../model/studio.ts";
import { isDark } from "../model/theme.ts";
import { texts } from "../texts/texts.ts";

const t = texts.sides;

/** Wong 2011, "Points of view: color blindness": the document's own first. */
export const lineColors = ["#56b4e9", "#e69f00", "#009e73", "#d55e00", "#cc79a7"];

type Course = [seconds: number, error: number][];
const courses = signal<Course[]>([]);

async function load(): Promise<void> {
  const numbers = [0, ...renders.peek().map((r) => r.render)];
  try {
    const said = await Promise.all(numbers.map((render) => demand<{ points: [number, number | null, number][] }>("course", { render })));
    courses.value = said.map(({ points }) => points.filter((p): p is [number, number, number] => typeof p[1] === "number" && p[1] > 0 && p[0] > 0).map(([s, e]) => [s, e]));
  } catch {
    // one of them was just taken away: next time
  }
}

export function ErrorCurves(): JSX.Element {
  const box = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const parent = box.current;
    if (!parent) return;
    let plot: UPlot | null = null;
    const draw = (): void => {
      plot?.destroy();
      plot = make(parent, isDark.value, courses.value);
    };
    const ends = [courses.subscribe(draw), isDark.subscribe(draw)];
    const timer = window.setInterval(() => void load(), 1000);
    void load();
    const resize = new ResizeObserver(() => plot?.setSize({ width: parent.clientWidth, height: 190 }));
    resize.observe(parent);
    return () => {
      ends.forEach((end) => end());
      clearInterval(timer);
      resize.disconnect();
      plot?.destroy();
    };
  }, []);
  const list = courses.value.map((c, i) => `${i === 0 ? t.own : (renders.value[i - 1]?.title ?? "")} ${percent(c[c.length - 1]?.[1] ?? NaN)}`).join("; ");
  return (
    <section class="sides-curves">
      <h2 class="small">{t.curves}</h2>
      <div class="curve" ref={box} role="img" aria-label={t.curvesSays(list)} />
    </section>
  );
}

/** All courses over one row of times: where one has no value, none is drawn, and its line goes on to the next. */
function make(parent: HTMLElement, dark: boolean, all: Course[]): UPlot {
  const times = [...new Set(all.flatMap((c) => c.map(([s]) => s)))].sort((a, b) => a - b);
  const rows = all.map((course) => {
    const known = new Map(course);
    return times.map((s) => (known.has(s) ? (known.get(s) as number) * 100 : null));
  });
  const lines = all.map((course, i) => ({ stroke: lineColors[i % lineColors.length] as string, width: 1.8, points: { show: course.length === 1 }, spanGaps: true }));
  return errorPlot(parent, dark, 190, lines, [times, ...rows]);
}
