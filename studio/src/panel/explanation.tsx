// The description of one member below the panel, where its length does not move what a mouse is about to press.
import { signal } from "@preact/signals";
import type { JSX } from "preact";
import { writeDefault, type Member } from "../model/classes.ts";
import { inline } from "../parts/markdown.tsx";
import { texts } from "../texts/texts.ts";

const t = texts.panel;

/** The member in focus or under the mouse. */
const explained = signal<Member | null>(null);

export function explain(member: Member | null): void {
  explained.value = member;
}

export function Explanation(): JSX.Element {
  const member = explained.value;
  return (
    <footer class="explanation">
      {member ? (
        <>
          <b>{member.name}</b> {inline(member.text)}
          <span class="facts">{facts(member)}</span>
        </>
      ) : (
        <span>{t.explain}</span>
      )}
    </footer>
  );
}

/** Unit, range and default in one line. */
function facts(member: Member): string {
  const range = member.range;
  const bounds = [
    range?.low !== undefined ? `≥ ${range.low}` : range?.more_than !== undefined ? `> ${range.more_than}` : "",
    range?.high !== undefined ? `≤ ${range.high}` : range?.less_than !== undefined ? `< ${range.less_than}` : "",
  ].filter(Boolean).join(", ");
  const standard = writeDefault(member.default, member.type);
  return [member.unit ?? "", bounds, member.required ? t.required : t.default(standard.length > 60 ? "…" : standard), member.effect ? t.effects[member.effect] : ""]
    .filter(Boolean)
    .join(" · ");
}
