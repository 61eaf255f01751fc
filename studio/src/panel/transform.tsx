// A transform: its steps with their numbers, or the expression as it is written.
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { readSteps, writeSteps, type Step } from "../model/expressions.ts";
import { brief } from "../model/numbers.ts";
import { Button } from "../parts/parts.tsx";
import { texts } from "../texts/texts.ts";
import { resetMember, setMember } from "./edit.ts";
import { Entry } from "./entry.tsx";
import type { FieldProps } from "./field_props.ts";

const t = texts.panel.transform;
const names: Record<string, string[]> = { translate: ["x", "y", "z"], rotate: ["angle", "axis"], scale: ["x", "y", "z"] };
const fresh: Record<string, Step> = {
  translate: { call: "translate", parts: ["0", "0", "0"] },
  rotate: { call: "rotate", parts: ["0 deg", '"y"'] },
  scale: { call: "scale", parts: ["1"] },
};

export function TransformField({ component, member, state, id }: FieldProps): JSX.Element {
  const asText = useSignal(false);
  const value = state.value;
  const matrix = typeof value === "object" && value !== null && "transform" in value ? value.transform.matrix : undefined;
  const steps = !state.written && matrix && isIdentity(matrix) ? [] : readSteps(state.text);
  const set = async (next: Step[]): Promise<boolean> => {
    if (next.length) return setMember(component.id, member.name, writeSteps(next));
    await resetMember(component.id, member.name);
    return true;
  };
  if (!steps || asText.value) {
    return (
      <div class="transform">
        <Entry id={id} text={state.text} label={member.name} lines commit={(text) => setMember(component.id, member.name, text)} />
        {steps && <Button label={t.asSteps} onClick={() => (asText.value = false)} />}
        {matrix && <Matrix numbers={matrix} />}
      </div>
    );
  }
  return (
    <div class="transform" id={id} role="group" aria-label={member.name}>
      {steps.map((step, at) => (
        <div class="step" key={at}>
          <span class="call">{t.calls[step.call as "translate"]}</span>
          <span class="parts">
            {step.parts.map((part, i) => (
              <Entry key={i} label={`${step.call} ${names[step.call]?.[i] ?? ""}`} text={part} placeholder={names[step.call]?.[i]}
                commit={(text) => set(steps.map((s, j) => (j === at ? { ...s, parts: s.parts.map((p, k) => (k === i ? text : p)) } : s)))} />
            ))}
          </span>
          <Button icon="close" label={t.remove} onClick={() => void set(steps.filter((_, j) => j !== at))} />
        </div>
      ))}
      <div class="cluster wrap">
        {Object.keys(fresh).map((call) => (
          <Button key={call} icon="add" text label={t.calls[call as "translate"]} onClick={() => void set([fresh[call] as Step, ...steps])} />
        ))}
        <Button label={t.asText} onClick={() => (asText.value = true)} />
      </div>
    </div>
  );
}

function isIdentity(matrix: number[]): boolean {
  return matrix.every((n, i) => n === (i % 5 === 0 ? 1 : 0));
}

function Matrix({ numbers }: { numbers: number[] }): JSX.Element {
  return (
    <table class="matrix" aria-label={t.matrix}>
      <tbody>
        {[0, 1, 2].map((row) => (
          <tr key={row}>
            {numbers.slice(4 * row, 4 * row + 4).map((n, i) => (
              <td key={i}>{brief(n, 4)}</td>
            ))}
          </tr>
        ))}
      </tbody>
    </table>
  );
}
