// The text of the document, in an editor that knows the classes.
import { autocompletion, closeBrackets, closeBracketsKeymap, completionKeymap, type CompletionContext, type CompletionResult } from "@codemirror/autocomplete";
import { defaultKeymap, indentWithTab } from "@codemirror/commands";
import { bracketMatching, codeFolding, foldGutter, foldKeymap, indentOnInput, indentUnit } from "@codemirror/language";
import { lintGutter, lintKeymap, nextDiagnostic, setDiagnostics, type Diagnostic } from "@codemirror/lint";
import { highlightSelectionMatches, search, searchKeymap } from "@codemirror/search";
import { Annotation, EditorSelection, EditorState, Text, type ChangeSet } from "@codemirror/state";
import { EditorView, drawSelection, highlightActiveLine, hoverTooltip, keymap, lineNumbers } from "@codemirror/view";
import { effect } from "@preact/signals";
import { render, type JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { Refused, type Problem, type TextState } from "../model/protocol.ts";
import { browser, components, document_, locked, readOnly, select, selectedComponent, tab } from "../model/state.ts";
import { ask, connection, demand, followText, hello, report, textNow } from "../model/studio.ts";
import { Markdown } from "../parts/markdown.tsx";
import { dragged } from "../panel/edit.ts";
import { Button } from "../parts/parts.tsx";
import { cameraMoved } from "../picture/camera.ts";
import { warnings } from "./warnings.ts";
import { texts } from "../texts/texts.ts";
import { language } from "./language.ts";
import { Sync, type Answer } from "./sync.ts";

const t = texts.text;
const fromProgram = Annotation.define<boolean>();

let view: EditorView | null = null;
/** The number of the request whose change is to come back as an event. */
let lastTextRequest = -1;
let sync: Sync | null = null;

/** Shows a place of the text. */
export function showPlace(begin: number, end = begin): void {
  tab.value = "text";
  requestAnimationFrame(() => {
    if (!view) return;
    const length = view.state.doc.length;
    view.dispatch({ selection: EditorSelection.range(Math.min(begin, length), Math.min(end, length)), effects: EditorView.scrollIntoView(Math.min(begin, length), { y: "center" }) });
    view.focus();
  });
}

async function send(revision: number, changes: { begin: number; end: number; insert: string }[]): Promise<Answer> {
  try {
    if (changes.length === 0) return await demand<Answer>("drop_draft");
    lastTextRequest = connection.next;
    const reply = await demand<Answer & { valid?: boolean; errors?: Problem[] }>("text", { revision, changes });
    if (reply.valid === false) showProblems(reply.errors ?? []);
    return reply;
  } catch (error) {
    if (error instanceof Refused && error.code === "busy") {
      await hello();
      return { stale: true };
    }
    report(error);
    return { valid: false };
  }
}

function problemsAt(problems: Problem[], severity: "error" | "warning", length: number): Diagnostic[] {
  return problems
    .filter((p) => p.begin !== undefined)
    .map((p) => {
      const from = Math.min(p.begin ?? 0, length);
      const to = Math.min(Math.max(p.end ?? from, from), length);
      return { from, to: to === from ? Math.min(from + 1, length) : to, severity, message: p.message, source: p.code ?? "" };
    });
}

let shownErrors: Problem[] = [];

function showProblems(errors: Problem[]): void {
  if (!view) return;
  shownErrors = errors;
  const length = view.state.doc.length;
  view.dispatch(setDiagnostics(view.state, [...problemsAt(errors, "error", length), ...problemsAt(warnings.peek(), "warning", length)]));
}

async function complete(context: CompletionContext): Promise<CompletionResult | null> {
  if (!context.explicit && !context.matchBefore(/[\w"./:]$/)) return null;
  try {
    const { items } = await demand<{ items: { label: string; kind: string; detail?: string; insert: string; begin: number; end: number }[] }>("complete", {
      text: context.state.doc.toString(),
      at: context.pos,
    });
    const first = items[0];
    if (!first) return null;
    const type: Record<string, string> = { class: "class", member: "property", name: "variable", function: "function", unit: "constant", choice: "enum", keyword: "keyword", file: "text" };
    return {
      from: first.begin,
      to: first.end,
      options: items.map((i) => {
        const [short = "", ...long] = (i.detail ?? "").split(/(?<=^[\w ,]{1,24}): /);
        const brief = short.length <= 28;
        const more = brief ? long.join(": ") : (i.detail ?? "");
        return { label: i.label, apply: i.insert, detail: brief ? short : "", ...(more ? { info: more } : {}), type: type[i.kind] ?? "text" };
      }),
      validFor: /^[\w]*$/,
    };
  } catch {
    return null;
  }
}

const hover = hoverTooltip(async (editor, at) => {
  try {
    const said = await demand<{ markdown?: string; hover?: { markdown: string; begin: number; end: number } | null; begin?: number; end?: number }>("hover", {
      text: editor.state.doc.toString(),
      at,
    });
    const found = said.hover ?? (said.markdown ? { markdown: said.markdown, begin: said.begin ?? at, end: said.end ?? at } : null);
    if (!found) return null;
    return {
      pos: found.begin,
      end: found.end,
      above: true,
      create: () => {
        const dom = document.createElement("div");
        dom.className = "hover-help";
        render(<Markdown text={found.markdown} />, dom);
        return { dom };
      },
    };
  } catch {
    return null;
  }
});

async function goToDefinition(editor: EditorView, at: number): Promise<void> {
  const found = await ask<{ begin?: number; end?: number; definition?: { begin: number; end: number } | null }>("definition", { text: editor.state.doc.toString(), at });
  const place = found?.definition ?? (found?.begin !== undefined ? { begin: found.begin, end: found.end ?? found.begin } : null);
  if (place) showPlace(place.begin, place.end);
}

/** Selects in the tree what the cursor stands in. */
function selectAt(at: number): void {
  let best: { id: number; length: number } | null = null;
  for (const c of components.value.values()) {
    if (c.begin === undefined || c.end === undefined || c.begin > at || c.end < at || c.written !== "text") continue;
    if (!best || c.end - c.begin < best.length) best = { id: c.id, length: c.end - c.begin };
  }
  if (best) select(best.id);
}

function extensions(): unknown[] {
  return [
    lineNumbers(), foldGutter(), codeFolding(), lintGutter(), drawSelection(), highlightActiveLine(), highlightSelectionMatches(), bracketMatching(),
    closeBrackets(), indentOnInput(), indentUnit.of("    "), search({ top: true }), language, hover, autocompletion({ override: [complete] }),
    EditorView.contentAttributes.of({ "aria-label": t.label, tabindex: "0" }),
    keymap.of([
      { key: "Mod-z", run: () => (void settle().then(() => ask("undo")), true), preventDefault: true },
      { key: "Mod-Shift-z", run: () => (void settle().then(() => ask("redo")), true), preventDefault: true },
      { key: "Mod-y", run: () => (void settle().then(() => ask("redo")), true), preventDefault: true },
      { key: "F12", run: (v) => (void goToDefinition(v, v.state.selection.main.head), true) },
      { key: "F8", run: nextDiagnostic },
      { key: "Escape", run: () => (document.getElementById("tab-text")?.focus(), true) },
      ...closeBracketsKeymap, ...completionKeymap, ...lintKeymap, ...searchKeymap, ...foldKeymap, ...defaultKeymap, indentWithTab,
    ]),
    EditorView.domEventHandlers({
      mousedown: (event, v) => {
        if (!event.ctrlKey && !event.metaKey) return false;
        const at = v.posAtCoords({ x: event.clientX, y: event.clientY });
        if (at !== null) void goToDefinition(v, at);
        return at !== null;
      },
      mouseup: (_event, v) => {
        if (v.state.selection.main.empty) selectAt(v.state.selection.main.head);
        return false;
      },
    }),
    EditorView.updateListener.of((update) => {
      if (update.docChanged && !update.transactions.some((tr) => tr.annotation(fromProgram))) sync?.typed(update.changes);
    }),
    EditorState.readOnly.of(readOnly.value),
    EditorState.lineSeparator.of("\n"),
  ];
}

/** What was dragged or moved, and what was typed if it is valid, is with the program after this. */
export async function settle(): Promise<void> {
  await dragged();
  await cameraMoved();
  await sync?.flush();
}

function begin(parent: HTMLElement): () => void {
  const { text, revision } = textNow();
  const start = (doc: string, at: number): void => {
    const content = Text.of(doc.split("\n"));
    sync?.stop();
    sync = new Sync(content, at, {
      send,
      apply: (changes: ChangeSet) => view?.dispatch({ changes, annotations: fromProgram.of(true) }),
    });
    const state = EditorState.create({ doc: content, extensions: extensions() as never });
    if (view) view.setState(state);
    else view = new EditorView({ state, parent });
  };
  start(text, revision);
  const end = followText((event: TextState) => {
    if (event.text !== undefined) {
      if (sync?.rebased(event.text, event.revision) && !event.draft) return;
      start(event.text, event.revision);
      const draft = event.draft?.text;
      if (draft !== undefined && draft !== null) view?.dispatch({ changes: { from: 0, to: event.text.length, insert: draft } });
    } else if (event.changes) sync?.changed(event, event.by === browser.value && event.request === lastTextRequest);
  });
  const endProblems = effect(() => {
    void warnings.value;
    const now = document_.value;
    if (now) queueMicrotask(() => showProblems(now.errors.length ? now.errors : now.draft ? shownErrors : []));
  });
  return () => {
    end();
    endProblems();
    sync?.stop();
    view?.destroy();
    view = null;
    sync = null;
  };
}

async function dropDraft(): Promise<void> {
  if (!(await ask("drop_draft")) || !view || !sync) return;
  const base = sync.drop();
  view.dispatch({ changes: { from: 0, to: view.state.doc.length, insert: base }, annotations: fromProgram.of(true) });
}

export function Editor(): JSX.Element {
  const parent = useRef<HTMLDivElement>(null);
  useEffect(() => (parent.current ? begin(parent.current) : undefined), []);
  const problems = document_.value?.errors ?? [];
  const chosen = selectedComponent.value;
  return (
    <div class="editor">
      <div class="toolbar">
        <span class="dim keys-hint">{t.keys}</span>
        <Button label={t.showSelected} disabled={chosen?.begin === undefined} onClick={() => chosen?.begin !== undefined && showPlace(chosen.begin, chosen.end)} />
        {locked.value === "draft" && <Button label={t.dropDraft} onClick={() => void dropDraft()} />}
      </div>
      {(problems.length > 0 || locked.value === "draft") && (
        <div class="problems" role="status">
          <b>{locked.value === "draft" ? t.draft : t.problems}</b>
          <ul class="plain">
            {problems.slice(0, 20).map((p, i) => (
              <li key={i}>
                <button type="button" class="link" onClick={() => p.begin !== undefined && showPlace(p.begin, p.end)}>
                  {p.line !== undefined && <span class="dim">{p.line}:{p.column} </span>}
                  {p.message}
                </button>
              </li>
            ))}
          </ul>
        </div>
      )}
      <div class="code" ref={parent} />
    </div>
  );
}
