// What mouse and keys do on the picture: zoom, pan, read, crop, pick, and move the camera.
import { batch } from "@preact/signals";
import { readOnly, selected, tab } from "../model/state.ts";
import { ask } from "../model/studio.ts";
import { flyBy, moveCamera, type CameraMove } from "./camera.ts";
import type { PictureCanvas } from "./canvas.ts";
import { cursor, probeAt, type Pixel } from "./probe.ts";
import { mode, movesCamera, pathPixel, setCrop } from "./state.ts";
import * as store from "./store.ts";
import { zoomAbout } from "./view.ts";

interface Drag {
  what: "pan" | "crop" | "split" | "camera";
  /** Where it began, or was last: on the canvas. */
  x: number;
  y: number;
  /** Where it began, in the picture. */
  at: [number, number];
  moved: boolean;
  camera?: CameraMove;
}

/** Keys that fly, and what they move: to the right, up, forward. */
const flights: Record<string, [number, number, number]> = {
  w: [0, 0, 1], s: [0, 0, -1], a: [-1, 0, 0], d: [1, 0, 0], e: [0, 1, 0], q: [0, -1, 0],
};
const arrows: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

export class PictureInput {
  private drag: Drag | null = null;
  private flying = false;

  constructor(private readonly canvas: PictureCanvas) {}

  down(event: PointerEvent): void {
    const { x, y, at } = this.canvas.place(event);
    (event.currentTarget as HTMLElement).setPointerCapture(event.pointerId);
    const left = event.button === 0;
    const nearSplit = store.pinned.value && store.compare.value === "split" && Math.abs(x - store.split.value * this.canvas.element.width) < 8;
    const camera = movesCamera(mode.value) && !readOnly.value && left;
    this.drag = { x, y, what: nearSplit ? "split" : mode.value === "crop" && left ? "crop" : camera ? "camera" : "pan", at, moved: false };
  }

  move(event: PointerEvent): void {
    const { x, y, at } = this.canvas.place(event);
    cursor.value = this.canvas.pixel(at);
    const drag = this.drag;
    if (!drag) return;
    if (Math.abs(x - drag.x) + Math.abs(y - drag.y) > 3) drag.moved = true;
    if (!drag.moved) return;
    const { width, height } = this.canvas.element;
    if (drag.what === "split") store.split.value = Math.min(1, Math.max(0, x / width));
    else if (drag.what === "crop") this.cropTo(drag.at, at);
    else if (drag.what === "camera") {
      const kind: CameraMove = event.shiftKey ? "pan" : event.ctrlKey ? "dolly" : mode.value === "fly" ? "turn" : "orbit";
      drag.camera = kind;
      moveCamera(kind, (x - drag.x) / height, (y - drag.y) / height, false);
      [drag.x, drag.y] = [x, y];
    } else {
      this.canvas.fitted = false;
      const view = this.canvas.view;
      this.canvas.view = { ...view, x: view.x + x - drag.x, y: view.y + y - drag.y };
      [drag.x, drag.y] = [x, y];
      this.canvas.request();
    }
  }

  up(event: PointerEvent): void {
    const drag = this.drag;
    this.drag = null;
    if (!drag) return;
    if (drag.what === "camera" && drag.camera) moveCamera(drag.camera, 0, 0, true);
    const area = this.canvas.cropDrag;
    this.canvas.cropDrag = null;
    if (drag.what === "crop" && area && area[2] > area[0] && area[3] > area[1]) {
      void setCrop(area);
      mode.value = "look";
    }
    if (!drag.moved) {
      const at = this.canvas.pixel(this.canvas.place(event).at);
      this.choose(at);
      if (at) probeAt(at, true);
    }
    this.canvas.request();
  }

  leave(): void {
    if (!this.drag) cursor.value = null;
  }

  wheel(event: WheelEvent): void {
    event.preventDefault();
    const { x, y } = this.canvas.place(event);
    if (movesCamera(mode.value) && !readOnly.value) {
      if (mode.value === "fly") flyBy(0, 0, -Math.sign(event.deltaY), true);
      else moveCamera("dolly", 0, Math.sign(event.deltaY) * 0.08, true);
      return;
    }
    this.canvas.fitted = false;
    this.canvas.view = zoomAbout(this.canvas.view, Math.pow(2, -event.deltaY / 240), x, y);
    this.canvas.request();
  }

  key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const size = store.size.value;
    const at = cursor.value ?? { x: Math.floor(size.width / 2), y: Math.floor(size.height / 2) };
    const arrow = arrows[event.key];
    if (this.cameraKey(event, arrow)) {
      // done
    } else if (arrow) this.step(at, arrow, event.shiftKey ? 10 : 1);
    else if (event.key === "+" || event.key === "=") this.canvas.zoomBy("in");
    else if (event.key === "-") this.canvas.zoomBy("out");
    else if (event.key === "f" || event.key === "F") this.canvas.zoomBy("fit");
    else if (event.key === "1") this.canvas.zoomBy("one");
    else if (event.key === "e") store.expose(store.stops.value + 0.25);
    else if (event.key === "E") store.expose(store.stops.value - 0.25);
    else if (event.key === "0") store.expose(0);
    else if (event.key === "Enter" && (mode.value === "pick" || mode.value === "paths")) this.choose(at);
    else if (event.key === "Escape") mode.value = "look";
    else return;
    event.preventDefault();
  }

  keyUp(): void {
    if (!this.flying) return;
    this.flying = false;
    flyBy(0, 0, 0, true);
  }

  /** Keys that move the camera, in the modes that do; whether this was one. */
  private cameraKey(event: KeyboardEvent, arrow: [number, number] | undefined): boolean {
    if (!movesCamera(mode.value) || readOnly.value) return false;
    const flight = mode.value === "fly" ? flights[event.key.toLowerCase()] : undefined;
    if (flight) {
      this.flying = true;
      const far = event.shiftKey ? 5 : 1;
      flyBy(flight[0] * far, flight[1] * far, flight[2] * far, false);
    } else if (arrow) {
      const kind = event.shiftKey ? "pan" : mode.value === "fly" ? "turn" : "orbit";
      moveCamera(kind, arrow[0] * 0.05, arrow[1] * 0.05, true);
    } else return false;
    return true;
  }

  private step(at: Pixel, by: [number, number], far: number): void {
    const next = this.canvas.pixel([at.x + by[0] * far + 0.5, at.y + by[1] * far + 0.5]);
    if (!next) return;
    cursor.value = next;
    probeAt(next, true);
  }

  private cropTo(from: [number, number], to: [number, number]): void {
    const { width, height } = store.size.value;
    const inside = (v: number, most: number): number => Math.round(Math.min(most, Math.max(0, v)));
    this.canvas.cropDrag = [
      inside(Math.min(to[0], from[0]), width), inside(Math.min(to[1], from[1]), height),
      inside(Math.max(to[0], from[0]), width), inside(Math.max(to[1], from[1]), height),
    ];
    this.canvas.request();
  }

  private choose(at: Pixel | null): void {
    if (!at) return;
    if (mode.value === "pick") void pick(at);
    if (mode.value === "paths") {
      batch(() => {
        pathPixel.value = at;
        tab.value = "paths";
      });
    }
  }
}

async function pick(at: Pixel): Promise<void> {
  const found = await ask<{ component: number | null }>("pick", { x: at.x, y: at.y });
  if (found?.component) selected.value = found.component;
}
