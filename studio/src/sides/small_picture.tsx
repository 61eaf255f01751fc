// A picture without tools: as large as its place lets it, with the exposure and curve that the large one has.
import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { useSignalEffect } from "@preact/signals";
import { luminance, type Film } from "../picture/film.ts";
import { curve, pixelsVersion, stops } from "../picture/store.ts";

/** IEC 61966-2-1, in bytes. */
function encode(value: number): number {
  const c = Math.min(1, Math.max(0, value));
  return 255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055);
}

/** Narkowicz 2015, "ACES filmic tone mapping curve", as the large picture has it. */
function filmic(v: number): number {
  const x = 0.6 * Math.max(0, v);
  return (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14);
}

export function paint(canvas: HTMLCanvasElement, film: Film, exposure: number, shape: typeof curve.value): void {
  if (canvas.width !== film.width || canvas.height !== film.height) Object.assign(canvas, { width: film.width, height: film.height });
  const context = canvas.getContext("2d");
  if (!context) return;
  const image = context.createImageData(film.width, film.height);
  const factor = 2 ** exposure;
  for (let y = 0, at = 0; y < film.height; ++y) {
    for (let x = 0; x < film.width; ++x, at += 4) {
      const rgb = film.rgb(x, y).map((v) => v * factor) as [number, number, number];
      const less = shape === "reinhard" ? 1 / (1 + Math.max(0, luminance(rgb))) : 1;
      for (let c = 0; c < 3; ++c) {
        const value = rgb[c as 0] * less;
        image.data[at + c] = encode(shape === "filmic" || shape === "program" ? filmic(value) : value);
      }
      image.data[at + 3] = 255;
    }
  }
  context.putImageData(image, 0, 0);
}

export function SmallPicture({ film, label }: { film: Film | null; label: string }): JSX.Element {
  const canvas = useRef<HTMLCanvasElement>(null);
  const latest = useRef(film);
  latest.current = film;
  const last = useRef({ at: 0, timer: 0 });
  const request = (): void => {
    clearTimeout(last.current.timer);
    last.current.timer = window.setTimeout(() => {
      last.current.at = performance.now();
      if (canvas.current && latest.current) paint(canvas.current, latest.current, stops.peek(), curve.peek());
    }, Math.max(0, last.current.at + 200 - performance.now()));
  };
  useEffect(request);
  useSignalEffect(() => {
    void pixelsVersion.value;
    void stops.value;
    void curve.value;
    request();
  });
  useEffect(() => () => clearTimeout(last.current.timer), []);
  return <canvas ref={canvas} class="small-picture" role="img" aria-label={label} width={4} height={3} />;
}
