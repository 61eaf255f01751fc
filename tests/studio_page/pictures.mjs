// Makes the pictures of docs/studio.md anew: node tests/studio_page/pictures.mjs [NAME…], after ./etendue test or what it prepares.
// They show what is on the page; whatever is random comes from the scenes' seeds.
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { emptyPage, openBrowser, openPage, connect, repository, startStudio, until } from "./harness.mjs";

const box = readFileSync(join(repository, "scenes/cornell_box.etd"), "utf8");
const room = `# A room with a lamp and a window.
wall = Lambertian { color: 0.7 }
lamp = Sphere { centre: [-1.2, 2.2, 0.5] m, radius: 12 cm, emission: DiffuseEmission { radiance: blackbody(2800 K), power: 60 W } }
window = Rectangle {
    corner: [1.98, 0.9, -1.2] m, edge_u: [0, 1.1, 0], edge_v: [0, 0, 1.6]
    emission: DiffuseEmission { radiance: illuminant("D65"), power: 120 W, sides: both }
}

Job {
    renderer: PathTracer { samples: 96 }
    camera: PerspectiveCamera { from: [0, 1.3, 3.9] m, to: [0, 1.2, 0] m, fov: 42 deg }
    image: ImageBuffer { width: 480, height: 360, layers: ["light.lamp", "light.window"] }
    scene: BvhScene { objects: [
        Rectangle { corner: [-2, 0, -2], edge_u: [0, 0, 4], edge_v: [4, 0, 0], shader: wall }
        Rectangle { corner: [-2, 2.6, -2], edge_u: [4, 0, 0], edge_v: [0, 0, 4], shader: wall }
        Rectangle { corner: [-2, 0, -2], edge_u: [4, 0, 0], edge_v: [0, 2.6, 0], shader: wall }
        Rectangle { corner: [-2, 0, -2], edge_u: [0, 2.6, 0], edge_v: [0, 0, 4], shader: Lambertian { color: srgb("#88a05a") } }
        Rectangle { corner: [2, 0, -2], edge_u: [0, 0, 4], edge_v: [0, 2.6, 0], shader: Lambertian { color: srgb("#b0603c") } }
        Sphere { centre: [0.5, 0.45, -0.4] m, radius: 45 cm, shader: Dielectric {} }
        lamp
        window
    ] }
}
`;

const row = (page, name) => page.locator("[role=treeitem]", { hasText: name }).first();
const finished = (page) => page.locator(".state-finished").waitFor();

/** What is done before each picture, from a fresh page on; the first gives the text. */
const pictures = {
  studio: [box, async (page) => {
    await row(page, "Rectangle").click();
    await page.hover(".field:has(label:text('corner'))");
  }],
  "studio-text": [box, async (page) => {
    await page.click("#tab-text");
    await row(page, "PathTracer").click();
    await page.locator(".cm-line", { hasText: "renderer: PathTracer" }).click();
    await page.keyboard.press("End");
    for (let i = 0; i < 2; ++i) await page.keyboard.press("ArrowLeft");
    await page.keyboard.type(", rou");
    await page.locator(".problems").waitFor();
    await page.keyboard.press("Control+Space");
    await page.locator(".cm-completionInfo").waitFor();
  }],
  "studio-classes": [box, async (page) => {
    await row(page, "Rectangle").click();
    await page.locator("[role=tree]").focus();
    await page.keyboard.press("Insert");
    await page.locator("dialog input[role=combobox]").fill("su");
    await page.locator("[role=option]").first().waitFor();
  }],
  "studio-lights": [room, async (page) => {
    await page.click("summary[aria-label='Light groups']");
    await page.getByLabel("Adjust lights").check();
    await page.getByRole("spinbutton", { name: "Brightness of lamp" }).fill("1.5");
    await page.getByRole("spinbutton", { name: "Brightness of window" }).fill("-2");
    await page.getByLabel("Colour of window").fill("#a0c0ff");
    await page.click("button:has-text('Auto')");
  }],
  "studio-paths": [box, async (page) => {
    await page.locator("[role=treeitem]", { hasText: "TriangleMesh" }).last().click();
    await page.click("button[aria-label^='Paths']");
    await page.locator(".picture-over").click({ position: { x: 240, y: 470 } });
    await page.click("#tab-paths");
    await page.locator(".path-head.open").waitFor();
    await page.locator(".space[aria-busy=false]").waitFor();
    await until("the handles are there", async () => (await page.locator(".space").getAttribute("data-handles")) !== "");
    await page.locator(".vertex").nth(1).click();
  }],
  "studio-sides": [box, async (page) => {
    await page.click("#tab-sides");
    await page.getByLabel("Algorithm").selectOption("BidirectionalPathTracer");
    await page.locator(".sides button[type=submit]").click();
    await until("both have a course", async () => ((await page.locator(".sides-curves .curve").getAttribute("aria-label")) ?? "").split("%").length === 3);
    await page.waitForFunction(() => [...document.querySelectorAll("figure.side .facts-row span:first-child")].every((s) => parseFloat(s.textContent) >= 24));
  }],
};

/** A PNG as WebP, by the browser: it is a quarter of the size. */
async function webp(browser, png) {
  const page = await emptyPage(browser);
  const data = await page.evaluate(async (coded) => {
    const image = new Image();
    image.src = `data:image/png;base64,${coded}`;
    await image.decode();
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [image.width, image.height];
    canvas.getContext("2d").drawImage(image, 0, 0);
    return canvas.toDataURL("image/webp", 0.8).split(",")[1];
  }, png.toString("base64"));
  await page.context().close();
  return Buffer.from(data, "base64");
}

const ends = [];
const t = { after: (end) => ends.push(end) };
const browser = await openBrowser(t);
const only = process.argv.slice(2);
try {
  for (const [name, [text, prepare]] of Object.entries(pictures)) {
    if (only.length && !only.includes(name)) continue;
    const studio = await startStudio(t, text);
    const page = await openPage(t, browser, studio.address, { colorScheme: "dark" });
    await connect(page);
    await page.click("button[aria-label='Hide the names of the tools']");
    await finished(page);
    await page.click("button:has-text('Auto')");
    await prepare(page);
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    writeFileSync(join(repository, `docs/pictures/${name}.webp`), await webp(browser, await page.screenshot()));
    console.log(name);
  }
} finally {
  for (const end of ends.reverse()) await end();
}
