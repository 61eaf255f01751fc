import assert from "node:assert/strict";
import { test } from "node:test";
import { fromHalf, halfTimesPowerOfTwo } from "../../../studio/src/model/half.ts";
import { readPixels } from "../../../studio/src/model/pixels.ts";
import { Film, histogram, isBad, union } from "../../../studio/src/picture/film.ts";
import { fit, toCanvas, toPicture, zoomAbout } from "../../../studio/src/picture/view.ts";

test("half floats: the table of IEEE 754-2008 binary16", () => {
  const known: [number, number][] = [
    [0x0000, 0], [0x3c00, 1], [0x4000, 2], [0xc000, -2], [0x3555, 0.333251953125], [0x7bff, 65504], [0x0400, 2 ** -14], [0x0001, 2 ** -24], [0x03ff, 2 ** -14 - 2 ** -24],
    [0x7c00, Infinity], [0xfc00, -Infinity],
  ];
  for (const [bits, value] of known) assert.equal(fromHalf(bits), value);
  assert.ok(Number.isNaN(fromHalf(0x7e00)));
});

test("a power of two on the bits is a power of two on the number", () => {
  for (let bits = 0; bits < 0x7c00; bits += 7) {
    for (const power of [-3, -1, 0, 1, 4]) {
      const exact = fromHalf(bits) * 2 ** power;
      const got = fromHalf(halfTimesPowerOfTwo(bits, power));
      if (exact >= 65520) assert.equal(got, Infinity);
      else assert.ok(Math.abs(got - exact) <= 2 ** -25 + 1e-18, `${bits.toString(16)} times 2^${power}: ${got}, not ${exact}`);
      assert.equal(fromHalf(halfTimesPowerOfTwo(bits | 0x8000, power)), -got);
    }
  }
});

function message(width: number, height: number, tiles: [number, number][], value: (x: number, y: number, c: number) => number): ArrayBuffer {
  const sizes = tiles.map(([c, r]) => (Math.min(width, 64 * c + 64) - 64 * c) * (Math.min(height, 64 * r + 64) - 64 * r) * 6);
  const start = (48 + 4 * tiles.length + 3) & ~3;
  const buffer = new ArrayBuffer(start + sizes.reduce((a, b) => a + b, 0));
  const view = new DataView(buffer);
  [1, 5, width, height, 0, 0, width, height].forEach((v, i) => view.setUint32(4 * i, v, true));
  view.setFloat32(32, 1, true);
  view.setUint32(36, 8, true);
  view.setUint32(44, tiles.length, true);
  let at = start;
  tiles.forEach(([c, r], i) => {
    view.setUint16(48 + 4 * i, c, true);
    view.setUint16(50 + 4 * i, r, true);
    for (let y = 64 * r; y < Math.min(height, 64 * r + 64); ++y) {
      for (let x = 64 * c; x < Math.min(width, 64 * c + 64); ++x) for (let k = 0; k < 3; ++k, at += 2) view.setUint16(at, value(x, y, k), true);
    }
  });
  return buffer;
}

test("tiles find their places, those at the edges too", () => {
  const pixels = readPixels(message(100, 70, [[0, 0], [1, 1]], (x, y, c) => (x + 3 * y + 7 * c) & 0x3fff));
  assert.equal(pixels.samples, 8);
  const film = new Film(100, 70);
  for (const tile of pixels.tiles) film.write(tile, tile.values as Uint16Array);
  for (const [x, y] of [[0, 0], [63, 63], [64, 64], [99, 69]] as const) {
    assert.equal(film.rgb(x, y)[1], fromHalf((x + 3 * y + 7) & 0x3fff), `${x}, ${y}`);
  }
  assert.deepEqual(film.rgb(64, 0), [0, 0, 0], "a tile that did not come is as it was");
});

test("messages that are cut off or lie about their size are refused", () => {
  const whole = message(100, 70, [[0, 0]], () => 0);
  assert.throws(() => readPixels(whole.slice(0, whole.byteLength - 2)), RangeError);
  assert.throws(() => readPixels(whole.slice(0, 20)), RangeError);
  assert.throws(() => readPixels(message(100, 70, [[0, 0]], () => 0).slice(0, 48)), RangeError);
  const far = message(100, 70, [[0, 0]], () => 0);
  new DataView(far).setUint16(48, 9, true);
  assert.throws(() => readPixels(far), RangeError);
});

test("another scale leaves the values as they are", () => {
  const film = new Film(1, 1);
  film.write({ x0: 0, y0: 0, x1: 1, y1: 1 }, new Uint16Array([0x3c00, 0x4000, 0x3555]));
  film.rescale(4);
  assert.deepEqual(film.rgb(0, 0), [1, 2, 0.333251953125]);
});

test("bad pixels", () => {
  assert.ok(isBad([NaN, 0, 0]) && isBad([0, Infinity, 0]) && isBad([-1, -1, -1]));
  assert.ok(!isBad([-0.01, 0.5, 0.2]), "a colour outside of sRGB is not bad");
});

test("the histogram counts every pixel once", () => {
  const film = new Film(4, 1);
  film.write({ x0: 0, y0: 0, x1: 4, y1: 1 }, new Uint16Array([0x3c00, 0x3c00, 0x3c00, 0x4000, 0x4000, 0x4000, 0x7e00, 0, 0, 0, 0, 0]));
  const h = histogram(film, -4, 4, 8);
  assert.deepEqual([...h.counts[3]], [0, 0, 0, 0, 1, 1, 0, 0]);
  assert.equal(h.bad, 1);
});

test("zooming keeps the place under the mouse", () => {
  const view = fit({ width: 640, height: 480 }, { width: 1000, height: 800 });
  const before = toPicture(view, 300, 200);
  const after = toPicture(zoomAbout(view, 3.7, 300, 200), 300, 200);
  assert.ok(Math.hypot(before[0] - after[0], before[1] - after[1]) < 1e-9);
  const [x, y] = toCanvas(view, ...before);
  assert.ok(Math.hypot(x - 300, y - 200) < 1e-9);
});

test("what changed grows to hold all", () => {
  assert.deepEqual(union({ x0: 1, y0: 2, x1: 3, y1: 4 }, { x0: 0, y0: 3, x1: 2, y1: 9 }), { x0: 0, y0: 2, x1: 3, y1: 9 });
});
