import assert from "node:assert/strict";
import { test } from "node:test";
import { Matrix4, Vector3 } from "three";
import { readSteps } from "../../../studio/src/model/expressions.ts";
import { changed, changedText, changeIn, type Change } from "../../../studio/src/model/placing.ts";

/** The matrix of a product of steps, worked out here from what docs/language.md says of them. */
function matrix(text: string): Matrix4 {
  const result = new Matrix4();
  for (const { call, parts } of readSteps(text) ?? []) {
    const n = parts.map((p) => parseFloat(p));
    if (call === "translate") result.multiply(new Matrix4().makeTranslation(n[0] as number, n[1] as number, n[2] as number));
    else if (call === "scale") result.multiply(new Matrix4().makeScale(n[0] as number, n[n.length > 1 ? 1 : 0] as number, n[n.length > 2 ? 2 : 0] as number));
    else {
      const letter = { '"x"': [1, 0, 0], '"y"': [0, 1, 0], '"z"': [0, 0, 1] }[parts[1] as string] ?? JSON.parse(parts[1] as string);
      result.multiply(new Matrix4().makeRotationAxis(new Vector3(...letter).normalize(), ((n[0] as number) * Math.PI) / 180));
    }
  }
  return result;
}

const near = (a: Matrix4, b: Matrix4): void => a.elements.forEach((v, i) => assert.ok(Math.abs(v - (b.elements[i] as number)) < 1e-4, `${a.elements} is not ${b.elements}`));

test("moving adds to the translation that is there, in its units, or puts one in front", () => {
  const by: Change = { kind: "move", by: [0.1, 0, -0.25] };
  assert.equal(changedText("translate(1, 2, 3)", true, by), "translate(1.1, 2, 2.75)");
  assert.equal(changedText('translate(10 cm, 0, 1 m) * rotate(30 deg, "y")', true, by), 'translate(20 cm, 0, 0.75 m) * rotate(30 deg, "y")');
  assert.equal(changedText('rotate(30, "y")', true, by), 'translate(0.1, 0, -0.25) * rotate(30, "y")');
  assert.equal(changedText("translate(width, 0, 0)", true, by), "translate(0.1, 0, -0.25) * translate(width, 0, 0)");
  assert.equal(changedText("matrix(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0)", false, by), "translate(0.1, 0, -0.25)");
  assert.equal(changedText("placed", true, by), "translate(0.1, 0, -0.25) * (placed)");
});

test("turning and scaling are about the object's own origin, for any transform", () => {
  const texts = ["translate(1, 2, 3)", 'translate(1, 2, 3) * rotate(40, "z") * scale(2, 1, 3)', 'rotate(20, "x")', "scale(2)", 'rotate(90 deg, "y") * translate(1, 0, 0)'];
  const axes: [number, number, number][] = [[0, 0, 1], [0, -1, 0], [0.6, 0, 0.8]];
  for (const text of texts) {
    for (const axis of axes) {
      const before = matrix(text);
      const origin = new Vector3(1, 2, 3);
      if (!text.startsWith("translate(1, 2, 3)")) origin.set(0, 0, 0); // without a leading translation: about that of the coordinates it is in
      const turn = new Matrix4().makeTranslation(origin).multiply(new Matrix4().makeRotationAxis(new Vector3(...axis), 0.5)).multiply(new Matrix4().makeTranslation(origin.clone().negate()));
      near(matrix(changedText(text, true, { kind: "turn", axis, angle: 0.5 })), turn.multiply(before));
    }
    near(matrix(changedText(text, true, { kind: "scale", by: [1.5, 1, 0.5] })), matrix(text).multiply(new Matrix4().makeScale(1.5, 1, 0.5)));
  }
});

test("steps of the same kind become one", () => {
  const turn: Change = { kind: "turn", axis: [0, 0, -1], angle: Math.PI / 6 };
  assert.equal(changedText('translate(0, 0, 1) * rotate(50 deg, "z")', true, turn), 'translate(0, 0, 1) * rotate(20 deg, "z")');
  assert.equal(changedText("scale(2)", true, { kind: "scale", by: [1.5, 1.5, 1.5] }), "scale(3)");
  assert.deepEqual(changed([], { kind: "scale", by: [1, 2, 1] }), [{ call: "scale", parts: ["1", "2", "1"] }]);
});

test("what is moved in the world is moved in the coordinates of the scene it is inside of", () => {
  const frame = matrix('translate(5, 0, 0) * rotate(90, "z") * scale(2)');
  const moved = changeIn(frame, { kind: "move", by: [0, 1, 0] });
  assert.ok(moved.kind === "move" && Math.abs(moved.by[0] - 0.5) < 1e-9 && Math.abs(moved.by[1]) < 1e-9);
  const turned = changeIn(frame, { kind: "turn", axis: [0, 1, 0], angle: 1 });
  assert.ok(turned.kind === "turn" && Math.abs(turned.axis[0] - 1) < 1e-9);
});
