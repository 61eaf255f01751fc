import assert from "node:assert/strict";
import { test } from "node:test";
import { bandsOf, errorsOf, isBand, wavelengthOf } from "../../../studio/src/picture/bands.ts";

test("bands are the layers named by a wavelength, in its order, whatever the order of the layers", () => {
  const bands = bandsOf({ "S0.412,5nm": 2, "S0.405nm": 1, "variance.Y": 9, "albedo": [1, 2, 3], "S0.500nm": null, "response.red": 4 });
  assert.deepEqual(bands, { wavelengths: [405, 412.5], values: [1, 2], responses: [["red", 4]] });
  assert.equal(bandsOf({ "variance.Y": 1, "light.key.Y": 2 }), null);
});

test("polarized channels and reflectances are no bands of radiance", () => {
  assert.equal(wavelengthOf("S1.405nm"), null);
  assert.equal(wavelengthOf("T.405nm"), null);
  assert.equal(isBand("response.red"), true);
  assert.equal(isBand("light.key.Y"), false);
});

test("the standard error falls with the root of the samples", () => {
  const measured = { x: 1, y: 2, renders: 16, samples: 64, channels: ["S0.405nm"], values: [3], deviations: [8] };
  assert.equal(errorsOf(measured, 64).get("S0.405nm"), 1);
  assert.equal(errorsOf(measured, 256).get("S0.405nm"), 0.5);
});
