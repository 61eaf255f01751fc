// One member of a component: its name, what it is set by, back to the default, help, and what is wrong.
import type { JSX } from "preact";
import type { Member } from "../model/classes.ts";
import { writeDefault } from "../model/classes.ts";
import type { Component } from "../model/protocol.ts";
import { Button } from "../parts/parts.tsx";
import { texts } from "../texts/texts.ts";
import { ColorField } from "./color.tsx";
import { ComponentField, ComponentList } from "./component.tsx";
import { dropKept, kept, key, resetMember, wrong } from "./edit.ts";
import { explain } from "./explanation.tsx";
import type { FieldProps } from "./field_props.ts";
import { FileField, FileList } from "./file.tsx";
import { NumberField } from "./number.tsx";
import { BooleanField, ChoiceField, ChoicesField, ExpressionField, TextField } from "./simple.tsx";
import { TransformField } from "./transform.tsx";
import { VectorField } from "./vector.tsx";

const t = texts.panel;

export function Field({ component, member }: { component: Component; member: Member }): JSX.Element | null {
  const told = component.members[member.name];
  if (!told) return null;
  const waiting = kept.value.get(key(component.id, member.name));
  const state = waiting ? { ...told, text: waiting.text } : told;
  const id = `field-${component.id}-${member.name}`;
  const problems = [...wrong.value].filter(([k]) => k === key(component.id, member.name) || k.startsWith(`${key(component.id, member.name)}.`));
  const props = { component, member, state, id };
  return (
    <div class={`field type-${member.type}${state.written ? " written" : ""}${state.matters ? "" : " idle"}${problems.length ? " has-wrong" : ""}`}
      title={state.matters ? undefined : t.doesNotMatter} onFocusIn={() => explain(member)} onMouseEnter={() => explain(member)}
      onKeyDown={(e) => e.key === "Escape" && dropKept(component.id, member.name)}>
      <label for={id} title={member.text}>
        {member.name.replace(/_/g, " ")}
      </label>
      <div class="control">{control(props)}</div>
      <div class="after">
        {state.written && !member.required && (
          <Button icon="reset" label={t.reset(member.name, writeDefault(member.default, member.type))} onClick={() => void resetMember(component.id, member.name)} />
        )}
      </div>
      {problems.map(([, message]) => (
        <p class="wrong" role="alert" id={`${id}-wrong`}>{message}</p>
      ))}
      {waiting && (
        <p class="waiting">
          {t.waits} <Button label={t.drop} onClick={() => dropKept(component.id, member.name)} />
        </p>
      )}
      <p class="help" id={`${id}-help`}>{member.text}</p>
    </div>
  );
}

/** What a member is set by, chosen by its type. */
function control(props: FieldProps): JSX.Element {
  const { member } = props;
  if (member.type === "component") return member.list ? <ComponentList {...props} /> : <ComponentField {...props} />;
  if (member.list) {
    if (member.type === "file") return <FileList {...props} />;
    return member.choices ? <ChoicesField {...props} /> : <ExpressionField {...props} />;
  }
  switch (member.type) {
    case "number":
    case "integer":
      return <NumberField {...props} />;
    case "boolean":
      return <BooleanField {...props} />;
    case "choice":
      return <ChoiceField {...props} />;
    case "string":
      return member.choices ? <ChoiceField {...props} /> : <TextField {...props} />;
    case "file":
      return <FileField {...props} />;
    case "color":
      return <ColorField {...props} />;
    case "transform":
      return <TransformField {...props} />;
    case "vector2":
    case "vector3":
    case "point2":
    case "point3":
    case "normal3":
      return <VectorField {...props} />;
    default:
      return <ExpressionField {...props} />;
  }
}
