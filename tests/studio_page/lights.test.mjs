// Light groups weighed by sliders and colours; photons and a guide drawn in space.
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { checkAccess, checkInside, connect, openBrowser, openPage, startStudio, until, whole } from "./harness.mjs";

const scene = (renderer, layers = "") => `# Two lamps.
key = Rectangle { corner: [-1, 3, -1], edge_u: [2, 0, 0], edge_v: [0, 0, 2], emission: DiffuseEmission { radiance: 3, sides: both } }
Job {
    renderer: ${renderer}
    camera: PerspectiveCamera { from: [0, 1, -5], to: [0, 0.5, 0] }
    image: ImageBuffer { width: 64, height: 48${layers} }
    scene: BvhScene { objects: [
        Rectangle { corner: [-3, -1, -3], edge_u: [6, 0, 0], edge_v: [0, 0, 6], shader: Lambertian { color: 0.7 } }
        key
        Sphere { centre: [2, 0, 1], radius: 0.2 m, emission: DiffuseEmission { radiance: 4 } }
    ] }
}
`;

async function begin(t, text) {
  const studio = await startStudio(t, text, "--threads", "1");
  const browser = await openBrowser(t);
  const page = await openPage(t, browser, studio.address);
  return { studio, page, program: await connect(page) };
}

const finished = async (program) => until("it is rendered", async () => (await program.ask("hello", { protocol: 1 })).progress.state === "finished");

test("lights are weighed by sliders, switches and colours, and saved so", whole, async (t) => {
  const { studio, page, program } = await begin(t, scene("PathTracer { samples: 32 }", ', layers: ["light.key"]'));
  await finished(program);
  // What the program knows of a pixel of the floor: its light as linear sRGB (IEC 61966-2-1) of X Y Z.
  const [x, y] = [32, 38];
  const { rgb, layers } = await program.ask("probe", { x, y });
  const linear = (X, Y, Z) => [3.2406 * X - 1.5372 * Y - 0.4986 * Z, -0.9689 * X + 1.8758 * Y + 0.0415 * Z, 0.0557 * X - 0.204 * Y + 1.057 * Z];
  const of = (name) => linear(...["X", "Y", "Z"].map((c) => layers[`light.${name}.${c}`]));
  const [key, rest] = [of("key"), of("rest")];
  assert.ok(key.every((v) => v > 0.01) && rest.every((v) => v > 0.001));

  const shown = async () => ((await page.locator("#picture-numbers dd").allTextContents()) ?? []).slice(0, 2);
  /** Goes to the pixel by keys. */
  const goThere = async () => {
    await page.locator(".picture-over").focus();
    for (let i = 0; i < 200; ++i) {
      const at = (await shown())[0]?.split(", ").map(Number);
      if (at && at[0] === x && at[1] === y) return;
      await page.keyboard.press(!at || at[0] < x ? "ArrowRight" : at[0] > x ? "ArrowLeft" : at[1] < y ? "ArrowDown" : "ArrowUp");
    }
  };
  const is = (wanted) => async () => {
    await goThere();
    const [at, numbers] = await shown();
    const now = numbers?.trim().split(/\s+/).map(Number) ?? [];
    return at === `${x}, ${y}` && wanted.every((v, c) => Math.abs(now[c] - v) < 0.01 * Math.max(...wanted) + 1e-4);
  };
  await until("the pixel's numbers are there", is(rgb));

  await page.click("summary[aria-label='Light groups']");
  await page.getByLabel("Adjust lights").check();
  await until("nothing has changed yet", is(rgb));
  const slider = page.getByRole("slider", { name: "Brightness of key in stops" });
  await slider.focus();
  await slider.fill("2");
  await until("the key light is four times as bright", is(rest.map((v, c) => v + 4 * key[c])));
  await page.getByLabel("Show other lights").uncheck();
  await until("and alone", is(key.map((v) => 4 * v)));
  await page.getByLabel("Colour of key").fill("#ff0000");
  await until("and red", is([4 * key[0], 0, 0]));
  await checkAccess(page, "lights");
  await checkInside(page, "lights");
  if (process.env.ETENDUE_SCREENSHOTS) await page.screenshot({ path: join(process.env.ETENDUE_SCREENSHOTS, "lights.png") });

  await page.click("summary[title='Analyse']");
  await page.click("button:has-text('Save picture')");
  await page.getByLabel("File").fill("red.exr");
  await page.keyboard.press("Enter");
  await until("it is saved", () => existsSync(join(studio.folder, "red.exr")));
  await page.getByLabel("Adjust lights").uncheck();
  await until("it is as it was", is(rgb));
});

test("photons and a guide are drawn in space", whole, async (t) => {
  const { page, program } = await begin(t, scene("PhotonMapper { samples: 4, photon_walks: 50000 }"));
  await finished(program);
  await page.click("#tab-paths");
  /** How many pixels of the drawing differ from its background and wires, in greys: those of light. */
  const drawn = async () => (await page.locator(".space canvas").screenshot()).length;
  await page.locator(".space[aria-busy=false]").waitFor();
  // The wires are on the screen when two pictures are the same.
  let before = 0;
  await until("the wires are drawn", async () => {
    const last = before;
    before = await drawn();
    return before === last;
  });
  await page.getByRole("button", { name: "Show photons" }).click();
  await page.locator(".photon-count").waitFor();
  assert.match((await page.locator(".photon-count").textContent()) ?? "", /^[\d,]+ of [\d,]+ photons/);
  if (process.env.ETENDUE_SCREENSHOTS) await page.screenshot({ path: join(process.env.ETENDUE_SCREENSHOTS, "photons.png") });
  await until("points are drawn", async () => (await drawn()) > 1.1 * before);
  await checkAccess(page, "photons");
  await page.getByRole("button", { name: "Show photons" }).click();
  await page.locator(".photon-count").waitFor({ state: "detached" });
  await page.getByRole("button", { name: "Show the guiding distribution at the pixel" }).isDisabled();
});

test("what a renderer does not have is said", whole, async (t) => {
  const { page, program } = await begin(t, scene("PathTracer { samples: 1 }"));
  await finished(program);
  await page.click("#tab-paths");
  await page.getByRole("button", { name: "Show photons" }).click();
  await page.getByText("PathTracer keeps no photons").waitFor();
  assert.equal(await page.locator("summary[aria-label='Light groups']").count(), 0, "there are no groups");
});
