// What lies over the picture: numbers in large pixels, the crop rectangle, the pixel under the cursor.
import type { Film } from "./film.ts";
import { brief } from "../model/numbers.ts";
import { toCanvas, toPicture, type Size, type View } from "./view.ts";

export interface Marks {
  crop: readonly [number, number, number, number] | null;
  cursor: { x: number; y: number } | null;
  paths: { x: number; y: number } | null;
  /** Pixels with samples that were no light. */
  bad: readonly { x: number; y: number }[];
}

/** From how large a pixel on there is room for its numbers. */
const numbersFrom = 72;

export function drawOverlay(canvas: HTMLCanvasElement, film: Film, size: Size, view: View, marks: Marks): void {
  const context = canvas.getContext("2d");
  if (!context) return;
  context.clearRect(0, 0, canvas.width, canvas.height);
  if (view.zoom >= numbersFrom && film.width === size.width) numbers(context, canvas, film, view);
  if (marks.crop) rectangle(context, view, marks.crop, "#ffd166", [6, 4]);
  if (marks.paths) rectangle(context, view, [marks.paths.x, marks.paths.y, marks.paths.x + 1, marks.paths.y + 1], "#5bc0ff", [], 3);
  for (const { x, y } of marks.bad) ring(context, view, x, y);
  if (marks.cursor && view.zoom >= 4) {
    rectangle(context, view, [marks.cursor.x, marks.cursor.y, marks.cursor.x + 1, marks.cursor.y + 1], "#ffffff", []);
  }
}

function rectangle(context: CanvasRenderingContext2D, view: View, area: readonly [number, number, number, number], color: string,
  dash: number[], outside = 0): void {
  const [x0, y0] = toCanvas(view, area[0], area[1]);
  const [x1, y1] = toCanvas(view, area[2], area[3]);
  context.lineWidth = 1;
  for (const [style, grow] of [["rgba(0,0,0,0.7)", 1], [color, 0]] as const) {
    context.setLineDash(grow ? [] : dash);
    context.strokeStyle = style;
    const g = grow + outside;
    context.strokeRect(Math.round(x0) - 0.5 - g, Math.round(y0) - 0.5 - g, Math.round(x1 - x0) + 2 * g + 1, Math.round(y1 - y0) + 2 * g + 1);
  }
  context.setLineDash([]);
}

/** A ring that is seen on anything, however small the pixel in it is. */
function ring(context: CanvasRenderingContext2D, view: View, x: number, y: number): void {
  const [cx, cy] = toCanvas(view, x + 0.5, y + 0.5);
  for (const [style, width] of [["rgba(0,0,0,0.8)", 4], ["#ff4fd8", 2]] as const) {
    context.strokeStyle = style;
    context.lineWidth = width;
    context.beginPath();
    context.arc(cx, cy, Math.max(6, view.zoom), 0, 2 * Math.PI);
    context.stroke();
  }
}

function numbers(context: CanvasRenderingContext2D, canvas: HTMLCanvasElement, film: Film, view: View): void {
  const [left, top] = toPicture(view, 0, 0);
  const [right, bottom] = toPicture(view, canvas.width, canvas.height);
  const line = Math.min(18, view.zoom / 5);
  context.font = `${Math.round(line)}px ui-monospace, monospace`;
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.lineWidth = 3;
  context.strokeStyle = "rgba(0,0,0,0.75)";
  for (let y = Math.max(0, Math.floor(top)); y < Math.min(film.height, bottom); ++y) {
    for (let x = Math.max(0, Math.floor(left)); x < Math.min(film.width, right); ++x) {
      const [cx, cy] = toCanvas(view, x + 0.5, y + 0.5);
      film.rgb(x, y).forEach((value, channel) => {
        const text = brief(value, 3);
        const at = cy + (channel - 1) * line * 1.2;
        context.strokeText(text, cx, at);
        context.fillStyle = ["#ff9c94", "#a6e3a1", "#9cc4ff"][channel] ?? "#fff";
        context.fillText(text, cx, at);
      });
    }
  }
}
