// What the page is put together from: buttons, tabs, dialogs, dividers.
import type { ComponentChildren, JSX } from "preact";
import { useEffect, useId, useRef } from "preact/hooks";
import { texts } from "../texts/texts.ts";
import { Icon, type IconName } from "./icons.tsx";

interface ButtonProps {
  icon?: IconName;
  label: string;
  /** Shown beside the icon; without, the label is only told. */
  text?: boolean;
  /** Shown beside the icon instead of the whole label, which it is a part of. */
  short?: string;
  /** What it does, in more words than the label. */
  hint?: string;
  keys?: string;
  pressed?: boolean;
  disabled?: boolean;
  primary?: boolean;
  class?: string;
  onClick: (event: MouseEvent) => void;
}

export function Button({ icon, label, text, short, hint, keys, pressed, disabled, primary, class: more, onClick }: ButtonProps): JSX.Element {
  const title = hint ?? (keys ? `${label} (${keys})` : label);
  return (
    <button
      type="button"
      class={`button${primary ? " primary" : ""}${text || short || !icon ? "" : " square"}${more ? ` ${more}` : ""}`}
      title={title}
      aria-label={icon && !text ? label : undefined}
      aria-pressed={pressed === undefined ? undefined : pressed}
      disabled={disabled}
      onClick={onClick}
    >
      {icon && <Icon name={icon} />}
      {(text || short || !icon) && <span>{short ?? label}</span>}
    </button>
  );
}

interface TabsProps<T extends string> {
  label: string;
  tabs: { name: T; label: string }[];
  chosen: T;
  choose: (name: T) => void;
  children?: ComponentChildren;
}

/** A row of tabs; the panels are elements with the identifiers `panel-NAME`. */
export function Tabs<T extends string>({ label, tabs, chosen, choose }: TabsProps<T>): JSX.Element {
  const step = (event: KeyboardEvent): void => {
    const by = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (!by) return;
    const at = tabs.findIndex((t) => t.name === chosen);
    const next = tabs[(at + by + tabs.length) % tabs.length];
    if (!next) return;
    event.preventDefault();
    choose(next.name);
    document.getElementById(`tab-${next.name}`)?.focus();
  };
  return (
    <div class="tabs" role="tablist" aria-label={label} onKeyDown={step}>
      {tabs.map((t) => (
        <button
          key={t.name}
          id={`tab-${t.name}`}
          type="button"
          role="tab"
          aria-selected={t.name === chosen}
          aria-controls={`panel-${t.name}`}
          tabIndex={t.name === chosen ? 0 : -1}
          onClick={() => choose(t.name)}
        >
          {t.label}
        </button>
      ))}
    </div>
  );
}

interface DialogProps {
  title: string;
  close: () => void;
  children: ComponentChildren;
  class?: string;
}

/** A modal window; Escape closes it, and focus returns to where it was. */
export function Dialog({ title, close, children, class: more }: DialogProps): JSX.Element {
  const element = useRef<HTMLDialogElement>(null);
  const id = useId();
  useEffect(() => {
    const before = document.activeElement;
    element.current?.showModal();
    element.current?.querySelector<HTMLElement>("[data-focus]")?.focus();
    return () => {
      element.current?.close(); // what is behind it cannot have the focus before
      if (before instanceof HTMLElement) before.focus();
    };
  }, []);
  return (
    <dialog
      ref={element}
      class={`dialog ${more ?? ""}`}
      aria-labelledby={id}
      onCancel={(e) => {
        e.preventDefault();
        close();
      }}
      onClick={(e) => e.target === element.current && close()}
    >
      <div class="dialog-inside">
        <header>
          <h2 id={id}>{title}</h2>
          <Button icon="close" label={texts.common.close} onClick={close} />
        </header>
        {children}
      </div>
    </dialog>
  );
}

interface DividerProps {
  label: string;
  /** The size in pixels of what is before (or, with `after`, behind) it. */
  size: number;
  least: number;
  most: number;
  after?: boolean;
  horizontal?: boolean;
  change: (size: number) => void;
}

/** A divider that is dragged, or moved by arrow keys. */
export function Divider({ label, size, least, most, after, horizontal, change }: DividerProps): JSX.Element {
  const clamp = (s: number): number => Math.min(most, Math.max(least, s));
  const sign = after ? -1 : 1;
  const drag = (event: PointerEvent): void => {
    const target = event.currentTarget as HTMLElement;
    target.setPointerCapture(event.pointerId);
    const start = horizontal ? event.clientY : event.clientX;
    target.onpointermove = (e) => change(clamp(size + sign * ((horizontal ? e.clientY : e.clientX) - start)));
    target.onpointerup = () => (target.onpointermove = target.onpointerup = null);
  };
  const key = (event: KeyboardEvent): void => {
    const more = event.key === (horizontal ? "ArrowDown" : "ArrowRight");
    const less = event.key === (horizontal ? "ArrowUp" : "ArrowLeft");
    if (!more && !less) return;
    event.preventDefault();
    change(clamp(size + sign * (more ? 16 : -16)));
  };
  return (
    <div
      class={`divider${horizontal ? " horizontal" : ""}`}
      role="separator"
      tabIndex={0}
      aria-label={label}
      aria-orientation={horizontal ? "horizontal" : "vertical"}
      aria-valuenow={Math.round(size)}
      aria-valuemin={least}
      aria-valuemax={most}
      onPointerDown={drag}
      onKeyDown={key}
    />
  );
}
