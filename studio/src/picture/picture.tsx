// The picture: drawn, zoomed, panned, read pixel by pixel, cropped, compared, picked in.
import { batch, signal, useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { readOnly, selected, tab } from "../model/state.ts";
import { ask, demand, report } from "../model/studio.ts";
import { isDark } from "../theme.ts";
import { texts } from "../texts.ts";
import { Film, isBad } from "./film.ts";
import { drawOverlay } from "./overlay.ts";
import { PixelNumbers, cursor, probeAt, type Pixel } from "./readout.tsx";
import { Screen, type Look } from "./screen.ts";
import * as store from "./store.ts";
import { centred, fit, toPicture, zoomAbout, type View } from "./view.ts";
import { moveCamera, type CameraMove } from "./camera.ts";

export type Mode = "look" | "crop" | "orbit" | "pick" | "paths";
export const mode = signal<Mode>("look");
export const zoom = signal(1);
/** The rectangle that is rendered first, x0, y0, x1, y1. */
export const crop = signal<[number, number, number, number] | null>(null);
/** The pixel whose paths are shown. */
export const pathPixel = signal<Pixel | null>(null);

type Command = "fit" | "one" | "in" | "out";
const commands = new EventTarget();
export function command(name: Command): void {
  commands.dispatchEvent(new CustomEvent("command", { detail: name }));
}

export async function setCrop(area: [number, number, number, number] | null): Promise<void> {
  try {
    await demand("crop", { area });
    crop.value = area;
  } catch (error) {
    report(error);
  }
}

const curves = { linear: 0, filmic: 1, reinhard: 2, program: 3 } as const;
const compares = { none: 0, split: 1, flicker: 0, difference: 3 } as const;

/** The canvas as a picture file's pixels, for saving what is seen. */
export let takeScreenshot: (() => Promise<Blob | null>) | null = null;

export function Picture(): JSX.Element {
  const box = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const over = useRef<HTMLCanvasElement>(null);
  const failure = useSignal("");
  const dragging = useRef<{ x: number; y: number; what: "pan" | "crop" | "split" | "camera"; at: [number, number]; moved: boolean; camera?: CameraMove } | null>(null);
  const view = useRef<View>({ zoom: 1, x: 0, y: 0 });
  const fitted = useRef(true);
  const cropDrag = useRef<[number, number, number, number] | null>(null);
  const redraw = useRef<() => void>(() => undefined);

  useEffect(() => {
    const element = canvas.current;
    const overlay = over.current;
    if (!element || !overlay || !box.current) return;
    let screen: Screen;
    try {
      screen = new Screen(element);
    } catch {
      failure.value = texts.picture.noWebGl;
      return;
    }
    let frame = 0;
    const draw = (): void => {
      frame = 0;
      const film = store.shownFilm.value;
      const size = store.size.value;
      if (!film && !store.toned.value) return;
      if (fitted.current) view.current = fit(size, element);
      zoom.value = view.current.zoom;
      const flicker = store.compare.value === "flicker" && Math.floor(performance.now() / 500) % 2 === 1;
      const look: Look = {
        stops: store.stops.value,
        curve: curves[store.curve.value],
        falseColor: store.falseColor.value,
        falseRange: store.falseRange.value,
        compare: flicker ? 2 : compares[store.compare.value],
        split: store.split.value * element.width,
        markBad: store.markBad.value,
        surround: isDark.value ? [0.105, 0.115, 0.125] : [0.8, 0.81, 0.82],
      };
      const shown = film ?? emptyFilm(size);
      screen.draw(shown, size, store.pinned.value?.film ?? null, store.toned.value, view.current, look);
      drawOverlay(overlay, shown, size, view.current, { crop: cropDrag.current ?? crop.value, cursor: cursor.value, paths: pathPixel.value });
      if (store.compare.value === "flicker" || store.markBad.value && badAround(shown)) again(250);
    };
    const request = (): void => {
      if (!frame) frame = requestAnimationFrame(draw);
    };
    let timer = 0;
    const again = (after: number): void => {
      clearTimeout(timer);
      timer = window.setTimeout(request, after);
    };
    redraw.current = request;
    const resize = new ResizeObserver(() => {
      const scale = window.devicePixelRatio || 1;
      for (const c of [element, overlay]) {
        c.width = Math.max(1, Math.round(element.clientWidth * scale));
        c.height = Math.max(1, Math.round(element.clientHeight * scale));
      }
      request();
    });
    resize.observe(box.current);
    const ends = [
      store.pixelsVersion, store.stops, store.curve, store.falseColor, store.falseRange, store.compare, store.split, store.markBad,
      store.pinned, cursor, crop, pathPixel, isDark, tab,
    ].map((s) => s.subscribe(request));
    takeScreenshot = async () => {
      draw();
      const taken = new OffscreenCanvas(element.width, element.height);
      taken.getContext("2d")?.putImageData(new ImageData(screen.read() as Uint8ClampedArray<ArrayBuffer>, element.width, element.height), 0, 0);
      return taken.convertToBlob();
    };
    const obey = (event: globalThis.Event): void => zoomBy((event as CustomEvent<Command>).detail);
    commands.addEventListener("command", obey);
    return () => {
      resize.disconnect();
      ends.forEach((end) => end());
      commands.removeEventListener("command", obey);
      cancelAnimationFrame(frame);
      clearTimeout(timer);
      takeScreenshot = null;
      screen.dispose();
    };
  }, []);

  const zoomBy = (what: Command): void => {
    const c = canvas.current;
    if (!c) return;
    if (what === "fit") fitted.current = true;
    else {
      fitted.current = false;
      if (what === "one") view.current = centred(store.size.value, c, 1);
      else view.current = zoomAbout(view.current, what === "in" ? 1.5 : 1 / 1.5, c.width / 2, c.height / 2);
    }
    redraw.current();
  };

  const place = (event: MouseEvent): { x: number; y: number; at: [number, number] } => {
    const c = canvas.current as HTMLCanvasElement;
    const bounds = c.getBoundingClientRect();
    const scale = c.width / bounds.width;
    const x = (event.clientX - bounds.left) * scale;
    const y = (event.clientY - bounds.top) * scale;
    return { x, y, at: toPicture(view.current, x, y) };
  };
  const pixel = (at: [number, number]): Pixel | null => {
    const x = Math.floor(at[0]);
    const y = Math.floor(at[1]);
    const { width, height } = store.size.value;
    return x >= 0 && y >= 0 && x < width && y < height ? { x, y } : null;
  };

  const choose = (at: Pixel | null): void => {
    if (!at) return;
    if (mode.value === "pick") void pick(at);
    if (mode.value === "paths") {
      batch(() => {
        pathPixel.value = at;
        tab.value = "paths";
      });
    }
  };

  const down = (event: PointerEvent): void => {
    const { x, y, at } = place(event);
    (event.currentTarget as HTMLElement).setPointerCapture(event.pointerId);
    const c = canvas.current as HTMLCanvasElement;
    const nearSplit = store.pinned.value && store.compare.value === "split" && Math.abs(x - store.split.value * c.width) < 8;
    const camera = mode.value === "orbit" && !readOnly.value && event.button === 0;
    const what = nearSplit ? "split" : mode.value === "crop" && event.button === 0 ? "crop" : camera ? "camera" : "pan";
    dragging.current = { x, y, what, at, moved: false };
  };
  const move = (event: PointerEvent): void => {
    const { x, y, at } = place(event);
    cursor.value = pixel(at);
    const drag = dragging.current;
    if (!drag) return;
    if (Math.abs(x - drag.x) + Math.abs(y - drag.y) > 3) drag.moved = true;
    if (!drag.moved) return;
    const c = canvas.current as HTMLCanvasElement;
    if (drag.what === "split") store.split.value = Math.min(1, Math.max(0, x / c.width));
    else if (drag.what === "crop") {
      const { width, height } = store.size.value;
      const inside = (v: number, most: number): number => Math.round(Math.min(most, Math.max(0, v)));
      cropDrag.current = [
        inside(Math.min(at[0], drag.at[0]), width), inside(Math.min(at[1], drag.at[1]), height),
        inside(Math.max(at[0], drag.at[0]), width), inside(Math.max(at[1], drag.at[1]), height),
      ];
      redraw.current();
    } else if (drag.what === "camera") {
      const kind: CameraMove = event.shiftKey ? "pan" : event.ctrlKey ? "dolly" : "orbit";
      drag.camera = kind;
      moveCamera(kind, (x - drag.x) / c.height, (y - drag.y) / c.height, false);
      [drag.x, drag.y] = [x, y];
    } else {
      fitted.current = false;
      view.current = { ...view.current, x: view.current.x + x - drag.x, y: view.current.y + y - drag.y };
      [drag.x, drag.y] = [x, y];
      redraw.current();
    }
  };
  const up = (event: PointerEvent): void => {
    const drag = dragging.current;
    dragging.current = null;
    if (!drag) return;
    if (drag.what === "camera" && drag.camera) moveCamera(drag.camera, 0, 0, true);
    const area = cropDrag.current;
    cropDrag.current = null;
    if (drag.what === "crop" && area && area[2] > area[0] && area[3] > area[1]) {
      void setCrop(area);
      mode.value = "look";
    }
    if (!drag.moved) {
      const at = pixel(place(event).at);
      choose(at);
      if (at) probeAt(at, true);
    }
    redraw.current();
  };
  const wheel = (event: WheelEvent): void => {
    event.preventDefault();
    const { x, y } = place(event);
    if (mode.value === "orbit" && !readOnly.value) {
      moveCamera("dolly", 0, Math.sign(event.deltaY) * 0.08, true);
      return;
    }
    fitted.current = false;
    view.current = zoomAbout(view.current, Math.pow(2, -event.deltaY / 240), x, y);
    redraw.current();
  };
  const key = (event: KeyboardEvent): void => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const step = event.shiftKey ? 10 : 1;
    const arrows: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    const arrow = arrows[event.key];
    const at = cursor.value ?? { x: Math.floor(store.size.value.width / 2), y: Math.floor(store.size.value.height / 2) };
    if (arrow && mode.value === "orbit") moveCamera(event.shiftKey ? "pan" : "orbit", arrow[0] * 0.05, arrow[1] * 0.05, true);
    else if (arrow) {
      const next = pixel([at.x + arrow[0] * step + 0.5, at.y + arrow[1] * step + 0.5]);
      if (next) {
        cursor.value = next;
        probeAt(next, true);
      }
    } else if (event.key === "+" || event.key === "=") zoomBy("in");
    else if (event.key === "-") zoomBy("out");
    else if (event.key === "f" || event.key === "F") zoomBy("fit");
    else if (event.key === "1") zoomBy("one");
    else if (event.key === "e") store.expose(store.stops.value + 0.25);
    else if (event.key === "E") store.expose(store.stops.value - 0.25);
    else if (event.key === "0") store.expose(0);
    else if (event.key === "Enter" && (mode.value === "pick" || mode.value === "paths")) choose(at);
    else if (event.key === "Escape") mode.value = "look";
    else return;
    event.preventDefault();
  };

  return (
    <div class={`picture mode-${mode.value}`}>
      <div class="canvases" ref={box}>
      <canvas ref={canvas} class="picture-canvas" />
      <canvas
        ref={over}
        class="picture-over"
        tabIndex={0}
        role="application"
        aria-label={texts.picture.canvas}
        aria-describedby="picture-numbers"
        onPointerDown={down}
        onPointerMove={move}
        onPointerUp={up}
        onPointerLeave={() => (cursor.value = dragging.current ? cursor.value : null)}
        onWheel={wheel}
        onDblClick={() => zoomBy("fit")}
        onKeyDown={key}
        onContextMenu={(e) => e.preventDefault()}
      />
      {failure.value && <p class="empty-note">{failure.value}</p>}
      {!store.shownFilm.value && !store.toned.value && !failure.value && <p class="empty-note">{texts.picture.none}</p>}
      </div>
      <PixelNumbers />
    </div>
  );
}

async function pick(at: Pixel): Promise<void> {
  const found = await ask<{ component: number | null }>("pick", { x: at.x, y: at.y });
  if (found?.component) selected.value = found.component;
}

let empty: Film | null = null;
function emptyFilm(size: { width: number; height: number }): Film {
  if (!empty || empty.width !== size.width || empty.height !== size.height) empty = new Film(size.width, size.height);
  return empty;
}

/** Whether there is a bad pixel, so that its marker must blink; looked for at some pixels only, anew each second. */
let lookedAt = 0;
let found = false;
function badAround(film: Film): boolean {
  if (performance.now() - lookedAt < 1000) return found;
  lookedAt = performance.now();
  const pixels = film.width * film.height;
  const step = Math.max(1, Math.floor(pixels / 100000));
  found = false;
  for (let i = 0; i < pixels && !found; i += step) found = isBad(film.rgb(i % film.width, Math.floor(i / film.width)));
  return found;
}
