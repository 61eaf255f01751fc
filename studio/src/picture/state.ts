// What is chosen about the picture: what the mouse does, the zoom, the part that is rendered.
import { signal } from "@preact/signals";
import { demand, report } from "../model/studio.ts";
import type { Pixel } from "./probe.ts";

export type Mode = "look" | "crop" | "orbit" | "fly" | "pick" | "paths";
export const mode = signal<Mode>("look");
export const zoom = signal(1);
/** The rectangle that alone is rendered, x0, y0, x1, y1. */
export const crop = signal<[number, number, number, number] | null>(null);
/** The pixel whose paths are shown. */
export const pathPixel = signal<Pixel | null>(null);

export const movesCamera = (m: Mode): boolean => m === "orbit" || m === "fly";

export type Command = "fit" | "one" | "in" | "out";
const commands = new EventTarget();
export function command(name: Command): void {
  commands.dispatchEvent(new CustomEvent("command", { detail: name }));
}

/** Gives what ends it. */
export function onCommand(obey: (name: Command) => void): () => void {
  const listener = (event: Event): void => obey((event as CustomEvent<Command>).detail);
  commands.addEventListener("command", listener);
  return () => commands.removeEventListener("command", listener);
}

export async function setCrop(area: [number, number, number, number] | null): Promise<void> {
  try {
    await demand("crop", { area });
    crop.value = area;
  } catch (error) {
    report(error);
  }
}
