// Moves of the camera by mouse and keys. While one is asked for, further ones are added up: a slow program gets few, large steps.
import { selectedComponent } from "../model/state.ts";
import { ask } from "../model/studio.ts";

export type CameraMove = "orbit" | "pan" | "dolly" | "fly";

interface Waiting {
  kind: CameraMove;
  x: number;
  y: number;
  final: boolean;
}

let waiting: Waiting | null = null;
let asking = false;

/** `x`, `y`: parts of the picture's height, to the right and down, by which the mouse moved. */
export function moveCamera(kind: CameraMove, x: number, y: number, final: boolean): void {
  if (waiting && waiting.kind === kind) {
    waiting.x += x;
    waiting.y += y;
    waiting.final ||= final;
  } else {
    waiting = { kind, x, y, final };
  }
  if (!asking) void send();
}

async function send(): Promise<void> {
  asking = true;
  try {
    while (waiting) {
      const { kind, x, y, final }: Waiting = waiting;
      waiting = null;
      const done = await ask(kind, step(kind, x, y, final));
      if (!done) break;
    }
  } finally {
    asking = false;
    waiting = null;
  }
}

function step(kind: CameraMove, x: number, y: number, final: boolean): Record<string, unknown> {
  switch (kind) {
    case "orbit": // radians: the height of the picture is half a turn
      return { x: -x * Math.PI, y: y * Math.PI, final };
    case "pan":
      return { x: -x, y, final };
    case "dolly": // a ratio of distances
      return { x: Math.exp(y + x), y: 0, final };
    case "fly":
      return { x, y, final };
  }
}

/** Looks at the selected object. */
export function frameSelected(): void {
  const component = selectedComponent.value;
  if (component) void ask("frame", { component: component.id });
}
