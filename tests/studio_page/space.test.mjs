// The drawing in three dimensions: an object is moved and turned by its handles, in its transform's own words, one drag one step of undo.
import assert from "node:assert/strict";
import { test } from "node:test";
import { connect, openBrowser, openPage, startStudio, until, whole } from "./harness.mjs";

const scene = `# Two boxes, one inside a scene that is turned. This stays.
Job {
    renderer: PathTracer { samples: 1 }
    camera:   PerspectiveCamera { from: [0, 1, 8] m, to: [0, 0, 0] m }
    image:    ImageBuffer { width: 32, height: 24 }
    scene: BvhScene { objects: [
        Box { transform: translate(50 cm, 0, 0) * scale(1), shader: Lambertian {} }   # the box
        BvhScene { transform: rotate(90 deg, "z"), objects: [ Sphere { radius: 0.5 m, transform: translate(0, 2, 0) } ] }
        Environment { emission: EnvironmentEmission { radiance: 1 } }
    ] }
}
`;

/** Where pixels of one of the handles' colours are in the drawing: their middle, on the page. */
async function handle(page, color) {
  const box = await page.locator(".space").boundingBox();
  const picture = (await page.screenshot({ clip: box })).toString("base64");
  const found = await page.evaluate(async ([data, wanted]) => {
    const image = new Image();
    image.src = `data:image/png;base64,${data}`;
    await image.decode();
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const { data: pixels } = context.getImageData(0, 0, image.width, image.height);
    let far = null;
    for (let y = 0; y < image.height; ++y) {
      for (let x = 0; x < image.width; ++x) {
        const at = (y * image.width + x) * 4;
        if ([0, 1, 2].every((c) => Math.abs(pixels[at + c] - wanted[c]) < 30) && (!far || x > far[0])) far = [x, y]; // the arrow's end, on the right
      }
    }
    return far;
  }, [picture, color]);
  return found && [box.x + found[0], box.y + found[1]];
}

test("an object is moved by its handles", whole, async (t) => {
  const studio = await startStudio(t, scene, "--threads", "1");
  const browser = await openBrowser(t);
  const page = await openPage(t, browser, studio.address, { colorScheme: "dark" });
  const program = await connect(page);
  /** Drags the handle of a component that is selected. */
  const drag = async (name, dx) => {
    const { id } = (await program.components()).find((c) => c.class === name);
    await page.locator(`.space[data-handles="${id}"]`).waitFor();
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))); // and drawn
    const [x, y] = await until("the red arrow is seen", () => handle(page, [255, 0, 0]));
    await page.mouse.move(x - 3, y);
    await page.mouse.down();
    for (let i = 1; i <= 5; ++i) await page.mouse.move(x - 3 + (dx * i) / 5, y);
    await page.mouse.up();
  };
  await page.click("#tab-paths");
  await page.locator("[role=treeitem]", { hasText: "Box" }).first().click();
  await drag("Box", 60);
  const moved = /translate\(([\d.]+) cm, 0, 0\) \* scale\(1\)/;
  const text = await until("the text has another place", async () => {
    const now = await program.text();
    return moved.test(now) && Number(moved.exec(now)[1]) > 55 ? now : null;
  });
  assert.equal(text.replace(moved, "translate(50 cm, 0, 0) * scale(1)"), scene, "nothing else has changed");
  await until("the drag has ended", async () => (await page.evaluate(() => studio.state.document.undo_count)) === 1);
  await page.keyboard.press("Control+z");
  await until("one undo is enough", async () => (await program.text()) === scene);

  // What is inside another scene is moved in that one's coordinates: the world's x is its -y.
  await page.locator("[role=treeitem]", { hasText: "Sphere" }).first().click();
  await drag("Sphere", 60);
  await until("the sphere has moved along its own y", async () => {
    const found = /translate\((\S+), (\S+), (\S+)\) \} \]/.exec(await program.text());
    return found && Number(found[1]) === 0 && Number(found[2]) < 1.9 && Number(found[3]) === 0;
  });
});
