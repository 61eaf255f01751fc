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
