// As much of the render description language as panels need: to take lists and products of transforms apart, and put them together again.
import { brief, convert } from "./numbers.ts";

/** Splits at a separator that stands outside of all brackets and quotes. */
export function splitOutside(text: string, separator: "," | "*"): string[] {
  const parts: string[] = [];
  let depth = 0;
  let quoted = false;
  let from = 0;
  for (let i = 0; i < text.length; ++i) {
    const c = text[i] as string;
    if (quoted) {
      if (c === "\\") ++i;
      else if (c === '"') quoted = false;
    } else if (c === '"') quoted = true;
    else if ("([{".includes(c)) ++depth;
    else if (")]}".includes(c)) --depth;
    else if (c === separator && depth === 0) {
      parts.push(text.slice(from, i).trim());
      from = i + 1;
    }
  }
  parts.push(text.slice(from).trim());
  return parts;
}

export interface VectorText {
  parts: string[];
  /** What is written behind the bracket, as "mm", or "". */
  unit: string;
}

/** `[a, b, c] mm` taken apart, or null for anything else, or with comments in it. */
export function readVector(text: string, length: number): VectorText | null {
  const found = /^\[([^#]*)\]\s*([a-z]*)$/i.exec(text.trim());
  if (!found) return null;
  const parts = splitOutside(found[1] as string, ",");
  return parts.length === length && parts.every((p) => p !== "") ? { parts, unit: found[2] ?? "" } : null;
}

/** Puts a vector together with one part anew. A part with a unit of its own is brought to the unit that stands behind the bracket. */
export function writeVector(vector: VectorText, at: number, part: string): string {
  const own = /^\s*([-+]?[\d.]+(?:e[-+]?\d+)?)\s*([a-z]+)\s*$/i.exec(part);
  const factor = own && vector.unit ? convert(own[2] as string, vector.unit) : undefined;
  const written = own && factor !== undefined ? brief(Number(own[1]) * factor, 9) : part.trim();
  return `[${vector.parts.map((p, i) => (i === at ? written : p)).join(", ")}]${vector.unit ? ` ${vector.unit}` : ""}`;
}

/** One factor of a product of transforms: a call and what stands in its brackets. */
export interface Step {
  call: string;
  parts: string[];
}

/** `translate(…) * rotate(…)` taken apart; the identity has no steps; null for what is no such product. */
export function readSteps(text: string): Step[] | null {
  const trimmed = text.trim();
  if (trimmed === "identity" || trimmed === "") return [];
  if (trimmed.includes("#")) return null;
  const steps: Step[] = [];
  for (const factor of splitOutside(trimmed, "*")) {
    const found = /^(translate|rotate|scale)\s*\(([^]*)\)$/.exec(factor);
    if (!found || splitOutside(factor.slice(factor.indexOf("(")), ",").length !== 1) return null;
    steps.push({ call: found[1] as string, parts: splitOutside(found[2] as string, ",") });
  }
  return steps;
}

export function writeSteps(steps: Step[]): string {
  return steps.length ? steps.map((s) => `${s.call}(${s.parts.join(", ")})`).join(" * ") : "identity";
}

/** A text as the language writes it. */
export function quote(text: string): string {
  return `"${text.replace(/\\/g, "\\\\").replace(/"/g, '\\"').replace(/\n/g, "\\n").replace(/\t/g, "\\t")}"`;
}
