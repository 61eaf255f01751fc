// What people do on the page, against the real program: panels, text, undo, keys, two browsers, accessibility.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { checkAccess, checkInside, connect, openBrowser, openPage, repository, run, scratch, startStudio, until, whole } from "./harness.mjs";

const page_ = join(repository, "studio");

const small = `# A ball, lit by the sky. This comment stays.
white = Lambertian { color: 0.75 }   # so does this

Job {
    renderer: PathTracer { samples: 4 }
    camera:   PerspectiveCamera { from: [0, 1, 5] m, to: [0, 0.5, 0] m }   # where from
    image:    ImageBuffer { width: 64, height: 48 }
    scene: BvhScene { objects: [
        Sphere { radius: 30 cm,   shader: white }   # the ball
        Environment { emission: EnvironmentEmission { radiance: 1 } }
    ] }
}
`;

async function begin(t, text = small) {
  const studio = await startStudio(t, text);
  const browser = await openBrowser(t);
  const page = await openPage(t, browser, studio.address);
  const program = await connect(page);

  return { studio, browser, page, program };
}

const row = (page, name) => page.locator("[role=treeitem]", { hasText: name }).first();
const field = (page, name) => page.locator(".field", { has: page.locator("label", { hasText: new RegExp(`^${name}$`) }) }).first();

test("a panel's edit changes the value in the text and nothing else", whole, async (t) => {
  const { page, program, studio } = await begin(t);
  assert.equal(await program.text(), small);
  await row(page, "Sphere").click();
  const entry = field(page, "radius").locator("input.entry");
  assert.equal(await entry.inputValue(), "30 cm");
  await entry.fill("45 cm");
  await entry.press("Enter");
  const wanted = small.replace("30 cm", "45 cm");
  await until("the text has the new radius", async () => (await program.text()) === wanted);
  await page.keyboard.press("Control+s");
  await until("it is saved", () => studio.read() === wanted);
});

test("what is refused is said at the field, and changes nothing", whole, async (t) => {
  const { page, program } = await begin(t);
  await row(page, "Sphere").click();
  const radius = field(page, "radius");
  await radius.locator("input.entry").fill("-1 m");
  await radius.locator("input.entry").press("Enter");
  await radius.locator("[role=alert]").waitFor();
  assert.equal(await program.text(), small);
});

test("sliders, choices and resets; one drag is one step of undo", whole, async (t) => {
  const { page, program } = await begin(t);
  await row(page, "Sphere").click();
  const slider = field(page, "radius").locator("input[type=range]");
  await slider.focus();
  await slider.evaluate((e) => {
    for (const v of [0.2, 0.4, 0.6]) {
      e.value = v;
      e.dispatchEvent(new Event("input", { bubbles: true }));
    }
    e.dispatchEvent(new Event("change", { bubbles: true }));
  });
  await until("the radius is dragged, in its unit", async () => /radius: 251 cm/.test(await program.text()));
  await page.keyboard.press("Control+z");
  await until("one undo is enough", async () => (await program.text()) === small);
  await field(page, "sides").locator("select").selectOption("front");
  await until("the choice is written", async () => /sides: front/.test(await program.text()));
  await field(page, "sides").locator("button[aria-label^='Reset']").click();
  await until("and not written any more", async () => (await program.text()) === small).catch(async (e) => assert.equal(await program.text(), small, String(e)));
});

test("two browsers see one document", whole, async (t) => {
  const { page, browser, program, studio } = await begin(t);
  const other = await openPage(t, browser, studio.address);
  await row(page, "Sphere").click();
  await row(other, "Sphere").click();
  await field(page, "radius").locator("input.entry").fill("1 m");
  await field(page, "radius").locator("input.entry").press("Enter");
  await until("the other sees it", async () => (await field(other, "radius").locator("input.entry").inputValue()) === "1 m");
  await other.keyboard.press("Control+z");
  await until("and takes it back", async () => (await program.text()) === small);
});

test("the text is edited as typed; what is not valid waits; panels follow", whole, async (t) => {
  const { page, program } = await begin(t);
  await row(page, "Sphere").click();
  await page.click("#tab-text");
  await page.locator(".cm-line", { hasText: "the ball" }).click();
  await page.keyboard.press("Home");
  for (let i = 0; i < "Sphere { radius: 30".length; ++i) await page.keyboard.press("ArrowRight");
  await page.keyboard.type("0");
  await until("the panel has the new radius", async () => (await field(page, "radius").locator("input.entry").inputValue()) === "300 cm");
  await page.keyboard.type("x");
  await page.locator(".problems").waitFor();
  assert.equal(await program.text(), small.replace("30 cm", "300 cm"), "the document keeps what is valid");
  await page.keyboard.press("Backspace");
  await page.locator(".problems").waitFor({ state: "detached" });
});

test("axe finds nothing wrong, in light and dark, in any view", whole, async (t) => {
  const { page, browser, studio } = await begin(t);
  const check = async (on, what) => {
    await checkAccess(on, what);
    await checkInside(on, what);
  };
  const light = await openPage(t, browser, studio.address, { colorScheme: "light", viewport: { width: 1024, height: 700 } });
  for (const [on, name] of [[page, "dark"], [light, "light"]]) {
    if (name === "dark") await on.emulateMedia({ colorScheme: "dark" });
    await check(on, `${name} picture`);
    await row(on, "Sphere").click();
    await on.click("button:has-text('Details')");
    await check(on, `${name} panel`);
    await on.click("#tab-text");
    await check(on, `${name} text`);
    await on.click("#tab-paths");
    await check(on, `${name} paths`);
    await on.click("#tab-picture");
    await on.locator("[aria-label='Add…']").first().click();
    await on.locator("dialog").waitFor();
    await check(on, `${name} classes`);
    await on.keyboard.press("Escape");
  }
});

test("a scene is built from nothing by keys alone, and renders to the bytes its text renders to", whole, async (t) => {
  const studio = await startStudio(t, null);
  const browser = await openBrowser(t);
  const page = await openPage(t, browser, studio.address);
  const program = await connect(page);
  const press = (keys) => page.keyboard.press(keys);
  const focusTree = () => page.locator("[role=tree]").focus();
  const goTo = async (name) => {
    await focusTree();
    await press("Home");
    for (let i = 0; i < 60; ++i) {
      const now = await page.locator("[role=treeitem][aria-selected=true]").first().textContent();
      if (now?.includes(name)) return;
      await press("ArrowDown");
    }
    throw new Error(`no row ${name}`);
  };
  const add = async (to, name, slot = "") => {
    await goTo(to);
    await press("Insert");
    await page.locator("dialog input[role=combobox]").waitFor();
    if (slot) {
      await press("Shift+Tab");
      const where = page.locator("dialog select");
      for (let i = 0; i < 20 && !(await where.evaluate((e) => e.selectedOptions[0].textContent)).endsWith(`: ${slot}`); ++i) await press("ArrowDown");
      await press("Tab");
    }
    await page.keyboard.type(name);
    await until(`${name} is found`, async () => (await page.locator("[role=option][aria-selected=true] b").textContent()) === name);
    await press("Enter");
    await page.locator("dialog").waitFor({ state: "detached" });
    await until(`${name} is selected`, async () => (await page.locator("[role=treeitem][aria-selected=true]").first().textContent())?.includes(name));
  };
  const scene = (await program.components()).find((c) => c.class.endsWith("Scene"));
  assert.ok(scene, "an empty document has a scene");
  await add(scene.class, "Sphere");
  await press("Enter"); // to its panel
  await until("a field has the focus", () => page.evaluate(() => document.activeElement?.closest(".panel") !== null));
  // Tab to the radius, and type it.
  for (let i = 0; i < 60; ++i) {
    if (await page.evaluate(() => document.activeElement?.id.endsWith("-radius"))) break;
    await press("Tab");
  }
  await press("Control+a");
  await page.keyboard.type("40 cm");
  await press("Enter");
  await until("the radius is written", async () => /radius: 40 cm/.test(await program.text()));
  await add("Sphere", "Lambertian", "shader");
  await add("Sphere", "Environment");
  await add("Environment", "EnvironmentEmission", "emission");
  await press("Control+Shift+s");
  const name = page.locator("dialog input[type=text]");
  await name.waitFor();
  await name.focus();
  await press("Control+a");
  await page.keyboard.type("built.etd");
  await page.locator("dialog button[type=submit]:enabled").waitFor();
  await press("Enter");
  const file = `${studio.folder}/built.etd`;
  await until("it is saved", () => {
    try {
      return readFileSync(file, "utf8") !== "";
    } catch {
      return false;
    }
  });
  assert.equal(readFileSync(file, "utf8"), await program.text());
  // The same scene as somebody would write it.
  const written = `${studio.folder}/written.etd`;
  writeFileSync(written, `Job {
    renderer: PathTracer { samples: 64 }
    camera: PerspectiveCamera { from: [0, 1, -5], to: [0, 1, 0] }
    image: ImageBuffer { width: 512, height: 512 }
    scene: BvhScene { objects: [
        Sphere { radius: 0.4, shader: Lambertian {} }
        Environment { emission: EnvironmentEmission {} }
    ] }
}`);
  const out = scratch(t);
  for (const [from, to] of [[file, "built"], [written, "written"]]) run("render", from, "--samples", "2", "--set", "image.width=64", "--set", "image.height=64", "-o", `${out}/${to}.npy`);
  const [built, wanted] = ["built", "written"].map((n) => readFileSync(`${out}/${n}.npy`));
  assert.ok(built.equals(wanted), "the same picture, byte for byte");
  assert.ok(new Set(built.subarray(200)).size > 50, "and one with something in it");
});

test("rows are dragged before others, and into scenes", whole, async (t) => {
  const nested = small.replace("        Environment", "        BvhScene { objects: [] }   # a scene inside\n        Environment");
  const { page, program } = await begin(t, nested);
  const order = async () => (await program.components()).filter((c) => c.uses.some((u) => u.member === "objects")).map((c) => `${c.class} in ${c.uses[0].id}.${c.uses[0].index}`).sort();
  const before = await order();
  await row(page, "Environment").dragTo(row(page, "Sphere"), { targetPosition: { x: 30, y: 4 } });
  await until("the sky is the first object", async () => (await order()).some((o) => /^Environment in \d+\.0$/.test(o)));
  await page.keyboard.press("Control+z");
  await until("undone", async () => JSON.stringify(await order()) === JSON.stringify(before) && (await program.text()) === nested);
  await row(page, "Sphere").dragTo(page.locator("[role=treeitem]", { hasText: "BvhScene" }).last());
  await until("the ball is in the scene inside", async () => /BvhScene \{ objects: \[\s*Sphere \{[^\n]*\}\s*\] \}/.test(await program.text()));
});

test("two builds of the page give the same bytes", whole, async (t) => {
  const folder = scratch(t);
  const bytes = ["a", "b"].map((name) => {
    // The second from another folder, by another name of the same one, at another time.
    execFileSync(process.execPath, [join(name === "a" ? page_ : "..", name === "a" ? "" : "studio", "build.mjs"), "--out", join(folder, name)], { cwd: name === "a" ? folder : page_ });
    return readFileSync(join(folder, name, "index.html"));
  });
  assert.ok(bytes[0].length > 500000 && bytes[0].equals(bytes[1]));
  assert.ok(!bytes[0].includes(repository), "and tell nothing of the folder");
});
