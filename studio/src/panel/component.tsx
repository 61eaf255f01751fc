// References to components: one, or a list of them.
import type { JSX } from "preact";
import type { Component, Use } from "../model/protocol.ts";
import { classes, components, select } from "../model/state.ts";
import { ask } from "../model/studio.ts";
import { Icon, kindIcon } from "../parts/icons.tsx";
import { Button } from "../parts/parts.tsx";
import { texts } from "../texts/texts.ts";
import { choosing, moveTo } from "../tree/actions.ts";
import { label } from "../tree/tree.tsx";
import { isUse } from "../tree/rows.ts";
import { ColorEntry, colorOf } from "./color.tsx";
import { setMember } from "./edit.ts";
import type { FieldProps } from "./field_props.ts";

const t = texts.panel;

/** What one of the things a map may be written as, a number or a colour, is worth. */
function literal(child: Component | undefined): boolean {
  return child !== undefined && child.class === "ConstantMap" && (child.written === "literal" || child.written === "default");
}

export function ComponentField({ component, member, state, id }: FieldProps): JSX.Element {
  const child = isUse(state.value) ? components.value.get(state.value.component) : undefined;
  const use: Use = { id: component.id, member: member.name };
  if (!child) {
    return (
      <div class="reference" id={id}>
        <span class="dim">{t.noComponent}</span>
        <Button icon="add" label={t.addTo(member.name)} onClick={() => void offer(component, member.name)} />
      </div>
    );
  }
  if (literal(child) && child.members.value) {
    return (
      <div class="reference literal">
        <ColorEntry id={id} component={component} member={member} state={{ text: state.text ?? "" }} color={colorOf(child.members.value.value)} />
        <Button icon="ObjectMap" label={t.replaceMap(member.name)} onClick={() => (choosing.value = { what: "replace", component: child, use })} />
      </div>
    );
  }
  return (
    <div class="reference">
      <Go component={child} use={use} id={id} />
      <Button icon="swap" label={t.replaceIn(member.name)} onClick={() => (choosing.value = { what: "replace", component: child, use })} />
      {member.default === null && !member.required && (
        <Button icon="close" label={t.setNone(member.name)} onClick={() => void setMember(component.id, member.name, "none")} />
      )}
    </div>
  );
}

/** Adds the class if there is only one; else opens the window of classes. */
async function offer(component: Component, member: string): Promise<void> {
  const wanted = classes.value.member(component.class, member)?.class ?? "";
  const offered = classes.value.offered(wanted);
  if (offered.length === 1 && offered[0]) {
    await ask("add", { component: component.id, member, class: offered[0].name });
  } else {
    chooseFor(component, member);
  }
}

function chooseFor(component: Component, member: string): void {
  choosing.value = { what: "add", component, use: null, member };
}

function Go({ component, use, id }: { component: Component; use: Use; id?: string }): JSX.Element {
  const kind = classes.value.kind(component.class);
  return (
    <button id={id} type="button" class={`go${component.written === "default" ? " default" : ""}`} onClick={() => select(component.id, use)}>
      <span class={`kind kind-${kind}`}>
        <Icon name={kindIcon(kind)} />
      </span>
      <span class="what">{label(component)}</span>
      {component.name && <span class="class">{component.class}</span>}
      {component.uses.length > 1 && <Icon name="link" />}
    </button>
  );
}

const mostShown = 50;

export function ComponentList({ component, member, state, id }: FieldProps): JSX.Element {
  const entries = Array.isArray(state.value) ? state.value : [];
  const place = (index: number): Use => ({ id: component.id, member: member.name, index });
  return (
    <div class="list" id={id} role="group" aria-label={member.name}>
      {entries.slice(0, mostShown).map((entry, i) => {
        const child = isUse(entry) ? components.value.get(entry.component) : undefined;
        return (
          <div class="reference" key={i}>
            {child && <Go component={child} use={place(i)} />}
            <Button icon="up" label={t.up(i + 1)} disabled={i === 0} onClick={() => void moveTo(place(i), place(i - 1))} />
            <Button icon="close" label={t.removeFrom(i + 1)} onClick={() => void ask("remove", { component: component.id, member: member.name, index: i })} />
          </div>
        );
      })}
      {entries.length > mostShown && <p class="dim">{t.andMore(entries.length - mostShown)}</p>}
      <Button icon="add" text label={t.add} onClick={() => chooseFor(component, member.name)} />
    </div>
  );
}
