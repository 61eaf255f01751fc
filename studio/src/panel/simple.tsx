// Truth, choices, texts, and expressions that have no better field.
import type { JSX } from "preact";
import { quote } from "../model/expressions.ts";
import { texts } from "../texts/texts.ts";
import { setMember } from "./edit.ts";
import { Entry } from "./entry.tsx";
import type { FieldProps } from "./field_props.ts";

export function BooleanField({ component, member, state, id }: FieldProps): JSX.Element {
  return (
    <input
      id={id}
      type="checkbox"
      role="switch"
      class="switch"
      aria-describedby={`${id}-help`}
      checked={state.value === true}
      onChange={(e) => void setMember(component.id, member.name, String(e.currentTarget.checked))}
    />
  );
}

export function ChoiceField({ component, member, state, id }: FieldProps): JSX.Element {
  const written = member.type === "string" ? quote : (name: string): string => (/^[A-Za-z_]\w*$/.test(name) ? name : quote(name));
  return (
    <select id={id} aria-describedby={`${id}-help`} value={String(state.value)} onChange={(e) => void setMember(component.id, member.name, written(e.currentTarget.value))}>
      {(member.choices ?? []).map((c) => (
        <option key={c}>{c}</option>
      ))}
    </select>
  );
}

/** A list of texts out of some: each is there or not. */
export function ChoicesField({ component, member, state, id }: FieldProps): JSX.Element {
  const chosen = Array.isArray(state.value) ? state.value.map(String) : [];
  const toggle = (name: string, on: boolean): void => {
    const next = on ? [...chosen, name] : chosen.filter((c) => c !== name);
    void setMember(component.id, member.name, `[${next.map(quote).join(", ")}]`);
  };
  // One that ends with "…" stands for all that begin so: they are written.
  const closed = (member.choices ?? []).filter((c) => !c.endsWith("…"));
  return (
    <div class="choices" role="group" id={id} aria-label={member.name}>
      {closed.length < (member.choices ?? []).length && (
        <Entry id={`${id}-all`} text={state.text} label={member.name} commit={(text) => setMember(component.id, member.name, text)} />
      )}
      {closed.map((c) => (
        <label key={c} class="check">
          <input type="checkbox" checked={chosen.includes(c)} onChange={(e) => toggle(c, e.currentTarget.checked)} />
          {c}
        </label>
      ))}
    </div>
  );
}

export function TextField({ component, member, state, id }: FieldProps): JSX.Element {
  const text = typeof state.value === "string" ? state.value : "";
  return <Entry id={id} text={text} label={member.name} lines={text.includes("\n")} commit={(now) => setMember(component.id, member.name, quote(now))} />;
}

/** Lists of numbers, points and the like, as the text writes them. Long ones are told, not shown. */
export function ExpressionField({ component, member, state, id }: FieldProps): JSX.Element {
  const value = state.value;
  if (typeof value === "object" && value !== null && "large" in value) {
    return <output id={id} class="large">{texts.panel.large(value.large.rows, value.large.width)}</output>;
  }
  return <Entry id={id} text={state.text} label={member.name} lines={state.text.length > 34 || state.text.includes("\n")}
    commit={(text) => setMember(component.id, member.name, text)} />;
}
