// No circle of imports in studio/src, neither of files nor of folders, so that each can be read and tested after those it imports.
// Imports of types alone count: a type that two files need from each other belongs in a file of its own.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, posix } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

const studio = join(dirname(fileURLToPath(import.meta.url)), "../../studio");
const typescript = createRequire(join(studio, "package.json"))("typescript");

/** The files below studio/src, each with those that it imports, dynamically too. */
function importsOfFiles() {
  const sources = join(studio, "src");
  const names = readdirSync(sources, { recursive: true }).map((name) => name.replaceAll("\\", "/")).filter((name) => /(?<!\.d)\.tsx?$/.test(name));
  return new Map(names.map((name) => {
    const { importedFiles } = typescript.preProcessFile(readFileSync(join(sources, name), "utf8"), true, true);
    const own = importedFiles.map((i) => i.fileName).filter((imported) => imported.startsWith(".") && !imported.endsWith(".css"));
    return [name, own.map((imported) => posix.join(posix.dirname(name), imported))];
  }));
}

/** The folders of these files, each with the other folders from which its files import. */
function importsOfFolders(files) {
  const folders = new Map();
  for (const [file, imported] of files) {
    const folder = posix.dirname(file);
    const others = imported.map((other) => posix.dirname(other)).filter((other) => other !== folder);
    folders.set(folder, [...(folders.get(folder) ?? []), ...others]);
  }
  return folders;
}

/** The nodes of one circle, the first again at its end; null if the graph has none. By depth-first search. */
function circle(graph) {
  const finished = new Set();
  const path = [];
  const visit = (node) => {
    if (finished.has(node)) return null;
    const begin = path.indexOf(node);
    if (begin >= 0) return [...path.slice(begin), node];
    path.push(node);
    for (const next of graph.get(node) ?? []) {
      const found = visit(next);
      if (found) return found;
    }
    path.pop();
    finished.add(node);
    return null;
  };
  for (const node of graph.keys()) {
    const found = visit(node);
    if (found) return found;
  }
  return null;
}

test("a circle is found where there is one, and only there", () => {
  assert.deepEqual(circle(new Map([["a", ["b"]], ["b", ["c"]], ["c", ["b"]]])), ["b", "c", "b"]);
  assert.deepEqual(circle(new Map([["a", ["a"]]])), ["a", "a"]);
  assert.equal(circle(new Map([["a", ["b", "c"]], ["b", ["c"]], ["c", []]])), null);
});

const files = importsOfFiles();

test("every imported file is found", () => {
  for (const [file, imported] of files) for (const other of imported) assert.ok(files.has(other), `${file} imports ${other}`);
});

test("no files import each other in a circle", () => {
  assert.equal(circle(files)?.join(" -> ") ?? null, null);
});

test("no folders import each other in a circle", () => {
  assert.equal(circle(importsOfFolders(files))?.join(" -> ") ?? null, null);
});
