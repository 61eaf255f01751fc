// Colours for the words of the render description language.
import { HighlightStyle, LanguageSupport, StreamLanguage, syntaxHighlighting } from "@codemirror/language";
import { tags } from "@lezer/highlight";
import { unitNames } from "../model/numbers.ts";

interface State {
  inText: boolean;
}

const units = new Set(unitNames);
const constants = new Set(["true", "false", "none", "pi", "identity"]);
const keywords = new Set(["include", "plugin", "param"]);

export const etd = StreamLanguage.define<State>({
  name: "etd",
  startState: () => ({ inText: false }),
  token(stream, state) {
    if (state.inText) return text(stream, state);
    if (stream.eatSpace()) return null;
    if (stream.match(/^#.*/)) return "comment";
    if (stream.eat('"')) {
      state.inText = true;
      return text(stream, state);
    }
    if (stream.match(/^\d+(\.\d*)?([eE][-+]?\d+)?|^\.\d+([eE][-+]?\d+)?/)) return "number";
    const word = stream.match(/^[A-Za-z_]\w*/) as RegExpMatchArray | null;
    if (word) {
      const name = word[0];
      if (keywords.has(name)) return "keyword";
      if (constants.has(name)) return "atom";
      if (stream.match(/^\s*:/, false)) return "propertyName";
      if (stream.match(/^\s*\(/, false)) return "functionName";
      if (/^[A-Z]/.test(name) && stream.match(/^\s*\{/, false)) return "className";
      if (units.has(name)) return "unit";
      if (/^\s*=/.test(stream.string.slice(stream.pos)) && /^\s*$/.test(stream.string.slice(0, stream.start))) return "definition";
      return "variableName";
    }
    stream.next();
    return null;
  },
  languageData: { commentTokens: { line: "#" }, closeBrackets: { brackets: ["(", "[", "{", '"'] }, indentOnInput: /^\s*[}\])]$/ },
  tokenTable: { unit: tags.unit, definition: tags.definition(tags.variableName), functionName: tags.function(tags.variableName) },
});

function text(stream: { next: () => string | void; eol: () => boolean }, state: State): string {
  while (!stream.eol()) {
    const c = stream.next();
    if (c === "\\") stream.next();
    else if (c === '"') {
      state.inText = false;
      break;
    }
  }
  if (stream.eol()) state.inText = false;
  return "string";
}

const colors = HighlightStyle.define([
  { tag: tags.comment, color: "var(--code-comment)", fontStyle: "italic" },
  { tag: tags.keyword, color: "var(--code-keyword)" },
  { tag: tags.atom, color: "var(--code-number)" },
  { tag: tags.number, color: "var(--code-number)" },
  { tag: tags.unit, color: "var(--code-unit)" },
  { tag: tags.string, color: "var(--code-string)" },
  { tag: tags.className, color: "var(--code-class)", fontWeight: "600" },
  { tag: tags.propertyName, color: "var(--code-member)" },
  { tag: tags.function(tags.variableName), color: "var(--code-call)" },
  { tag: tags.definition(tags.variableName), color: "var(--code-name)", fontWeight: "600" },
]);

export const language = new LanguageSupport(etd, [syntaxHighlighting(colors)]);
