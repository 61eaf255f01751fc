// Starts the program's studio on a copy of a scene, and Debian's Chromium on its page. Ends both.
import assert from "node:assert/strict";
import { chromium } from "playwright-core";
import { spawn, execFileSync } from "node:child_process";
import { cpSync, existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
export const repository = resolve(here, "../..");
const build = process.env.ETENDUE_BUILD ?? join(repository, "build");
export const program = process.env.ETENDUE_PROGRAM ?? join(build, "etendue");
const page = process.env.ETENDUE_STUDIO_PAGE ?? join(build, "studio/index.html");
export const chromiumPath = process.env.ETENDUE_CHROMIUM ?? "/usr/bin/chromium";

/**
 * How long something is waited for that is bound to come [s]: tests wait for what is to be seen, never for a time, so on a machine
 * that is busy with other things they take longer, and that is all.
 */
export const patience = 180;
/** Of a whole test, after which something hangs. */
export const whole = { timeout: 600_000 };

/** A folder of its own that goes away with the test. */
export function scratch(t) {
  const folder = mkdtempSync(join(tmpdir(), "etendue-studio-"));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  return folder;
}

export function run(...arguments_) {
  return execFileSync(program, arguments_, { encoding: "utf8", maxBuffer: 1 << 28, stdio: ["ignore", "pipe", "pipe"] });
}

/** Starts `etendue studio` with a text as its document; gives the address, the file and a way to end it. */
export async function startStudio(t, text, ...more) {
  const folder = scratch(t);
  const file = join(folder, "scene.etd");
  if (text !== null) writeFileSync(file, text);
  if (existsSync(join(repository, "scenes/data"))) cpSync(join(repository, "scenes/data"), join(folder, "data"), { recursive: true });
  const address = await startProgram(t, folder, ["studio", "--no-browser", "--page", page, ...more, ...(text === null ? [] : [file])]);
  return { address, file, folder, read: () => readFileSync(file, "utf8") };
}

/** Starts `etendue view`; gives its address. */
export function startView(t, folder, files) {
  return startProgram(t, folder, ["view", "--no-browser", "--page", page, ...files]);
}

async function startProgram(t, folder, arguments_) {
  const child = spawn(program, arguments_, { cwd: folder, stdio: ["ignore", "pipe", "pipe"] });
  let errors = "";
  child.stderr.on("data", (data) => (errors += data));
  let wanted = false;
  const ended = new Promise((done) => child.on("exit", done));
  child.on("exit", (code, signal) => {
    if (!wanted) console.error(`the studio ended by itself: ${code ?? signal}: ${errors}`);
  });
  t.after(async () => {
    wanted = true;
    child.kill("SIGTERM");
    await ended;
  });
  return new Promise((done, fail) => {
    let said = "";
    child.stdout.on("data", (data) => {
      said += data;
      const found = /http:\/\/\S+/.exec(said);
      if (found) done(found[0]);
    });
    child.on("exit", (code) => fail(new Error(`the studio ended with ${code}: ${errors}`)));
  });
}

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

/** Fails for whatever axe finds wrong with what is on the page now. */
export async function checkAccess(opened, what) {
  await opened.evaluate(axe);
  const { violations } = await opened.evaluate(() => globalThis.axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "best-practice"] }));
  assert.deepEqual(violations.map((v) => `${what}: ${v.id}: ${v.nodes.slice(0, 3).map((n) => n.html.slice(0, 140)).join(" | ")}`), []);
}

/** Fails if anything reaches over the right or lower edge of the window. */
export async function checkInside(opened, what) {
  const over = await opened.evaluate(() => {
    const found = [];
    for (const e of document.querySelectorAll("button, input, select, h1, h2, canvas, [role=tab]")) {
      const { left, right, width, height } = e.getBoundingClientRect();
      if (width && height && e.checkVisibility() && (right > window.innerWidth + 1 || left < -1) && !e.closest(".unseen, .help")) found.push(e.outerHTML.slice(0, 120));
    }
    return found;
  });
  assert.deepEqual(over, [], what);
}

export async function openBrowser(t) {
  const browser = await chromium.launch({
    executablePath: chromiumPath,
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
    timeout: 1000 * patience,
  });
  t.after(() => browser.close());
  return browser;
}

/** A page without anything on it yet, as patient as all else. */
export async function emptyPage(browser, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, ...options });
  context.setDefaultTimeout(1000 * patience);
  return context.newPage();
}

/** Opens the page and waits for its tree, unless told not to; fails the test for every error the page throws. */
export async function openPage(t, browser, address, { tree = true, ...options } = {}) {
  const opened = await emptyPage(browser, options);
  const errors = [];
  opened.on("pageerror", (error) => errors.push(String(error)));
  t.after(() => {
    if (errors.length) throw new Error(`the page threw: ${errors.join("; ")}`);
  });
  await opened.goto(address);
  if (tree) await opened.waitForSelector("[role=treeitem]");
  return opened;
}

/** A connection of its own to the program, from within a page: requests without clicks, for preparing and checking. */
export async function connect(opened) {
  await opened.evaluate(async () => {
    const socket = new WebSocket(`ws://${location.host}/socket${location.search}`);
    const waiting = new Map();
    let last = 0;
    const state = { components: new Map(), root: null, text: "", document: null };
    globalThis.studio = {
      state,
      ask: (what, more = {}) =>
        new Promise((done) => {
          waiting.set(++last, done);
          socket.send(JSON.stringify({ id: last, do: what, ...more }));
        }),
    };
    const tree = (said) => {
      if (said.components) {
        state.components = new Map(Object.values(said.components).map((c) => [c.id, c]));
        state.root = said.root;
      } else for (const c of Object.values(said.update ?? {})) state.components.set(c.id, c);
    };
    socket.binaryType = "arraybuffer";
    socket.onmessage = ({ data }) => {
      if (typeof data !== "string") return;
      const said = JSON.parse(data);
      if (said.event === "tree") tree(said);
      if (said.event === "document") state.document = said;
      if (said.event === "text" && said.text !== undefined) state.text = said.text;
      if (said.event === "text" && said.changes) {
        for (const c of [...said.changes].sort((a, b) => b.begin - a.begin)) state.text = state.text.slice(0, c.begin) + c.insert + state.text.slice(c.end);
      }
      if (said.id !== undefined) waiting.get(said.id)?.(said);
    };
    socket.onclose = () => waiting.forEach((done) => done({ ok: false, errors: [{ message: "the connection was lost" }] }));
    await new Promise((done) => (socket.onopen = done));
    const hello = await studio.ask("hello", { protocol: 1 });
    state.text = hello.text.text;
    state.document = hello.document;
    if (hello.tree) tree(hello.tree);
    await studio.ask("watch", { what: "none" });
  });
  return {
    ask: (what, more) => opened.evaluate(([w, m]) => studio.ask(w, m), [what, more]),
    text: () => opened.evaluate(() => studio.state.text),
    components: () => opened.evaluate(() => [...studio.state.components.values()]),
    component: (id) => opened.evaluate((i) => studio.state.components.get(i) ?? null, id),
    root: () => opened.evaluate(() => studio.state.components.get(studio.state.root)),
  };
}

/** Waits until something holds. */
export async function until(what, test) {
  const end = Date.now() + 1000 * patience;
  for (;;) {
    const value = await test();
    if (value) return value;
    if (Date.now() > end) throw new Error(`not within ${patience} s: ${what}; it is ${JSON.stringify(value)}`);
    await new Promise((done) => setTimeout(done, 30));
  }
}
