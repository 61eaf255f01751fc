// What the page says while a document is on its way; the names of components and tools.
import assert from "node:assert/strict";
import { test } from "node:test";
import { checkAccess, checkInside, emptyPage, openBrowser, openPage, startStudio, until, whole } from "./harness.mjs";

const scene = `white = Lambertian { color: 0.75 }
ball = Sphere { radius: 0.2, shader: white }
Job {
    renderer: PathTracer { samples: 1 }
    camera: PerspectiveCamera { from: [0, 1, 5] m, to: [0, 0, 0] m }
    image: ImageBuffer { width: 32, height: 24 }
    scene: BvhScene { objects: [
        SubdivisionSurface {
            positions: [[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]]
            indices: [0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7], levels: 1, shader: white
        }
        ball
        Environment { emission: EnvironmentEmission { radiance: 1 } }
    ] }
}
`;

test("while a document is read the page says so, with its name and the time", whole, async (t) => {
  const studio = await startStudio(t, scene, "--threads", "1");
  const browser = await openBrowser(t);
  const page = await emptyPage(browser);
  // What the program says of reading is said here, as long as the test wants; all else is between the page and the program.
  const held = [];
  let say, letGo;
  await page.routeWebSocket(/socket/, (ws) => {
    say = (event) => ws.send(JSON.stringify({ event: "working", ...event }));
    ws.onMessage((message) => held.push(message));
    letGo = () => {
      const server = ws.connectToServer();
      server.onMessage((message) => ws.send(message));
      ws.onMessage((message) => server.send(message));
      held.forEach((message) => server.send(message));
    };
    say({ what: "open", file: "/far/away/forest.etd", seconds: 12 });
  });
  await page.goto(studio.address);
  const note = page.locator(".tree-pane .empty-note");
  await note.getByText("Reading forest.etd…").waitFor();
  assert.equal(await page.locator("[role=treeitem]").count(), 0);
  assert.match(await page.locator(".top .title").textContent(), /forest\.etd/);
  await page.locator(".canvases .empty-note", { hasText: "Reading forest.etd…" }).waitFor();
  await page.locator(".top .working .elapsed", { hasText: /^\d+ s$/ }).waitFor();
  await checkAccess(page, "reading");
  say({ what: null });
  letGo();
  await page.locator("[role=treeitem]", { hasText: "SubdivisionSurface" }).waitFor();
  await page.locator(".top .working").waitFor({ state: "detached" });
  assert.equal(await note.count(), 0);

  // Another one: what was there stays to be seen, and is no longer to be edited.
  const add = page.locator(".tree-pane [aria-label^='Add']");
  assert.ok(await add.isEnabled());
  say({ what: "open", file: "/far/away/other.etd", seconds: 0.1 });
  await page.locator(".top .working", { hasText: "Reading other.etd…" }).waitFor();
  assert.ok(await add.isDisabled());
  assert.ok((await page.locator("[role=treeitem]").count()) > 3);
  // An edit that takes long is told, and others may be made meanwhile.
  say({ what: "edit", file: null, seconds: 3 });
  await page.locator(".top .working", { hasText: "Working…" }).waitFor();
  assert.ok(await add.isEnabled());
  say({ what: null });
  await page.locator(".top .working").waitFor({ state: "detached" });
});

test("components are told by their names, or by the names of what is in them", whole, async (t) => {
  const studio = await startStudio(t, scene, "--threads", "1");
  const browser = await openBrowser(t);
  const page = await openPage(t, browser, studio.address);
  const row = (name) => page.locator("[role=treeitem]", { has: page.locator(".what", { hasText: new RegExp(`^${name}$`) }) });
  assert.equal(await row("ball").locator(".class").textContent(), "Sphere");
  assert.equal(await row("SubdivisionSurface").locator(".class").textContent(), "white");
  await row("ball").locator(".twist").click();
  await until("its shader", async () => (await row("white").locator(".class").allTextContents()).includes("Lambertian"));
});

test("tools have names until they are known", whole, async (t) => {
  const studio = await startStudio(t, scene, "--threads", "1");
  const browser = await openBrowser(t);
  const page = await openPage(t, browser, studio.address, { viewport: { width: 1024, height: 720 } });
  const names = async (on) => (await on.locator(".picture-bar [aria-label=Tools] .button span").allTextContents()).filter((n) => n !== "");
  assert.deepEqual(await names(page), ["Pan and zoom", "Select", "Orbit", "Fly", "Crop", "Paths"]);
  await checkInside(page, "tools with names");
  await checkAccess(page, "tools with names");
  await page.click("button[aria-label^='Select objects']");
  await until("it is known", async () => !(await names(page)).includes("Select"));
  await page.click("#tab-paths");
  await page.click("button:has-text('Choose a pixel')"); // chooses the tool as well
  await until("and so is what was chosen elsewhere", async () => !(await names(page)).includes("Paths"));
  // Another window of the same browser.
  const again = await page.context().newPage();
  await again.goto(studio.address);
  await again.waitForSelector("[role=treeitem]");
  assert.deepEqual(await names(again), ["Pan and zoom", "Orbit", "Fly", "Crop"]);
  await again.click("button[aria-label='Hide the names of the tools']");
  await until("none has a name", async () => (await names(again)).length === 0);
  assert.equal(await again.locator("button[aria-label='Hide the names of the tools']").count(), 0);
  await again.reload();
  await again.waitForSelector("[role=treeitem]");
  assert.deepEqual(await names(again), []);
});
