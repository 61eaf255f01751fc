// Photons and guides as they are drawn: colours and the ball of directions.
import assert from "node:assert/strict";
import { test } from "node:test";
import { lobePlaces, photonColors, type Lobes } from "../../../studio/src/paths/light.ts";

test("photons keep their colour, and those that carry more are brighter", () => {
  const colors = photonColors([4, 2, 0, 1, 1, 1, 0, 0, 0, 4, 2, 0]);
  assert.ok(Math.abs((colors[0] as number) - 1) < 1e-6 && Math.abs((colors[1] as number) - 0.5) < 1e-6 && colors[2] === 0);
  assert.ok((colors[3] as number) < 0.7 && (colors[3] as number) > (colors[6] as number), "less than the bright one, more than none");
  assert.equal(photonColors([]).length, 0);
});

test("a guide's ball reaches as far as a direction is likely, and is closed around its axis", () => {
  const [rows, columns] = [8, 16];
  const lobes: Lobes = { position: [1, 2, 3], normal: [0, 0, 1], share: 0.5, rows, columns, density: new Array<number>(rows * columns).fill(0.08) };
  const even = lobePlaces(lobes, 2);
  for (let i = 0; i < even.places.length; i += 3) {
    const [x, y, z] = [0, 1, 2].map((a) => (even.places[i + a] as number) - (lobes.position[a] as number)) as [number, number, number];
    assert.ok(Math.abs(Math.hypot(x, y, z) - 2) < 1e-5);
  }
  assert.equal(even.triangles.length, 3 * 2 * columns * (rows - 1));
  assert.ok(even.triangles.every((t) => t >= 0 && t < rows * columns));
  lobes.density[3 * columns + 4] = 0.8; // row 3 of 8: z = 1 - 7/8; column 4 of 16: 9/16 of half a turn, that is pi 9 / 16
  const one = lobePlaces(lobes, 2);
  const at = 3 * (3 * columns + 4);
  const r = Math.sqrt(1 - (1 / 8) ** 2);
  [1 + 2 * r * Math.cos((9 * Math.PI) / 16), 2 + 2 * r * Math.sin((9 * Math.PI) / 16), 3 + 2 / 8].forEach((wanted, a) =>
    assert.ok(Math.abs((one.places[at + a] as number) - wanted) < 1e-5));
  assert.ok(Math.abs(Math.hypot((one.places[0] as number) - 1, (one.places[1] as number) - 2, (one.places[2] as number) - 3) - 0.2) < 1e-5, "a tenth as likely, a tenth as far");
});
