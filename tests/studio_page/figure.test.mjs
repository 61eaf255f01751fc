// Figure 4.4 is built from an empty document by mouse and keyboard alone, saved, and rendered in batch: the bytes are those of its own file.
// What is built is read off that file; what is typed is what stands in it.
import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { connect, openBrowser, openPage, repository, run, scratch, startStudio, until, whole } from "./harness.mjs";

const folder = join(repository, "scenes/figures");

/** The figure's components by their numbers, with what it includes written out, as another studio reads them. */
async function readFigure(t, browser) {
  const [room, own] = ["box_room.etd", "glossy_box.etd"].map((name) => readFileSync(join(folder, name), "utf8"));
  const include = 'include "box_room.etd"';
  assert.ok(own.includes(include));
  const studio = await startStudio(t, own.replace(include, room));
  const page = await openPage(t, browser, studio.address);
  const program = await connect(page);
  await program.ask("stop");
  const components = await program.components();
  const root = await program.root();
  await page.context().close();
  return { all: new Map(components.map((c) => [c.id, c])), root };
}

/** What a person does with the page of a new document. */
class Hands {
  constructor(page, program, classes) {
    Object.assign(this, { page, program, classes });
  }
  press(keys) {
    return this.page.keyboard.press(keys);
  }
  selected() {
    return this.page.evaluate(() => Number(document.querySelector(".panel")?.dataset.component ?? 0));
  }
  field(id, member) {
    return this.page.locator(".field", { has: this.page.locator(`#field-${id}-${member}`) });
  }
  type(member, className) {
    return this.classes.get(className).members.find((m) => m.name === member);
  }
  async value(id, member) {
    return JSON.stringify((await this.program.component(id)).members[member].value);
  }

  /** Types into an entry, and waits until the program has taken it, or the page keeps it for what comes next. */
  async write(id, member, entry, text) {
    const before = JSON.stringify((await this.program.component(id)).members[member]);
    if ((await entry.inputValue()) === text) return;
    await entry.click();
    await this.press("Control+a");
    await this.page.keyboard.insertText(text);
    await this.press((await entry.evaluate((e) => e.tagName)) === "TEXTAREA" ? "Control+Enter" : "Enter");
    await until(`${member} is ${text}`, async () =>
      JSON.stringify((await this.program.component(id)).members[member]) !== before || (await this.field(id, member).locator(".waiting").count()) > 0);
  }

  /** In the window of classes: a class by its name, or what has a name already. Gives its number. */
  async choose(name, shared) {
    const { page } = this;
    const before = await this.selected();
    await page.locator("dialog input[role=combobox]").waitFor();
    if (shared) await page.locator("dialog .cluster button", { hasText: new RegExp(`^${shared}$`) }).click();
    else {
      await page.keyboard.insertText(name);
      await until(`${name} is found`, async () => (await page.locator("[role=option][aria-selected=true] b").textContent()) === name);
      await this.press("Enter");
    }
    await page.locator("dialog").waitFor({ state: "detached" });
    await until(`${shared ?? name} is selected`, async () => (await this.selected()) !== before);
    return this.selected();
  }

  async nameIt(id, name) {
    await this.page.locator("[role=tree]").focus();
    await this.press("F2");
    await this.page.locator("dialog input").waitFor();
    await this.page.keyboard.insertText(name);
    await this.press("Enter");
    await this.page.locator("dialog").waitFor({ state: "detached" });
    await until(`it is called ${name}`, async () => (await this.program.component(id)).name === name);
  }

  /** Back to what holds the selected component, by the line above its panel. */
  async back(id) {
    if ((await this.selected()) === id) return;
    for (let i = 0; i < 10 && (await this.selected()) !== id; ++i) {
      const before = await this.selected();
      await this.page.locator(".panel-head nav .link").last().click();
      await until("another panel", async () => (await this.selected()) !== before);
    }
  }
}

class Builder {
  constructor(hands, figure) {
    this.hands = hands;
    this.figure = figure;
    /** The names of those components of the figure that have been made and have one. */
    this.names = new Map();
  }

  /** Brings the component that is selected to what one of the figure is. */
  async fill(wanted, id) {
    for (const [member, state] of Object.entries(wanted.members)) {
      if (!state.written) continue;
      await this.hands.back(id);
      if (Array.isArray(state.value) && state.value.some((e) => e?.component)) await this.list(wanted, id, member);
      else if (state.value?.component) await this.reference(id, member, state);
      else await this.plain(wanted, id, member, state);
    }
    if (wanted.name && !this.names.has(wanted.id)) {
      await this.hands.back(id);
      await this.hands.nameIt(id, wanted.name);
      this.names.set(wanted.id, wanted.name);
    }
  }

  async plain(wanted, id, member, state) {
    const { hands } = this;
    const field = hands.field(id, member);
    const { type } = hands.type(member, wanted.class);
    if (type === "choice") await field.locator("select").selectOption(state.value);
    else if (/^(vector|point|normal)/.test(type)) {
      const parts = state.value;
      // What is not 0 comes first, as nobody wants an edge without a length in between.
      for (const i of [0, 1, 2].sort((a, b) => Math.abs(parts[b]) - Math.abs(parts[a]))) {
        await hands.write(id, member, field.locator(".entry").nth(i), String(parts[i]));
      }
    } else if (type === "transform") {
      await field.locator("button", { hasText: "Edit as text" }).click();
      await hands.write(id, member, field.locator(".entry"), state.text);
    } else await hands.write(id, member, field.locator(".entry"), /^[a-z_]+$/.test(state.text) ? String(state.value) : state.text);
  }

  async reference(id, member, state) {
    const { hands, figure, names } = this;
    const child = figure.all.get(state.value.component);
    const field = hands.field(id, member);
    if (child.written === "literal") return hands.write(id, member, field.locator(".entry").first(), state.text);
    const now = (await hands.program.component(id)).members[member].value;
    const there = now && (await hands.program.component(now.component));
    if (there?.class === child.class && there.written === "text") {
      await field.locator(".go").click();
      await until("its panel", async () => (await hands.selected()) === there.id);
      return this.fill(child, there.id);
    }
    await field.locator("button[aria-label^='Add'], button[aria-label^='Change the class']").click();
    const made = await hands.choose(child.class, names.get(child.id));
    if (!names.has(child.id)) await this.fill(child, made);
  }

  async list(wanted, id, member) {
    const { hands, figure, names } = this;
    const entries = wanted.members[member].value;
    for (const [i, entry] of entries.entries()) {
      await hands.back(id);
      const child = figure.all.get(entry.component);
      const there = (await hands.program.component(id)).members[member].value[i];
      if (there && (await hands.program.component(there.component)).class === child.class) continue; // a new document has it
      if (member === "objects") {
        await hands.page.locator("[role=tree]").focus();
        await hands.press("Insert");
      } else await hands.field(id, member).locator("button", { hasText: "Add…" }).click();
      const made = await hands.choose(child.class, names.get(child.id));
      if (!names.has(child.id)) await this.fill(child, made);
    }
  }
}

/** All values, with components written out where they stand. */
function values(all, root) {
  const one = (data) => (Array.isArray(data) ? data.map(one) : data?.component ? write(all.get(data.component)) : (data?.transform ?? data));
  const write = (c) => ({ class: c.class, members: Object.fromEntries(Object.entries(c.members).map(([n, m]) => [n, one(m.value)])) });
  return write(root);
}

/** The pixels of a PNG as they are packed: its IDAT chunks. Others tell of the file it was made from. */
function packed(png) {
  const found = [];
  for (let at = 8; at < png.length; at += 12 + png.readUInt32BE(at)) {
    if (png.toString("latin1", at + 4, at + 8) === "IDAT") found.push(png.subarray(at + 8, at + 8 + png.readUInt32BE(at)));
  }
  return Buffer.concat(found);
}

test("figure 4.4 is built from nothing by mouse and keyboard, and renders to the bytes of its file", whole, async (t) => {
  const browser = await openBrowser(t);
  const figure = await readFigure(t, browser);
  const studio = await startStudio(t, null, "--threads", "1");
  const page = await openPage(t, browser, studio.address, { viewport: { width: 1280, height: 1000 } });
  const program = await connect(page);
  const classes = new Map(JSON.parse(run("classes", "--json")).map((c) => [c.name, c]));
  const hands = new Hands(page, program, classes);
  await hands.press("Control+Enter"); // pauses: there is nothing to see until it is whole
  const job = await program.root();
  await page.locator("[role=treeitem]", { hasText: "Job" }).first().click();
  await new Builder(hands, figure).fill(figure.root, job.id);
  const all = new Map((await program.components()).map((c) => [c.id, c]));
  assert.deepEqual(values(all, await program.root()), values(figure.all, figure.root));

  await hands.press("Control+Shift+s");
  const name = page.locator("dialog input[type=text]");
  await name.fill("built.etd");
  await page.locator("dialog button[type=submit]:enabled").waitFor();
  await hands.press("Enter");
  const file = join(studio.folder, "built.etd");
  await until("it is saved", async () => existsSync(file) && readFileSync(file, "utf8") === (await program.text()));
  const out = scratch(t);
  for (const ending of ["npy", "png"]) {
    const [built, wanted] = [["built", file], ["wanted", join(folder, "glossy_box.etd")]].map(([what, from]) => {
      run("render", from, "--samples", "2", "--set", "image.width=48", "--set", "image.height=36", "-o", join(out, `${what}.${ending}`));
      const bytes = readFileSync(join(out, `${what}.${ending}`));
      return ending === "png" ? packed(bytes) : bytes;
    });
    assert.ok(built.equals(wanted), `the same ${ending}, byte for byte`);
    assert.ok(new Set(built.subarray(100)).size > 100, "with something in it");
  }
});
