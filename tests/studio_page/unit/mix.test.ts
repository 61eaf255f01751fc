// Light groups weighed on the page: halves, factors, and sums.
import assert from "node:assert/strict";
import { test } from "node:test";
import { fromHalf, toHalf } from "../../../studio/src/model/half.ts";
import { Film } from "../../../studio/src/picture/film.ts";
import { asItIs, factorsOf, mix } from "../../../studio/src/picture/mix.ts";

test("every half comes back, and numbers become the nearest one", () => {
  for (let bits = 0; bits < 65536; ++bits) if (((bits >> 10) & 31) !== 31) assert.equal(fromHalf(toHalf(fromHalf(bits))), fromHalf(bits));
  assert.equal(toHalf(1 + 1 / 2048), 0x3c00, "ties go to even");
  assert.equal(toHalf(1 + 3 / 2048), 0x3c02);
  assert.equal(toHalf(1e9), 0x7bff);
  assert.equal(toHalf(-2), 0xc000);
  assert.ok(Number.isNaN(fromHalf(toHalf(NaN))));
});

test("a gain is a factor of linear light", () => {
  assert.deepEqual(factorsOf(asItIs), [1, 1, 1]);
  assert.deepEqual(factorsOf({ on: true, stops: 3, color: "#ffffff" }), [8, 8, 8]);
  assert.deepEqual(factorsOf({ on: false, stops: 3, color: "#ffffff" }), [0, 0, 0]);
  // IEC 61966-2-1: 188 of 255 is half of the light, 0 none of it.
  const [r, g, b] = factorsOf({ on: true, stops: 0, color: "#bc00ff" });
  assert.ok(Math.abs(r - 0.503) < 1e-3 && g === 0 && b === 1);
});

test("groups add up, in whatever scale they come", () => {
  const film = (scale: number, ...values: number[]): Film => {
    const made = new Film(2, 1);
    made.scale = scale;
    made.write({ x0: 0, y0: 0, x1: 2, y1: 1 }, Uint16Array.from(values, (v) => toHalf(v / scale)));
    return made;
  };
  const into = new Film(2, 1);
  into.takeChanged();
  mix([{ film: film(1, 1, 2, 3, 4, 5, 6), factors: [1, 1, 1] }, { film: film(16, 10, 20, 30, 40, 50, 60), factors: [0.5, 0, 2] }], into);
  assert.deepEqual(into.rgb(0, 0), [6, 2, 63]);
  assert.deepEqual(into.rgb(1, 0), [24, 5, 126]);
  assert.deepEqual(into.takeChanged(), { x0: 0, y0: 0, x1: 2, y1: 1 }, "it is to be drawn");
});
