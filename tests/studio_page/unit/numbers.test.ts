import assert from "node:assert/strict";
import { test } from "node:test";
import { brief, convert, duration, fromSlider, inUnitOf, toSlider } from "../../../studio/src/model/numbers.ts";

test("units of one dimension are converted, others are not", () => {
  assert.equal(convert("m", "cm"), 100);
  assert.equal(convert("deg", "rad"), Math.PI / 180);
  assert.equal(convert("m", "s"), undefined);
  assert.equal(convert("m", "furlong"), undefined);
});

test("a number keeps the unit it was written in", () => {
  assert.equal(inUnitOf("30 cm", 0.35, "m"), "35 cm");
  assert.equal(inUnitOf("1e2mm", 0.25, "m"), "250 mm");
  assert.equal(inUnitOf("0.3", 0.35, "m"), "0.35");
  assert.equal(inUnitOf("2 * size", 0.35, "m"), "0.35");
  assert.equal(inUnitOf("3 s", 0.35, "m"), "0.35", "what does not fit is not written");
});

test("numbers are brief and exact to their digits", () => {
  assert.equal(brief(0.1 + 0.2), "0.3");
  assert.equal(brief(1234567), "1234570");
  assert.equal(brief(1.5e-9), "1.5e-9");
  assert.equal(brief(3e10), "3e10");
  assert.equal(brief(-0.00012), "-0.00012");
});

test("a place on a slider and its value are inverse to each other", () => {
  for (const scale of [
    { low: 0, high: 10, logarithmic: false, integer: false },
    { low: 0.01, high: 100, logarithmic: true, integer: false },
    { low: -10, high: 10, logarithmic: false, integer: false },
  ]) {
    for (let t = 0; t <= 1; t += 0.05) {
      const again = toSlider(fromSlider(t, scale), scale);
      assert.ok(Math.abs(again - t) < 2e-3, `${t} became ${again}`);
    }
  }
  assert.equal(fromSlider(0.5, { low: 0.01, high: 100, logarithmic: true, integer: false }), 1);
  assert.equal(fromSlider(0.5, { low: 1, high: 4096, logarithmic: true, integer: true }), 64);
  assert.equal(fromSlider(0, { low: 0, high: 1, logarithmic: true, integer: false }), 0, "a logarithmic slider from 0 has it at its end");
});

test("durations", () => {
  assert.equal(duration(4.23), "4.2 s");
  assert.equal(duration(200), "3 min 20 s");
  assert.equal(duration(7500), "2 h 5 min");
  assert.equal(duration(Infinity), "–");
});
