// How much of the picture has what brightness: red, green and blue over powers of two.
import { computed, useSignalEffect } from "@preact/signals";
import type { JSX } from "preact";
import { useRef } from "preact/hooks";
import { texts } from "../texts/texts.ts";
import { isDark } from "../model/theme.ts";
import { useCounted } from "./counted.ts";
import { histogram, type Histogram } from "./film.ts";
import { falseColor, falseRange, stops } from "./store.ts";

const width = 240;
const height = 72;

export function HistogramView(): JSX.Element {
  const canvas = useRef<HTMLCanvasElement>(null);
  const counted = useCounted(histogram);
  useSignalEffect(() => {
    const h = counted.value;
    const context = canvas.current?.getContext("2d");
    if (h && context) draw(context, h, stops.value, isDark.value, falseColor.value ? falseRange.value : null);
  });
  const said = computed(() => {
    const h = counted.value;
    return h ? texts.picture.histogramSays(h.low, h.high, h.bad) : texts.picture.histogram;
  });
  return <canvas ref={canvas} class="histogram" width={2 * width} height={2 * height} role="img" aria-label={said.value} title={said.value} />;
}

function draw(context: CanvasRenderingContext2D, h: Histogram, exposure: number, dark: boolean, range: [number, number] | null): void {
  const [w, t] = [context.canvas.width, context.canvas.height];
  context.clearRect(0, 0, w, t);
  const x = (power: number): number => ((power - h.low) / (h.high - h.low)) * w;
  context.fillStyle = dark ? "#ffffff12" : "#00000010";
  for (let power = h.low; power < h.high; power += 4) context.fillRect(x(power), 0, x(2) - x(0), t);
  let most = 1;
  for (const counts of h.counts) for (const c of counts) most = Math.max(most, c);
  context.globalCompositeOperation = dark ? "lighter" : "multiply";
  const colors = dark ? ["#d0453c", "#3fa34d", "#3d74d6"] : ["#ff8f87", "#8ed49a", "#8fb4ff"];
  colors.forEach((color, channel) => {
    const counts = h.counts[channel] as Uint32Array;
    context.fillStyle = color;
    context.beginPath();
    context.moveTo(0, t);
    counts.forEach((c, i) => {
      const y = t - Math.sqrt(c / most) * (t - 4);
      context.lineTo((i / counts.length) * w, y);
      context.lineTo(((i + 1) / counts.length) * w, y);
    });
    context.lineTo(w, t);
    context.fill();
  });
  context.globalCompositeOperation = "source-over";
  context.fillStyle = dark ? "#ffd166" : "#9a6700";
  for (const power of range ?? [-exposure]) context.fillRect(Math.round(x(power)) - 1, 0, 2, t);
}
