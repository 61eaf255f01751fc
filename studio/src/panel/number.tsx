// A number with its unit, and a slider over what is usual.
import type { JSX } from "preact";
import { useRef } from "preact/hooks";
import { brief, fromSlider, inUnitOf, toSlider, type Scale } from "../model/numbers.ts";
import type { FieldProps } from "./field_props.ts";
import { Dragging, setMember } from "./edit.ts";
import { Entry } from "./entry.tsx";

export function NumberField({ component, member, state, id }: FieldProps): JSX.Element {
  const drag = useRef<Dragging | null>(null);
  const value = typeof state.value === "number" ? state.value : null;
  const integer = member.type === "integer";
  const scale: Scale | null = member.slider ? { low: member.slider[0], high: member.slider[1], logarithmic: member.logarithmic ?? false, integer } : null;
  const unit = member.unit ?? "";
  const plain = /^\s*[-+]?[\d.]+(e[-+]?\d+)?\s*$/i.test(state.text);
  const same = unit !== "" && new RegExp(`^\\s*[-+]?[\\d.]+(e[-+]?\\d+)?\\s*${unit}\\s*$`, "i").test(state.text); // it says it itself

  const step = (by: number, key: boolean): void => {
    if (value === null) return;
    const size = integer ? 1 : scale && !scale.logarithmic ? (scale.high - scale.low) / 100 : Math.max(Math.abs(value) * 0.05, 1e-9);
    const next = Number((value + by * size).toPrecision(integer ? 12 : 4));
    const low = member.range?.low ?? -Infinity;
    const high = member.range?.high ?? Infinity;
    drag.current ??= new Dragging(component.id, member.name);
    drag.current.set(inUnitOf(state.text, Math.min(high, Math.max(low, next)), unit));
    if (!key) drag.current = null;
  };

  return (
    <div class="number">
      <Entry
        id={id}
        text={state.text}
        label={member.name}
        commit={(text) => setMember(component.id, member.name, text)}
        onKeyDown={(e) => {
          if ((e.key !== "ArrowUp" && e.key !== "ArrowDown") || e.currentTarget.value !== state.text) return;
          e.preventDefault();
          step((e.key === "ArrowUp" ? 1 : -1) * (e.shiftKey ? 10 : 1), true);
        }}
        onBlur={() => (drag.current = null)}
      />
      {unit && !same && <span class={`unit${plain ? "" : " told"}`}>{plain ? unit : value === null ? "" : `= ${brief(value, 4)} ${unit}`}</span>}
      {!unit && !plain && value !== null && <span class="unit told">= {brief(value, 4)}</span>}
      {scale && (
        <input
          type="range"
          aria-label={member.name}
          aria-valuetext={state.text}
          min={0}
          max={1}
          step={integer && !scale.logarithmic ? 1 / Math.max(1, scale.high - scale.low) : 0.002}
          value={value === null ? 0 : toSlider(value, scale)}
          onInput={(e) => {
            drag.current ??= new Dragging(component.id, member.name);
            drag.current.set(inUnitOf(state.text, fromSlider(Number(e.currentTarget.value), scale), unit));
          }}
          onChange={() => (drag.current = null)}
        />
      )}
    </div>
  );
}
