// Vectors, points and directions: a line for each coordinate.
import type { JSX } from "preact";
import { readVector, writeVector } from "../model/expressions.ts";
import { setMember } from "./edit.ts";
import { Entry } from "./entry.tsx";
import type { FieldProps } from "./field_props.ts";
import { ExpressionField } from "./simple.tsx";

const axes = ["x", "y", "z"];

export function VectorField(props: FieldProps): JSX.Element {
  const { component, member, state, id } = props;
  const length = member.type.endsWith("2") ? 2 : 3;
  const vector = readVector(state.text, length);
  if (!vector) return <ExpressionField {...props} />;
  return (
    <div class="vector">
      {vector.parts.map((part, i) => (
        <span key={i}>
          <span class="axis" aria-hidden="true">{axes[i]}</span>
          <Entry id={i === 0 ? id : undefined} label={`${member.name} ${axes[i]}`} text={part}
            commit={(text) => setMember(component.id, member.name, writeVector(vector, i, text))} />
        </span>
      ))}
      <span class="unit">{vector.unit || member.unit || ""}</span>
    </div>
  );
}
