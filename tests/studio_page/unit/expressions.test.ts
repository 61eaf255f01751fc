import assert from "node:assert/strict";
import { test } from "node:test";
import { quote, readSteps, readVector, splitOutside, writeSteps, writeVector } from "../../../studio/src/model/expressions.ts";

test("separators count outside of brackets and quotes only", () => {
  assert.deepEqual(splitOutside('a, f(b, [c, d]), "e, \\", f", g', ","), ["a", "f(b, [c, d])", '"e, \\", f"', "g"]);
});

test("a coordinate is set and the others stay as they are written", () => {
  const vector = readVector("[278, 2 * size, -800] mm", 3);
  assert.ok(vector);
  assert.equal(writeVector(vector, 0, "300"), "[300, 2 * size, -800] mm");
  assert.equal(writeVector(vector, 2, "1.5 m"), "[278, 2 * size, 1500] mm", "its own unit is brought to that of the vector");
  const plain = readVector("[0, 1, 0]", 3);
  assert.ok(plain);
  assert.equal(writeVector(plain, 1, "30 cm"), "[0, 30 cm, 0]");
});

test("what is no plain vector is left to the text", () => {
  assert.equal(readVector("a + [0, 1, 0]", 3), null);
  assert.equal(readVector("[0, 1]", 3), null);
  assert.equal(readVector("[0, 1, # two\n 2]", 3), null);
  assert.equal(readVector("[0, 1, ]", 3), null);
});

test("products of transforms are taken apart and put together", () => {
  const text = 'translate(0, 1 m, 0) * rotate(30 deg, "y") * scale(2)';
  const steps = readSteps(text);
  assert.equal(steps?.length, 3);
  assert.equal(writeSteps(steps ?? []), text);
  assert.deepEqual(readSteps("identity"), []);
  assert.equal(writeSteps([]), "identity");
  for (const other of ["look_at([0, 0, 0], [0, 0, 1], [0, 1, 0])", "place", "translate(1, 0, 0) * place", "translate(1, 0, 0) # there"]) {
    assert.equal(readSteps(other), null, other);
  }
});

test("texts are quoted", () => {
  assert.equal(quote('a "b" \\ c\n'), '"a \\"b\\" \\\\ c\\n"');
});
