// Half floats (IEEE 754 binary16), as tiles bring them.

const table = new Float32Array(65536);
for (let bits = 0; bits < 65536; ++bits) {
  const sign = bits & 0x8000 ? -1 : 1;
  const exponent = (bits >> 10) & 31;
  const mantissa = bits & 1023;
  table[bits] =
    sign *
    (exponent === 0 ? mantissa * 2 ** -24 : exponent === 31 ? (mantissa ? NaN : Infinity) : (1 + mantissa / 1024) * 2 ** (exponent - 15));
}

/** The number a half float's bits stand for. */
export function fromHalf(bits: number): number {
  return table[bits & 0xffff] as number;
}

/** All of them, by their bits: for whoever needs many. */
export const halves: Readonly<Float32Array> = table;

const float = new Float32Array(1);
const word = new Uint32Array(float.buffer);

/** The bits of the nearest half float, ties to even; what is too large becomes the largest. */
export function toHalf(value: number): number {
  float[0] = value;
  const bits = word[0] as number;
  const sign = (bits >>> 16) & 0x8000;
  const size = bits & 0x7fffffff;
  if (size > 0x7f800000) return 0x7e00; // no number
  if (size >= 0x477ff000) return sign | 0x7bff;
  if (size < 0x38800000) return sign | Math.round(Math.abs(value) * 2 ** 24);
  return sign | ((size + 0x0fff + ((size >>> 13) & 1) - 0x38000000) >>> 13);
}

/** The bits of a half float times 2^power: what becomes too large is infinite, what becomes too small is 0. */
export function halfTimesPowerOfTwo(bits: number, power: number): number {
  const value = fromHalf(bits) * 2 ** power;
  const sign = bits & 0x8000;
  if (!Number.isFinite(value)) return bits;
  const size = Math.abs(value);
  if (size >= 65520) return sign | 0x7c00;
  if (size < 2 ** -14) return sign | Math.round(size * 2 ** 24);
  return ((bits & 0x7c00) === 0 ? encodeNormal(size) : (bits & 0x7fff) + (power << 10)) | sign;
}

function encodeNormal(size: number): number {
  const exponent = Math.floor(Math.log2(size));
  return ((exponent + 15) << 10) + Math.round((size / 2 ** exponent - 1) * 1024);
}

/** Half floats as JSON brings them: little endian, in base64. */
export function fromBase64(text: string): Uint16Array {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const view = new DataView(bytes.buffer);
  return Uint16Array.from({ length: bytes.length >> 1 }, (_, i) => view.getUint16(2 * i, true));
}
