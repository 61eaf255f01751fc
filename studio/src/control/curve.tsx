// The course of the error over time, both by their logarithms: unbiased algorithms go down by a half for four times the time.
import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { effect } from "@preact/signals";
import type UPlot from "uplot";
import { errorPlot } from "../parts/error_plot.ts";
import { errorCourse, progress } from "../model/state.ts";
import { percent } from "../model/numbers.ts";
import { isDark } from "../model/theme.ts";
import { texts } from "../texts/texts.ts";

export function ErrorCurve(): JSX.Element {
  const box = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const parent = box.current;
    if (!parent) return;
    let plot: UPlot | null = null;
    const end = effect(() => {
      plot?.destroy();
      plot = make(parent, isDark.value);
    });
    const endData = effect(() => {
      const { seconds, errors } = errorCourse.value;
      void isDark.value;
      plot?.setData([seconds, errors.map((e) => e * 100)]);
    });
    const resize = new ResizeObserver(() => plot?.setSize({ width: parent.clientWidth, height: 150 }));
    resize.observe(parent);
    return () => {
      end();
      endData();
      resize.disconnect();
      plot?.destroy();
    };
  }, []);
  const error = progress.value?.error;
  return <div class="curve" ref={box} role="img" aria-label={texts.control.courseSays(error == null ? "–" : percent(error))} />;
}

function make(parent: HTMLElement, dark: boolean): UPlot {
  return errorPlot(parent, dark, 150, [{ stroke: dark ? "#7cc0ff" : "#0b65b8", width: 1.6, points: { show: false } }], [[], []]);
}
