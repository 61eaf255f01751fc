// The waveform beside the histogram: which column of the picture has what brightness.
import { useSignalEffect } from "@preact/signals";
import type { JSX } from "preact";
import { useRef } from "preact/hooks";
import { texts } from "../texts/texts.ts";
import { isDark } from "../model/theme.ts";
import { useCounted } from "./counted.ts";
import { waveform, type Waveform } from "./scope.ts";
import { stops } from "./store.ts";

export function WaveformView(): JSX.Element {
  const canvas = useRef<HTMLCanvasElement>(null);
  const counted = useCounted(waveform);
  useSignalEffect(() => {
    const w = counted.value;
    const context = canvas.current?.getContext("2d");
    if (w && context) draw(context, w, stops.value, isDark.value);
  });
  const w = counted.value;
  const said = w ? texts.picture.waveformSays(w.low, w.high) : texts.picture.waveform;
  return <canvas ref={canvas} class="histogram" width={240} height={80} role="img" aria-label={said} title={said} />;
}

/** A step of a column is the brighter, the more of its pixels are in it; the line is what the screen shows as white. */
function draw(context: CanvasRenderingContext2D, w: Waveform, exposure: number, dark: boolean): void {
  const image = context.createImageData(w.columns, w.rows);
  const ink = dark ? [150, 205, 255] : [11, 75, 140];
  for (let x = 0; x < w.columns; ++x) {
    const column = w.counts.subarray(x * w.rows, (x + 1) * w.rows);
    const most = Math.max(1, ...column);
    column.forEach((count, row) => {
      const at = ((w.rows - 1 - row) * w.columns + x) * 4;
      ink.forEach((v, c) => (image.data[at + c] = v));
      image.data[at + 3] = count ? 60 + 195 * Math.sqrt(count / most) : 0;
    });
  }
  context.clearRect(0, 0, w.columns, w.rows);
  context.putImageData(image, 0, 0);
  context.fillStyle = dark ? "#ffd166" : "#9a6700";
  context.fillRect(0, Math.round((1 - (-exposure - w.low) / (w.high - w.low)) * w.rows), w.columns, 1);
}
