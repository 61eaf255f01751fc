import assert from "node:assert/strict";
import { test } from "node:test";
import { fromBase64, fromHalf } from "../../../studio/src/model/half.ts";
import { Film } from "../../../studio/src/picture/film.ts";
import { waveform } from "../../../studio/src/picture/scope.ts";

/** Bits of half floats (IEEE 754 binary16). */
const half = { zero: 0, quarter: 0x3400, one: 0x3c00, four: 0x4400, notANumber: 0x7e00, infinite: 0x7c00 };

test("a waveform counts each column's pixels by brightness, and leaves out what is dark, bad or outside", () => {
  const film = new Film(8, 4);
  const grey = (bits: number): number[] => [bits, bits, bits];
  // The left half is 1, the right half 4; one pixel is black, one no number, one infinite.
  const values: number[] = [];
  for (let y = 0; y < 4; ++y) {
    for (let x = 0; x < 8; ++x) {
      const bad = y === 0 ? { 0: half.zero, 1: half.notANumber, 7: half.infinite }[x] : undefined;
      values.push(...grey(bad ?? (x < 4 ? half.one : half.four)));
    }
  }
  film.write({ x0: 0, y0: 0, x1: 8, y1: 4 }, Uint16Array.from(values));
  const w = waveform(film, 2, -4, 4, 8); // a step is a power of two: from 2^-4 on
  const left = [...w.counts.subarray(0, 8)];
  const right = [...w.counts.subarray(8, 16)];
  // 0.2126 + 0.7152 + 0.0722 is 1 but for rounding: 1 lies in the step at 2^0 or just below it.
  assert.equal((left[3] as number) + (left[4] as number), 14);
  assert.equal((right[5] as number) + (right[6] as number), 15);
  assert.equal(left.concat(right).reduce((a, b) => a + b), 29);
});

test("half floats in base64 are little endian", () => {
  const bits = fromBase64(Buffer.from([0x00, 0x3c, 0x00, 0x34, 0x00, 0xc4]).toString("base64"));
  assert.deepEqual([...bits].map(fromHalf), [1, 0.25, -4]);
});
