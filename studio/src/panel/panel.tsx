// The panel of the selected component, made from the description of its class alone.
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useLayoutEffect } from "preact/hooks";
import { ownGroupsFirst, type Member } from "../model/classes.ts";
import type { Component } from "../model/protocol.ts";
import { classes, components, locked, notify, placeOfSelected, readOnly, select, selectedComponent } from "../model/state.ts";
import { ask } from "../model/studio.ts";
import { Icon, kindIcon } from "../parts/icons.tsx";
import { inline } from "../parts/markdown.tsx";
import { Button } from "../parts/parts.tsx";
import { texts } from "../texts/texts.ts";
import { choosing, renaming } from "../tree/actions.ts";
import { forgetWrong, unanswered } from "./edit.ts";
import { explain } from "./explanation.tsx";
import { Field } from "./field.tsx";

const t = texts.panel;

export function Panel(): JSX.Element {
  const component = selectedComponent.value;
  // Before anything can be typed into the new panel: an effect after the next frame would take away what was refused meanwhile.
  useLayoutEffect(() => {
    forgetWrong();
    explain(null);
  }, [component?.id]);
  if (!component) return <section class="panel" aria-label={t.label} />; // without a document
  const info = classes.value.find(component.class);
  const elsewhere = component.written === "elsewhere";
  return (
    <section class="panel" data-component={component.id} aria-busy={unanswered.value > 0} aria-label={t.of(component.name ?? component.class)}>
      <Head component={component} />
      {info && <p class="summary">{inline(info.summary)}</p>}
      {elsewhere && <p class="hint">{t.elsewhere(component.file ?? "")}</p>}
      {locked.value && t.locked[locked.value] && <p class="hint">{t.locked[locked.value]}</p>}
      <fieldset disabled={elsewhere || locked.value !== null} class="fields">
        {(info ? ownGroupsFirst(info) : []).map((g) => (
          <Section key={`${component.class}.${g.name}`} name={g.name} members={g.members} component={component} />
        ))}
      </fieldset>
    </section>
  );
}

function Section({ name, members, component }: { name: string; members: Member[]; component: Component }): JSX.Element {
  const closed = useSignal(false);
  const fields = members.map((m) => <Field key={m.name} component={component} member={m} />);
  if (!name) return <div class="group">{fields}</div>;
  const written = members.filter((m) => component.members[m.name]?.written).length;
  return (
    <details class="group" open={!closed.value} onToggle={(e) => (closed.value = !e.currentTarget.open)}>
      <summary>
        {name}
        {written > 0 && <span class="badge" title={t.writtenHere(written)}>{written}</span>}
      </summary>
      {fields}
    </details>
  );
}

/** Asks whether the class does what its interface promises; the answer comes with the checks below the picture. */
async function check(name: string): Promise<void> {
  if (await ask("conform", { class: name })) notify(t.checking(name));
}

function Head({ component }: { component: Component }): JSX.Element {
  const use = placeOfSelected.value;
  const off = locked.value !== null || component.written === "elsewhere";
  const parents: Component[] = [];
  for (let at = use ? components.value.get(use.id) : undefined; at && parents.length < 6; ) {
    parents.unshift(at);
    const above = at.uses[0];
    at = above ? components.value.get(above.id) : undefined;
  }
  return (
    <header class="panel-head">
      {parents.length > 0 && (
        <nav aria-label={t.path}>
          {parents.map((p) => (
            <button key={p.id} type="button" class="link" onClick={() => select(p.id)}>
              {p.name ?? p.class}
            </button>
          ))}
        </nav>
      )}
      <div class="panel-title">
        <span class={`kind kind-${classes.value.kind(component.class)}`}>
          <Icon name={kindIcon(classes.value.kind(component.class))} />
        </span>
        <h2>{component.name ?? component.class}</h2>
        {component.name && <span class="class">{component.class}</span>}
        <span class="spring" />
        {use && <Button label={t.replace} disabled={off} onClick={() => (choosing.value = { what: "replace", component, use })} />}
        <Button icon="check" label={t.check} disabled={readOnly.value} onClick={() => void check(component.class)} />
        {component.written === "text" && use && <Button label={t.name} keys="F2" disabled={off} onClick={() => (renaming.value = component)} />}
      </div>
      {component.uses.length > 1 && (
        <p class="hint">
          <Icon name="link" /> {t.usedIn(component.uses.length)}{" "}
          {component.uses.slice(0, 6).map((u) => {
            const user = components.value.get(u.id);
            return (
              <button key={`${u.id}.${u.member}.${u.index}`} type="button" class="link" onClick={() => select(u.id)}>
                {user?.name ?? user?.class}
              </button>
            );
          })}
        </p>
      )}
    </header>
  );
}
