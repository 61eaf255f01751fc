// Random edits by the page's own controls, each taken back by a key: the first bytes are there again. 500 take ten minutes, so fewer
// are made unless ETENDUE_EDITS says how many.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { connect, openBrowser, openPage, run, startStudio, until, whole } from "./harness.mjs";

const scene = `# All that has a name is edited; what is written about it stays.
matt = Lambertian { color: 0.5 }   # twice
coat = PhongShader { color: rgb(0.2, 0.1, 0.05), exponent: 20 }
glow = DiffuseEmission { radiance: blackbody(3000 K), power: 20 W }  # warm
film = ImageBuffer { width: 8, height: 8, filter: soft }
soft = GaussianFilter {}
tracer = PathTracer { samples: 1,
                      max_depth: 6 }
eye = PerspectiveCamera { from: [0, 1, 5] m, to: [0, 0, 0] m }   # where from
ball = Sphere { radius: 30 cm, shader: matt }
box = Box { size: [1, 2, 1] m, transform: translate(1, 0, 0) * rotate(30 deg, "y"), shader: coat }
lamp = Rectangle { corner: [-0.5, 3, -0.5] m, edge_u: [1, 0, 0], edge_v: [0, 0, 1], emission: glow }
floor = Rectangle { corner: [-5, 0, -5], edge_u: [0, 0, 10], edge_v: [10, 0, 0], shader: matt }
tone = AgXToneMap {}

Job {
    renderer: tracer
    camera: eye; image: film
    tone_map: tone
    scene: BvhScene { objects: [ ball, box, lamp, floor ] }
}
`.replace("; image", "\n    image");

/** Numbers that look random and are the same in each run: a linear congruential generator (Park and Miller 1988). */
function numbers(seed) {
  let state = seed;
  return (n) => {
    state = (state * 48271) % 2147483647;
    return state % n;
  };
}

const wanted = Number(process.env.ETENDUE_EDITS ?? 60);

test(`${wanted} random edits are undone to the first byte`, whole, async (t) => {
  const studio = await startStudio(t, scene, "--threads", "1");
  const browser = await openBrowser(t);
  const page = await openPage(t, browser, studio.address, { viewport: { width: 1280, height: 1400 } });
  const program = await connect(page);
  await page.evaluate(readFileSync(new URL("panel_driver.js", import.meta.url), "utf8"));
  await program.ask("stop");
  assert.equal(await program.text(), scene);
  const classes = new Map(JSON.parse(run("classes", "--json")).map((c) => [c.name, c]));
  const names = ["coat", "glow", "film", "soft", "tracer", "eye", "ball", "box", "lamp", "floor", "tone"];
  const random = numbers(20261122);
  const outcomes = new Map();
  for (let made = 0, tried = 0; made < wanted; ++tried) {
    assert.ok(tried < 6 * wanted, `${made} edits of ${tried} were taken: ${JSON.stringify([...outcomes])}`);
    const name = names[random(names.length)];
    await page.evaluate((n) => driver.select(n), name);
    const component = (await program.components()).find((c) => c.name === name);
    // Several of one panel, as people do.
    const plain = classes.get(component.class).members.filter((m) => !["component", "file", "string"].includes(m.type) && !m.list);
    for (let i = 0; i < 6 && made < wanted; ++i) {
      const member = plain[random(plain.length)];
      const back = component.members[member.name].written && random(4) === 0;
      const outcome = await page.evaluate(([id, m, reset]) => (reset ? driver.reset(id, m.name) : driver.edit(id, m)), [component.id, member, back]);
      if (process.env.ETENDUE_TELL) console.error(`${name}.${member.name}: ${back ? "reset" : "edit"}: ${outcome}, ${Math.round(performance.now())} ms`);
      outcomes.set(outcome.slice(0, 7), (outcomes.get(outcome.slice(0, 7)) ?? 0) + 1);
      if (outcome === "changed") ++made;
    }
  }
  const changed = await program.text();
  assert.notEqual(changed, scene);
  for (const comment of scene.match(/#.*/g)) assert.ok(changed.includes(comment), `${comment} is still there`);
  const count = () => page.evaluate(() => studio.state.document.undo_count);
  const steps = await count();
  // Quick edits of one member are one step.
  assert.ok(steps >= 0.8 * wanted, `${steps} steps of undo`);
  await page.locator("[role=tree]").focus();
  for (let left = steps; left > 0; left = await count()) {
    await page.keyboard.press("Control+z");
    await until("a step is undone", async () => (await count()) < left);
  }
  assert.equal(await program.text(), scene);
});
