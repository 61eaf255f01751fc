// The studio's page begins here.
import { render } from "preact";
import uplotStyle from "uplot/dist/uPlot.min.css";
import { App } from "./app.tsx";
import { toggleRender } from "./control/control.tsx";
import { connect } from "./model/studio.ts";
import { tab } from "./model/state.ts";
import { forgetPictures, takePixels } from "./picture/store.ts";
import baseStyle from "./styles/base.css";
import partsStyle from "./styles/parts.css";
import panesStyle from "./styles/panes.css";
import { helping, openDocument, redo, save, saveAs, undo } from "./top_bar.tsx";

for (const text of [uplotStyle, baseStyle, partsStyle, panesStyle]) {
  const style = document.createElement("style");
  style.textContent = text;
  document.head.append(style);
}

/** Keys that work everywhere; where text is typed, its own come first. */
function key(event: KeyboardEvent): void {
  if (event.defaultPrevented) return;
  const command = event.ctrlKey || event.metaKey;
  const name = event.key.toLowerCase();
  const typing = event.target instanceof HTMLInputElement && event.target.matches(".entry, [type=search], [type=number]") && event.target.value !== event.target.defaultValue;
  if (command && name === "z" && !typing) void (event.shiftKey ? redo() : undo());
  else if (command && name === "y" && !typing) void redo();
  else if (command && name === "s") void (event.shiftKey ? saveAs() : save());
  else if (command && name === "o") void openDocument();
  else if (command && name === "enter") toggleRender();
  else if (event.key === "F1") helping.value = true;
  else if (event.altKey && "1234".includes(event.key)) tab.value = (["picture", "text", "paths", "sides"] as const)[Number(event.key) - 1] ?? "picture";
  else if (event.key === "F6") nextPane(event.shiftKey);
  else return;
  event.preventDefault();
}

/** F6 goes from pane to pane, as in desktop programs. */
function nextPane(back: boolean): void {
  const places = [".tree", ".tabs [aria-selected=true]", ".panel", ".control .button"].map((s) => document.querySelector<HTMLElement>(s)).filter((e) => e !== null);
  const now = places.findIndex((p) => p.contains(document.activeElement) || p.parentElement?.contains(document.activeElement));
  const next = places[(now + (back ? places.length - 1 : 1)) % places.length];
  (next?.matches(".panel") ? (next.querySelector<HTMLElement>("button, input, select") ?? next) : next)?.focus();
}

document.addEventListener("keydown", key);
const app = document.getElementById("app");
if (app) render(<App />, app);
connect({ takePixels, forgetPictures });
