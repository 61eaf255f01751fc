// The tree of all components. One element has the focus; the row that is meant is told by aria-activedescendant.
import { computed, signal, useComputed, useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";
import type { Component, Use } from "../model/protocol.ts";
import { classes, components, document_, locked, placeOfSelected, root, select, selectedComponent } from "../model/state.ts";
import { Icon, kindIcon } from "../parts/icons.tsx";
import { Button } from "../parts/parts.tsx";
import { Awaited } from "../parts/working.tsx";
import { texts } from "../texts/texts.ts";
import * as actions from "./actions.ts";
import { isUse, rows, type Row } from "./rows.ts";

const t = texts.tree;
const rowHeight = 26;
const opened = signal<ReadonlyMap<number, boolean>>(new Map());
const search = signal("");
const defaults = signal(false);

const shown = computed(() => rows(root.value, components.value, classes.value, { opened: opened.value, defaults: defaults.value, search: search.value }));

const sameUse = (a: Use | null, b: Use | null): boolean => a?.id === b?.id && a?.member === b?.member && a?.index === b?.index;

function open(row: Row, yes: boolean): void {
  opened.value = new Map(opened.value).set(row.component.id, yes);
}

/** The row of what is selected; what is inside something closed has none. */
const current = computed(() => {
  const component = selectedComponent.value;
  const use = placeOfSelected.value;
  const all = shown.value;
  const exact = all.findIndex((r) => r.component === component && sameUse(r.use, use));
  return exact >= 0 ? exact : all.findIndex((r) => r.component === component);
});

export function Tree(): JSX.Element {
  const box = useRef<HTMLDivElement>(null);
  const scroll = useSignal(0);
  const height = useSignal(600);
  const dragged = useSignal<Use | null>(null);
  const over = useSignal(-1);

  useEffect(() => {
    const element = box.current;
    if (!element) return;
    const resize = new ResizeObserver(() => (height.value = element.clientHeight));
    resize.observe(element);
    return () => resize.disconnect();
  }, []);

  // Opens what the selected component is inside of, and scrolls to it.
  useEffect(() => {
    reveal();
    const element = box.current;
    const at = current.value;
    if (!element || at < 0) return;
    const top = at * rowHeight;
    if (top < element.scrollTop) element.scrollTop = top;
    else if (top + rowHeight > element.scrollTop + element.clientHeight) element.scrollTop = top + rowHeight - element.clientHeight;
  }, [selectedComponent.value?.id, placeOfSelected.value?.index]);

  const range = useComputed(() => {
    const first = Math.max(0, Math.floor(scroll.value / rowHeight) - 8);
    return [first, Math.min(shown.value.length, first + Math.ceil(height.value / rowHeight) + 16)] as const;
  });

  const go = (to: number): void => {
    const row = shown.value[Math.min(shown.value.length - 1, Math.max(0, to))];
    if (row) select(row.component.id, row.use);
  };
  const key = (event: KeyboardEvent): void => {
    const at = current.value;
    const row = shown.value[at];
    const command = event.ctrlKey || event.metaKey;
    if (event.altKey && event.key === "ArrowUp") void actions.moveBy(-1);
    else if (event.altKey && event.key === "ArrowDown") void actions.moveBy(1);
    else if (event.key === "ArrowDown") go(at + 1);
    else if (event.key === "ArrowUp") go(at - 1);
    else if (event.key === "Home") go(0);
    else if (event.key === "End") go(shown.value.length - 1);
    else if (event.key === "PageDown") go(at + 15);
    else if (event.key === "PageUp") go(at - 15);
    else if (event.key === "ArrowRight" && row) row.expanded === false ? open(row, true) : row.expanded && go(at + 1);
    else if (event.key === "ArrowLeft" && row) {
      if (row.expanded) open(row, false);
      else go(shown.value.findLastIndex((r, i) => i < at && r.depth < row.depth));
    } else if (event.key === "Delete" && row) void actions.remove();
    else if (event.key === "Insert" && row) actions.choosing.value = { what: "add", component: row.component, use: row.use };
    else if (event.key === "F2" && row) actions.renaming.value = row.component;
    else if (command && event.key === "d") void actions.duplicate();
    else if (event.key === "Enter") document.querySelector<HTMLElement>(".fields input, .fields select, .fields button, .panel button")?.focus();
    else return;
    event.preventDefault();
  };

  const all = shown.value;
  const [first, end] = range.value;
  return (
    <section class="tree-pane" aria-label={t.label}>
      <div class="search">
        <Icon name="search" />
        <input type="search" placeholder={t.search} aria-label={t.search} value={search.value} onInput={(e) => (search.value = e.currentTarget.value)} />
      </div>
      <TreeActions />
      <div
        ref={box}
        class="tree"
        role="tree"
        tabIndex={0}
        aria-label={t.label}
        aria-activedescendant={current.value >= 0 ? `row-${current.value}` : undefined}
        onScroll={(e) => (scroll.value = e.currentTarget.scrollTop)}
        onKeyDown={key}
      >
        {/* what stands between a tree and its items for looks alone tells nothing */}
        <div role="none" style={{ height: `${all.length * rowHeight}px`, position: "relative" }}>
          {all.slice(first, end).map((row, i) => (
            <RowView
              key={`${row.use?.id}.${row.use?.member}.${row.use?.index}.${row.component.id}`}
              row={row}
              at={first + i}
              current={first + i === current.value}
              target={first + i === over.value}
              drag={(use) => (dragged.value = use)}
              inside={dragged.value !== null && actions.placeInside(dragged.value, row.component) !== null}
              enter={(at) => (over.value = dragged.value ? at : -1)}
              drop={(onto) => {
                over.value = -1;
                if (dragged.value && onto) void actions.drop(dragged.value, onto.component, onto.use);
                dragged.value = null;
              }}
            />
          ))}
        </div>
      </div>
      {all.length === 0 && <Awaited>{document_.value?.valid === false ? t.invalid : search.value ? t.nothingFound : t.empty}</Awaited>}
      <label class="check foot">
        <input type="checkbox" checked={defaults.value} onChange={(e) => (defaults.value = e.currentTarget.checked)} />
        {t.defaults}
      </label>
    </section>
  );
}

/** Opens all that the selected component stands in. */
function reveal(): void {
  if (current.value >= 0) return;
  const next = new Map(opened.value);
  let component = selectedComponent.value;
  let use = placeOfSelected.value;
  for (let i = 0; component && use && i < 1000; ++i) {
    next.set(use.id, true);
    component = components.value.get(use.id) ?? null;
    use = component?.uses[0] ?? null;
  }
  opened.value = next;
}

interface RowProps {
  row: Row;
  at: number;
  current: boolean;
  target: boolean;
  drag: (use: Use | null) => void;
  /** What is dragged may be put into it, at the end of one of its lists. */
  inside: boolean;
  enter: (at: number) => void;
  drop: (row: Row | null) => void;
}

function RowView({ row, at, current, target, inside, drag, enter, drop }: RowProps): JSX.Element {
  const { component, use, depth, expanded } = row;
  const shared = component.uses.length > 1;
  const beside = component.name ? component.class : namesInside(component);
  return (
    <div
      id={`row-${at}`}
      class={`row${current ? " current" : ""}${component.written === "default" ? " default" : ""}${target ? (inside ? " target-inside" : " target") : ""}`}
      style={{ top: `${at * rowHeight}px`, paddingLeft: `${6 + depth * 14}px` }}
      role="treeitem"
      aria-level={depth + 1}
      aria-posinset={row.position}
      aria-setsize={row.siblings}
      aria-selected={current}
      aria-expanded={expanded ?? undefined}
      draggable={use?.index !== undefined && locked.value === null}
      onDragStart={() => drag(use)}
      onDragOver={(e) => {
        if (use?.index === undefined && !inside) return enter(-1);
        e.preventDefault();
        enter(at);
      }}
      onDrop={(e) => {
        e.preventDefault();
        drop(row);
      }}
      onDragEnd={() => drop(null)}
      onClick={() => select(component.id, use)}
      onDblClick={() => expanded !== null && open(row, !expanded)}
    >
      <span
        class={`twist${expanded ? " open" : ""}`}
        aria-hidden="true"
        onClick={(e) => {
          if (expanded === null) return;
          e.stopPropagation();
          open(row, !expanded);
        }}
      >
        {expanded !== null && <Icon name="right" />}
      </span>
      <span class={`kind kind-${classes.value.kind(component.class)}`}>
        <Icon name={kindIcon(classes.value.kind(component.class))} />
      </span>
      <span class="what">{label(component)}</span>
      {beside && <span class="class">{beside}</span>}
      <span class="spring" />
      {shared && (
        <span class="shared" title={t.shared(component.uses.length)}>
          <Icon name="link" />
          {component.uses.length}
        </span>
      )}
      {use && use.index === undefined && <span class="member">{use.member}</span>}
    </div>
  );
}

/** What a component without a name can be told by: the names of what its members are, such as its shader's. */
function namesInside(component: Component): string {
  const found: string[] = [];
  for (const { value } of Object.values(component.members)) {
    const name = isUse(value) ? components.value.get(value.component)?.name : null;
    if (name) found.push(name);
  }
  return found.slice(0, 3).join(", ");
}

export function label(component: Component): string {
  return component.name ?? component.class;
}

function TreeActions(): JSX.Element {
  const component = selectedComponent.value;
  const use = placeOfSelected.value;
  const off = locked.value !== null || !component;
  const inList = use?.index !== undefined;
  return (
    <div class="toolbar small" role="toolbar" aria-label={t.actions}>
      <Button icon="add" label={t.add} keys="Insert" disabled={off} onClick={() => component && (actions.choosing.value = { what: "add", component, use })} />
      <Button icon="copy" label={t.duplicate} keys="Ctrl+D" disabled={off || !inList} onClick={() => void actions.duplicate()} />
      <Button icon="remove" label={t.remove} keys={t.deleteKey} disabled={off || !use} onClick={() => void actions.remove()} />
      <Button icon="up" label={t.up} keys="Alt+↑" disabled={off || !inList} onClick={() => void actions.moveBy(-1)} />
      <Button icon="down" label={t.down} keys="Alt+↓" disabled={off || !inList} onClick={() => void actions.moveBy(1)} />
      <Button icon="link" label={component && component.uses.length > 1 ? t.unshare : t.share} disabled={off || !use}
        onClick={() => component && use && (component.uses.length > 1 ? void actions.unshare() : (actions.sharing.value = { component, use }))} />
    </div>
  );
}
