// What is moved by hand in the drawing: the object that is selected, or that what is selected belongs to.
import { computed, signal } from "@preact/signals";
import type { JSX } from "preact";
import { Quaternion, Vector3 } from "three";
import { changeIn, changedText, frameOf, matrixOf, type Change, type Triple } from "../model/placing.ts";
import type { Component, MemberState, Use } from "../model/protocol.ts";
import { classes, components, locked, placeOfSelected, selectedComponent } from "../model/state.ts";
import { demand } from "../model/studio.ts";
import { Dragging } from "../panel/edit.ts";
import { Button } from "../parts/parts.tsx";
import { texts } from "../texts/texts.ts";
import type { Held, Mode } from "./gizmo.ts";

const t = texts.space;

export const gizmoMode = signal<Mode>("translate");

interface Target {
  component: Component;
  use: Use | null;
  state: MemberState;
}

/** The nearest component with a transform: the selected one, or what holds it. The scene of the job itself stays where it is. */
export const target = computed<Target | null>(() => {
  let component = selectedComponent.value;
  let use = placeOfSelected.value;
  for (let i = 0; component && i < 100; ++i) {
    const state = component.members.transform;
    if (state && classes.value.member(component.class, "transform")?.type === "transform") {
      const job = use ? components.value.get(use.id)?.class === "Job" : true;
      return job || component.written !== "text" ? null : { component, use, state };
    }
    component = (use && components.value.get(use.id)) ?? null;
    use = component?.uses[0] ?? null;
  }
  return null;
});

/** Where the target is, and its wires; null for what has no place that does not move. */
export async function heldNow(): Promise<Held | null> {
  const now = target.value;
  const own = now && matrixOf(now.state.value);
  if (!now || !own) return null;
  const placed = frameOf(now.use, components.value).multiply(own);
  const origin = new Vector3().setFromMatrixPosition(placed);
  const axes = new Quaternion();
  placed.decompose(new Vector3(), axes, new Vector3());
  let found: { lines: number[]; low: Triple | null; high: Triple | null } = { lines: [], low: null, high: null };
  try {
    found = await demand("wireframe", { component: now.component.id });
  } catch {
    // then it is held by its origin
  }
  const { low, high } = found;
  const centre: Triple = low && high ? [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2] : [origin.x, origin.y, origin.z];
  return { centre, origin: [origin.x, origin.y, origin.z], axes: [axes.x, axes.y, axes.z, axes.w], lines: found.lines };
}

/** Edits the target's transform while its handles are dragged: one step of undo. */
export class Placement {
  private drag: Dragging | null = null;
  private start: Target | null = null;

  take(change: Change | null, step: "begin" | "drag" | "end"): void {
    if (step === "begin") {
      this.start = locked.value === null ? target.peek() : null;
      this.drag = this.start && new Dragging(this.start.component.id, "transform");
    }
    if (change && this.drag && this.start) {
      const { state, use } = this.start;
      this.drag.set(changedText(state.text, state.written, changeIn(frameOf(use, components.peek()), change)));
    }
    if (step === "end") this.start = this.drag = null;
  }
}

export function GizmoBar(): JSX.Element {
  const now = target.value;
  const off = !now || locked.value !== null;
  const modes: { mode: Mode; label: string }[] = [
    { mode: "translate", label: t.move },
    { mode: "rotate", label: t.turn },
    { mode: "scale", label: t.scale },
  ];
  return (
    <div class="toolbar" role="toolbar" aria-label={t.gizmo}>
      <div class="cluster" role="group" aria-label={t.gizmo}>
        {modes.map(({ mode, label }) => (
          <Button key={mode} label={label} pressed={gizmoMode.value === mode} disabled={off} onClick={() => (gizmoMode.value = mode)} />
        ))}
      </div>
      <span class="dim">{now ? t.target(now.component.name ?? now.component.class) : t.noTarget}</span>
    </div>
  );
}
