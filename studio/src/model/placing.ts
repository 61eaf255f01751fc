// Where an object stands, and what its transform's text becomes when it is moved, turned or scaled by hand.
import { Matrix4, Vector3 } from "three";
import { readSteps, writeSteps, type Step } from "./expressions.ts";
import { brief, convert, inUnitOf } from "./numbers.ts";
import type { Component, Data, Use } from "./protocol.ts";

export type Triple = [number, number, number];

/** How something is moved by hand: along, about an axis, or larger. Lengths are in metres, angles in radians. */
export type Change =
  | { kind: "move"; by: Triple }
  | { kind: "turn"; axis: Triple; angle: number }
  | { kind: "scale"; by: Triple };

/** The matrix of a transform as the program tells it, 12 numbers row by row; null while it moves, for it then has none. */
export function matrixOf(value: Data | undefined): Matrix4 | null {
  if (typeof value !== "object" || value === null || !("transform" in value) || !value.transform.matrix) return null;
  const m = value.transform.matrix as number[];
  const [a, b, c, d, e, f, g, h, i, j, k, l] = m as [number, number, number, number, number, number, number, number, number, number, number, number];
  return new Matrix4().set(a, b, c, d, e, f, g, h, i, j, k, l, 0, 0, 0, 1);
}

/** From the coordinates in which the transform of what stands in `use` places it, to those of the world: all scenes it is inside of. */
export function frameOf(use: Use | null, all: ReadonlyMap<number, Component>): Matrix4 {
  const frame = new Matrix4();
  for (let at = use; at; ) {
    const holder = all.get(at.id);
    const own = matrixOf(holder?.members.transform?.value);
    if (own) frame.premultiply(own);
    at = holder?.uses[0] ?? null;
  }
  return frame;
}

/** A change that was made in the world, as one in the coordinates of a frame. */
export function changeIn(frame: Matrix4, change: Change): Change {
  if (change.kind === "scale") return change; // along the object's own axes
  const inverse = frame.clone().setPosition(0, 0, 0).invert();
  if (change.kind === "move") return { kind: "move", by: new Vector3(...change.by).applyMatrix4(inverse).toArray() as Triple };
  return { ...change, axis: new Vector3(...change.axis).applyMatrix4(inverse).normalize().toArray() as Triple };
}

const number = /^\s*([-+]?[\d.]+(?:e[-+]?\d+)?)\s*([a-z]+)?\s*$/i;

/** What is written, in a unit, or undefined for names and arithmetic. */
function read(part: string | undefined, unit: string): number | undefined {
  const found = number.exec(part ?? "");
  if (!found) return undefined;
  const factor = found[2] ? convert(found[2], unit) : 1;
  return factor === undefined ? undefined : Number(found[1]) * factor;
}

/** The axis as the language writes it: by its letter where it is one of the coordinates'. */
function axisText(axis: Triple): { text: string; sign: number } {
  const at = axis.findIndex((a) => Math.abs(a) > 0.9999995);
  if (at >= 0) return { text: `"${"xyz"[at]}"`, sign: Math.sign(axis[at] as number) };
  return { text: `[${axis.map((a) => brief(a, 5)).join(", ")}]`, sign: 1 };
}

/** What the steps, the last of which happens first, become by a change. Turning and scaling are about the object's own origin. */
export function changed(steps: Step[], change: Change): Step[] {
  const next = steps.map((s) => ({ ...s, parts: [...s.parts] }));
  if (change.kind === "move") {
    const first = next[0]?.call === "translate" ? next[0] : undefined;
    const before = first?.parts.map((p) => read(p, "m"));
    if (first && before?.length === 3 && before.every((v) => v !== undefined)) {
      first.parts = first.parts.map((part, i) => inUnitOf(part, tidy((before[i] as number) + change.by[i as 0]), "m"));
    } else next.unshift({ call: "translate", parts: change.by.map((v) => brief(tidy(v))) });
  } else if (change.kind === "turn") {
    // Behind the leading translation, which then keeps the origin where it is.
    const at = next[0]?.call === "translate" ? 1 : 0;
    const { text, sign } = axisText(change.axis);
    const degrees = (change.angle * sign * 180) / Math.PI;
    const same = next[at]?.call === "rotate" && next[at]?.parts[1]?.trim() === text ? next[at] : undefined;
    const before = read(same?.parts[0], "deg");
    if (same && before !== undefined) same.parts = [`${brief(turnsOff(before + degrees), 5)} deg`, text];
    else next.splice(at, 0, { call: "rotate", parts: [`${brief(turnsOff(degrees), 5)} deg`, text] });
  } else {
    const last = next[next.length - 1]?.call === "scale" ? next[next.length - 1] : undefined;
    const before = last?.parts.map((p) => read(p, ""));
    if (last && before?.every((v) => v !== undefined)) {
      last.parts = join(change.by.map((s, i) => s * (before.length === 1 ? (before[0] as number) : (before[i] as number))) as Triple);
    } else next.push({ call: "scale", parts: join(change.by) });
  }
  return next;
}

/** A length that is 0 but for rounding is 0. */
function tidy(length: number): number {
  return Math.abs(length) < 1e-9 ? 0 : Number(length.toPrecision(6));
}

/** One factor where all three are the same. */
function join(by: Triple): string[] {
  const parts = by.map((v) => brief(v, 5));
  return parts.every((p) => p === parts[0]) ? [parts[0] as string] : parts;
}

/** Between half a turn back and half a turn on. */
function turnsOff(degrees: number): number {
  return tidy(degrees - 360 * Math.round(degrees / 360));
}

/** The text of a transform after a change. `written` is false where the text is only what would be written for the default. */
export function changedText(text: string, written: boolean, change: Change): string {
  const steps = written ? readSteps(text) : [];
  if (steps) return writeSteps(changed(steps, change));
  const whole = `(${text})`;
  const step = writeSteps(changed([], change));
  // Of what is a matrix, a name or keyframes, only the outermost and the innermost step can be added.
  return change.kind === "move" ? `${step} * ${whole}` : `${whole} * ${step}`;
}
