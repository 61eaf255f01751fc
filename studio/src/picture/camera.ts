// Moves of the camera by mouse and keys. While one is asked for, further ones are added up: a slow program gets few, large steps.
import type { Component } from "../model/protocol.ts";
import { components, root, selectedComponent } from "../model/state.ts";
import { ask } from "../model/studio.ts";
import { isUse } from "../tree/rows.ts";

/** `turn`: about the camera's own place. `fly`: from place to place. */
export type CameraMove = "orbit" | "pan" | "dolly" | "turn" | "fly";
type Numbers = [number, number, number];

interface Waiting {
  kind: CameraMove;
  by: Numbers;
  final: boolean;
}

let waiting: Waiting[] = [];
let sending: Promise<void> | null = null;

/** The moves that were made are with the program after this: what undoes them, or saves where they led, comes behind them. */
export async function cameraMoved(): Promise<void> {
  await sending;
}

/** `x`, `y`: parts of the picture's height, to the right and down, by which the mouse moved. */
export function moveCamera(kind: CameraMove, x: number, y: number, final: boolean): void {
  wait(kind, [x, y, 0], final);
}

/** Steps to the right, up and forward: each a twentieth of the way to what the camera looks at. */
export function flyBy(right: number, up: number, forward: number, final: boolean): void {
  const step = distance() / 20;
  wait("fly", [right * step, up * step, forward * step], final);
}

function wait(kind: CameraMove, by: Numbers, final: boolean): void {
  const last = waiting[waiting.length - 1];
  if (last?.kind === kind) {
    last.by = last.by.map((v, i) => v + (by[i] as number)) as Numbers;
    last.final ||= final;
  } else waiting.push({ kind, by, final });
  sending ??= send();
}

async function send(): Promise<void> {
  await null; // so that it is known to be sending before it can have ended
  try {
    for (let next = waiting.shift(); next; next = waiting.shift()) {
      const { kind, by, final }: Waiting = next;
      if (!(await ask(kind === "turn" ? "fly" : kind, { ...step(kind, by), final }))) break;
    }
  } finally {
    sending = null;
    waiting = [];
  }
}

function step(kind: CameraMove, [x, y, z]: Numbers): Record<string, number> {
  switch (kind) {
    case "orbit": // radians: the height of the picture is half a turn
      return { x: -x * Math.PI, y: y * Math.PI };
    case "pan":
      return { x: -x, y };
    case "dolly": // a ratio of distances
      return { x: Math.exp(y + x), y: 0 };
    case "turn": // what is seen follows the hand
      return { x: -x * 0.8, y: y * 0.8 };
    case "fly":
      return { right: x, up: y, forward: z };
  }
}

/** The camera of the job. */
export function camera(): Component | undefined {
  const job = root.value === null ? undefined : components.value.get(root.value);
  const value = job?.members.camera?.value;
  return isUse(value) ? components.value.get(value.component) : undefined;
}

/** From the camera to what it looks at [m]. */
function distance(): number {
  const { from, to } = camera()?.members ?? {};
  const [a, b] = [from?.value, to?.value];
  if (!Array.isArray(a) || !Array.isArray(b)) return 1;
  return Math.hypot(...a.map((v, i) => Number(v) - Number(b[i])));
}

/** Looks at the selected object. */
export function frameSelected(): void {
  const component = selectedComponent.value;
  if (component) void ask("frame", { component: component.id });
}
