// The camera, saved views, renders side by side, states, checks, strategies apart, and `etendue view`.
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { checkAccess, checkInside, connect, emptyPage, openBrowser, openPage, run, scratch, startStudio, startView, until, whole } from "./harness.mjs";

const scene = `# A room with a lamp and a ball.
white = Lambertian { color: 0.75 }

Job {
    renderer: BidirectionalPathTracer { samples: 400000, max_depth: 4 }
    camera:   PerspectiveCamera { from: [0, 1, 5] m, to: [0, 0.5, 0] m }
    image:    ImageBuffer { width: 48, height: 36 }
    scene: BvhScene { objects: [
        Sphere { centre: [0, 0.5, 0] m, radius: 0.5 m, shader: white }
        Rectangle { corner: [-3, 0, -3] m, edge_u: [0, 0, 6], edge_v: [6, 0, 0], shader: white }
        Rectangle { corner: [-0.5, 3, -0.5] m, edge_u: [1, 0, 0], edge_v: [0, 0, 1], emission: DiffuseEmission { radiance: 8 } }
    ] }
}
`;

async function begin(t, more = {}) {
  const studio = await startStudio(t, scene, "--threads", "1");
  const browser = await openBrowser(t);
  const page = await openPage(t, browser, studio.address, more);
  const program = await connect(page);
  return { studio, browser, page, program };
}

const numbers = (text, member) => (new RegExp(`${member}: \\[([^\\]]*)\\]`).exec(text)?.[1] ?? "").split(",").map(Number);

test("the camera flies by keys, and one flight is one step of undo; views are saved and gone to", whole, async (t) => {
  const { page, program } = await begin(t);
  await program.ask("stop");
  await page.click("button[aria-label^='Fly']");
  await page.locator(".picture-over").focus();
  for (let i = 0; i < 3; ++i) await page.keyboard.down("w"); // held: it repeats
  await page.keyboard.up("w");
  const near = await until("the camera has come nearer", async () => {
    const text = await program.text();
    return numbers(text, "from")[2] < 4.5 ? text : null;
  });
  const [, y, z] = numbers(near, "from");
  // It looks along (0, -0.5, -5): so it flies, and what it looks at is as far away as before.
  assert.ok(Math.abs((1 - y) / (5 - z) - 0.1) < 0.01, `${y} ${z}`);
  assert.ok(Math.abs(numbers(near, "to")[2] - (z - 5)) < 0.01);
  await page.click("summary[aria-label='Saved views']");
  await page.getByLabel("Name of the view").fill("near");
  await page.keyboard.press("Enter");
  const saved = await until("it is saved in the text", async () => /near = (PerspectiveCamera.*)/.exec(await program.text())?.[1]);
  const distance = numbers(saved, "from")[2]; // the flight may have gone on since
  assert.ok(distance <= z && distance > 0, saved);
  await page.keyboard.press("Escape");
  await page.locator("[role=tree]").focus();
  await page.keyboard.press("Control+z");
  await page.keyboard.press("Control+z");
  await until("two steps undo both", async () => (await program.text()) === scene);
  await page.locator(".drop .dim", { hasText: "No saved views" }).waitFor(); // the list follows the text
  await page.keyboard.press("Control+y");
  await page.keyboard.press("Control+y");
  await page.click("button[aria-label^='Fly']");
  await page.locator(".picture-over").focus();
  await page.keyboard.press("s");
  await until("it has gone back", async () => numbers((await program.text()).split("Job")[1], "from")[2] > distance + 0.1);
  await page.locator(".drop button:has-text('near')").click();
  await until("it is where the view is", async () => Math.abs(numbers((await program.text()).split("Job")[1], "from")[2] - distance) < 1e-6);
});

test("renders stand side by side, live, with their errors", whole, async (t) => {
  const { page, program } = await begin(t, { viewport: { width: 1024, height: 720 } });
  await page.click("#tab-sides");
  await page.getByLabel("Algorithm").selectOption("PathTracer");
  await page.getByLabel("Settings", { exact: true }).fill("renderer.max_depth: 3");
  await page.locator(".sides button[type=submit]").click();
  const figures = page.locator("figure.side");
  await until("two stand there", async () => (await figures.count()) === 2);
  await until("both have a picture and an error", async () => {
    const lit = await page.evaluate(() => [...document.querySelectorAll("figure.side canvas")].map((c) => {
      const { data } = c.getContext("2d").getImageData(0, 0, c.width, c.height);
      return c.width > 8 && data.some((v, i) => i % 4 !== 3 && v > 40);
    }));
    const said = await figures.allTextContents();
    return lit.length === 2 && lit.every(Boolean) && said.every((s) => /Error [\d.]+ %/.test(s));
  });
  await until("both have a curve", async () => ((await page.locator(".sides-curves .curve").getAttribute("aria-label")) ?? "").split("%").length === 3);
  await checkAccess(page, "side by side");
  await checkInside(page, "side by side");
  await page.locator("figure.side button").click();
  await until("one is left", async () => (await figures.count()) === 1);
  await page.getByLabel("Settings", { exact: true }).fill("nonsense");
  await page.locator(".sides button[type=submit]").click();
  await page.locator(".notice-error").waitFor();
  assert.equal(await program.text(), scene, "all of that is no edit");
});

test("states are kept and gone on from; strategies stand apart; a class is checked", whole, async (t) => {
  const { page, program, studio } = await begin(t);
  await page.click("button:has-text('Details')");
  await until("there are samples", async () => !(await page.locator("button:has-text('Save checkpoint')").isDisabled()));
  await page.click("button:has-text('Save checkpoint')");
  const name = page.locator("dialog input[type=text]");
  await name.fill("kept.state");
  await page.locator("dialog button[type=submit]:enabled").waitFor();
  await name.press("Enter"); // wherever the focus has gone while the folder was read
  await until("the state is there", () => existsSync(join(studio.folder, "kept.state")));
  await program.ask("restart");
  await program.ask("stop");
  await page.click("button:has-text('Resume from checkpoint')");
  await page.locator("dialog .files button", { hasText: "kept.state" }).click();
  await until("it has the samples it had", async () => !/Samples 0 of/.test(await page.locator(".facts-row").first().textContent()));
  await page.click("button:has-text('Sampling strategies')");
  await page.locator(".task button:has-text('Show')").waitFor({ state: "attached" });
  await page.locator(".task summary").first().click();
  await page.locator(".task button:has-text('Show')").click();
  const pyramid = page.locator("dialog .pyramid figure");
  await until("a picture for each strategy", async () => (await pyramid.count()) >= 6);
  await checkAccess(page, "strategies");
  await page.keyboard.press("Escape");
  await page.locator("[role=treeitem]", { hasText: "BvhScene" }).first().click();
  await page.locator("button[aria-label^='Check the class']").click();
  await page.locator(".task", { hasText: "conform BvhScene" }).waitFor();
});

test("the spectrum of a pixel is a plot, with the band of its error once that was measured", whole, async (t) => {
  const spectral = scene.replace("ImageBuffer {", "SpectralFilm { bands: 31, low: 400 nm, high: 710 nm,").replace("BidirectionalPathTracer { samples: 400000", "PathTracer { samples: 256");
  const studio = await startStudio(t, spectral, "--threads", "1");
  const browser = await openBrowser(t);
  const page = await openPage(t, browser, studio.address);
  await until("all samples are there", async () => /Samples 256/.test(await page.locator(".facts-row").first().textContent()));
  const canvas = page.locator(".picture-over");
  await canvas.hover();
  await page.locator(".pixel-numbers dd").first().waitFor();
  await page.click("summary[title='Analyse']");
  const plot = page.locator(".pixel-spectrum svg");
  await plot.locator("polyline").waitFor({ state: "attached" });
  assert.equal((await plot.locator("polyline").getAttribute("points")).trim().split(" ").length, 31);
  assert.equal(await page.locator(".spectrum-error").count(), 0);
  assert.match(await page.locator(".pixel-spectrum").textContent(), /not known/);
  // The numbers of the pixel do not repeat its bands.
  assert.equal(await page.locator(".pixel-numbers dt", { hasText: "S0." }).count(), 0);
  await page.locator(".pixel-spectrum button").click();
  await page.locator(".spectrum-error").waitFor({ state: "attached" });
  assert.match(await page.locator(".pixel-spectrum").textContent(), /from 16 renders/);
  const points = (await page.locator(".spectrum-error").getAttribute("points")).trim().split(" ").map((p) => p.split(",").map(Number));
  assert.equal(points.length, 62);
  const [first, last] = [points[0], points[61]]; // the first band's upper edge, and its lower one
  assert.ok(first[0] === last[0] && first[1] < last[1]);
  await checkAccess(page, "the spectrum of a pixel");
  if (process.env.ETENDUE_PICTURES) await page.screenshot({ path: join(process.env.ETENDUE_PICTURES, "pixel_spectrum.png") });
});

test("pictures are viewed without a document", whole, async (t) => {
  const folder = scratch(t);
  const file = join(folder, "scene.etd");
  const { writeFileSync } = await import("node:fs");
  writeFileSync(file, scene);
  for (const name of ["a.exr", "b.png"]) run("render", file, "--samples", "2", "-o", join(folder, name));
  const address = await startView(t, folder, ["a.exr", "b.png"]);
  const browser = await openBrowser(t);
  const page = await emptyPage(browser, { viewport: { width: 1024, height: 700 } });
  await page.goto(address);
  await page.locator("select[aria-label='Pictures']").waitFor();
  assert.equal(await page.locator(".tree, .panel, .top").count(), 0, "no document is shown");
  await page.locator(".picture-over").hover({ position: { x: 500, y: 400 } });
  await until("a pixel's numbers", async () => /XYZ\s*[\d.]+e?-?\d*\s+[\d.]+/.test((await page.locator("#picture-numbers").textContent()) ?? ""));
  const first = await page.locator("#picture-numbers dd").nth(1).textContent();
  await page.keyboard.press("PageDown");
  await until("the next picture", async () => (await page.locator("select[aria-label='Pictures']").inputValue()).includes("b.png"));
  await page.locator(".picture-over").hover({ position: { x: 501, y: 400 } });
  await until("its numbers are others", async () => (await page.locator("#picture-numbers dd").nth(1).textContent()) !== first);
  await checkAccess(page, "view");
  await checkInside(page, "view");
});

test("warnings stand in the text; the program begins again and the page is there again", whole, async (t) => {
  const dark = scene.replace(", emission: DiffuseEmission { radiance: 8 }", "");
  assert.notEqual(dark, scene);
  const studio = await startStudio(t, dark, "--threads", "1");
  const browser = await openBrowser(t);
  const page = await openPage(t, browser, studio.address);
  await page.click("#tab-text");
  await page.locator(".cm-lintRange-warning").first().waitFor();
  await page.click("button:has-text('Details')");
  await page.click("button:has-text('Restart program')");
  await page.locator(".ended").waitFor();
  await page.locator(".ended").waitFor({ state: "detached" });
  await page.locator("[role=treeitem]", { hasText: "Sphere" }).first().click();
  await page.locator(".panel-title h2", { hasText: "Sphere" }).waitFor();
});

test("the window of files reads its folder when the line to the program is back", whole, async (t) => {
  const { page } = await begin(t);
  await page.click("button:has-text('Details')");
  await until("there are samples", async () => !(await page.locator("button:has-text('Save checkpoint')").isDisabled()));
  await page.evaluate(() => {
    const send = WebSocket.prototype.send;
    WebSocket.prototype.send = function (message) {
      if (!String(message).includes('"do":"files"')) return send.call(this, message);
      WebSocket.prototype.send = send;
      this.close(); // the line is lost while the folder is asked for
    };
  });
  await page.click("button:has-text('Save checkpoint')");
  await page.locator("dialog button[type=submit]:enabled").waitFor();
});
