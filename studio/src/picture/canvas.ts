// The two canvases of the picture, drawn when something that is seen has changed: the picture by the graphics processor, marks above it.
import { tab } from "../model/state.ts";
import { isDark } from "../model/theme.ts";
import { badMarks } from "./bad.ts";
import { Film, isBad } from "./film.ts";
import { drawOverlay } from "./overlay.ts";
import { cursor, type Pixel } from "./probe.ts";
import { Screen, type Look } from "./screen.ts";
import { crop, pathPixel, zoom, type Command } from "./state.ts";
import * as store from "./store.ts";
import { centred, fit, toPicture, zoomAbout, type View } from "./view.ts";

const curves = { linear: 0, filmic: 1, reinhard: 2, program: 3 } as const;
const compares = { none: 0, split: 1, flicker: 0, difference: 3 } as const;

/** The canvas as a picture file's pixels, for saving what is seen. */
export let takeScreenshot: (() => Promise<Blob | null>) | null = null;

export class PictureCanvas {
  view: View = { zoom: 1, x: 0, y: 0 };
  /** Whether all of the picture is to be seen, however large it is. */
  fitted = true;
  /** The rectangle that is being drawn by the mouse. */
  cropDrag: [number, number, number, number] | null = null;
  private readonly screen: Screen;
  private readonly resize: ResizeObserver;
  private readonly ends: (() => void)[];
  private frame = 0;
  private timer = 0;
  private bad = { at: 0, found: false };

  /** Throws where the browser has no WebGL 2. */
  constructor(
    readonly element: HTMLCanvasElement,
    private readonly overlay: HTMLCanvasElement,
    box: HTMLElement,
  ) {
    this.screen = new Screen(element);
    this.resize = new ResizeObserver(() => this.resized());
    this.resize.observe(box);
    const watched = [
      store.pixelsVersion, store.stops, store.curve, store.falseColor, store.falseRange, store.compare, store.split, store.markBad,
      store.pinned, cursor, crop, pathPixel, isDark, tab, badMarks,
    ];
    this.ends = watched.map((s) => s.subscribe(() => this.request()));
    takeScreenshot = () => this.screenshot();
  }

  dispose(): void {
    this.resize.disconnect();
    this.ends.forEach((end) => end());
    cancelAnimationFrame(this.frame);
    clearTimeout(this.timer);
    takeScreenshot = null;
    this.screen.dispose();
  }

  /** Draws before the next frame of the browser. */
  request(): void {
    if (!this.frame) this.frame = requestAnimationFrame(() => this.draw());
  }

  zoomBy(what: Command): void {
    const { width, height } = this.element;
    this.fitted = what === "fit";
    if (what === "one") this.view = centred(store.size.value, this.element, 1);
    else if (what !== "fit") this.view = zoomAbout(this.view, what === "in" ? 1.5 : 1 / 1.5, width / 2, height / 2);
    this.request();
  }

  /** Where the mouse is, in the canvas's pixels and in the picture's. */
  place(event: MouseEvent): { x: number; y: number; at: [number, number] } {
    const bounds = this.element.getBoundingClientRect();
    const scale = this.element.width / bounds.width;
    const x = (event.clientX - bounds.left) * scale;
    const y = (event.clientY - bounds.top) * scale;
    return { x, y, at: toPicture(this.view, x, y) };
  }

  /** The pixel at a place of the picture; null outside. */
  pixel(at: [number, number]): Pixel | null {
    const [x, y] = [Math.floor(at[0]), Math.floor(at[1])];
    const { width, height } = store.size.value;
    return x >= 0 && y >= 0 && x < width && y < height ? { x, y } : null;
  }

  private draw(): void {
    this.frame = 0;
    const film = store.shownFilm.value;
    const size = store.size.value;
    if (!film && !store.toned.value) return;
    if (this.fitted) this.view = fit(size, this.element);
    zoom.value = this.view.zoom;
    const flicker = store.compare.value === "flicker" && Math.floor(performance.now() / 500) % 2 === 1;
    const look: Look = {
      stops: store.stops.value,
      curve: curves[store.shownCurve.value],
      falseColor: store.falseColor.value,
      falseRange: store.falseRange.value,
      compare: flicker ? 2 : compares[store.compare.value],
      split: store.split.value * this.element.width,
      markBad: store.markBad.value,
      surround: isDark.value ? [0.105, 0.115, 0.125] : [0.8, 0.81, 0.82],
    };
    const shown = film ?? emptyFilm(size);
    this.screen.draw(shown, size, store.pinned.value?.film ?? null, store.toned.value, this.view, look);
    drawOverlay(this.overlay, shown, size, this.view, {
      crop: this.cropDrag ?? crop.value, cursor: cursor.value, paths: pathPixel.value, bad: store.markBad.value ? badMarks.value : [],
    });
    if (store.compare.value === "flicker" || (store.markBad.value && this.badAround(shown))) {
      clearTimeout(this.timer);
      this.timer = window.setTimeout(() => this.request(), 250);
    }
  }

  private resized(): void {
    const scale = window.devicePixelRatio || 1;
    for (const c of [this.element, this.overlay]) {
      c.width = Math.max(1, Math.round(this.element.clientWidth * scale));
      c.height = Math.max(1, Math.round(this.element.clientHeight * scale));
    }
    this.request();
  }

  private async screenshot(): Promise<Blob | null> {
    this.draw();
    const { width, height } = this.element;
    const taken = new OffscreenCanvas(width, height);
    taken.getContext("2d")?.putImageData(new ImageData(this.screen.read() as Uint8ClampedArray<ArrayBuffer>, width, height), 0, 0);
    return taken.convertToBlob();
  }

  /** Whether there is a bad pixel, so that its marker must blink; looked for at some pixels only, anew each second. */
  private badAround(film: Film): boolean {
    if (performance.now() - this.bad.at < 1000) return this.bad.found;
    const pixels = film.width * film.height;
    const step = Math.max(1, Math.floor(pixels / 100000));
    let found = false;
    for (let i = 0; i < pixels && !found; i += step) found = isBad(film.rgb(i % film.width, Math.floor(i / film.width)));
    this.bad = { at: performance.now(), found };
    return found;
  }
}

let empty: Film | null = null;
function emptyFilm(size: { width: number; height: number }): Film {
  if (!empty || empty.width !== size.width || empty.height !== size.height) empty = new Film(size.width, size.height);
  return empty;
}
