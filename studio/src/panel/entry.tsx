// A line of text that is taken over when it is complete: by Enter, or when the focus leaves it. Escape brings back what was.
import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";

interface EntryProps {
  id?: string;
  text: string;
  label: string;
  commit: (text: string) => Promise<boolean>;
  list?: string;
  placeholder?: string;
  lines?: boolean;
  onKeyDown?: (event: JSX.TargetedKeyboardEvent<HTMLInputElement>) => void;
  onBlur?: () => void;
}

export function Entry({ id, text, label, commit, list, placeholder, lines, onKeyDown, onBlur }: EntryProps): JSX.Element {
  const element = useRef<HTMLInputElement & HTMLTextAreaElement>(null);
  const refused = useRef(false);
  const given = useRef(text);
  // What changes elsewhere is shown, unless somebody is typing here.
  useEffect(() => {
    const e = element.current;
    if (e && (document.activeElement !== e || e.value === given.current)) {
      e.value = text;
      refused.current = false;
    }
    given.current = text;
  }, [text]);
  const take = async (): Promise<void> => {
    const e = element.current;
    if (!e || e.value === given.current) return;
    refused.current = !(await commit(e.value));
  };
  const shared = {
    ref: element,
    id,
    class: `entry${lines ? " lines" : ""}`,
    "aria-label": id ? undefined : label,
    "aria-describedby": id ? `${id}-help` : undefined,
    defaultValue: text,
    spellcheck: false,
    autocomplete: "off",
    placeholder,
    onBlur: () => {
      void take();
      onBlur?.();
    },
    onKeyDown: (event: JSX.TargetedKeyboardEvent<HTMLInputElement & HTMLTextAreaElement>) => {
      if (event.key === "Enter" && (!lines || event.ctrlKey || event.metaKey)) {
        event.preventDefault();
        void take();
      } else if (event.key === "Escape" && element.current) {
        element.current.value = given.current;
      } else onKeyDown?.(event);
    },
  };
  if (lines) return <textarea {...shared} rows={Math.min(8, Math.max(2, text.split("\n").length, Math.ceil(text.length / 38)))} />;
  return <input type="text" {...shared} list={list} />;
}
