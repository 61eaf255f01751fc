// Pixels as the program sends them: binary messages, little endian, of docs/studio-protocol.md.

/** One message of pixels, taken apart. */
export interface Pixels {
  kind: "linear" | "toned";
  generation: number;
  width: number;
  height: number;
  x0: number;
  y0: number;
  fullWidth: number;
  fullHeight: number;
  scale: number;
  samples: number;
  coarse: boolean;
  finished: boolean;
  /** Of which `watch` it is. */
  slot: number;
  tiles: { x0: number; y0: number; x1: number; y1: number; values: Uint16Array | Uint8Array }[];
}

export const tileSize = 64;

/** Throws a RangeError where the message is shorter than it says. */
export function readPixels(message: ArrayBuffer): Pixels {
  const view = new DataView(message);
  const word = (at: number): number => view.getUint32(at, true);
  const kind = word(0);
  if (kind !== 1 && kind !== 2) throw new RangeError(`pixels of kind ${kind}`);
  const width = word(8);
  const height = word(12);
  const flags = word(40);
  const count = word(44);
  const pixels: Pixels = {
    kind: kind === 1 ? "linear" : "toned",
    generation: word(4),
    width,
    height,
    x0: word(16),
    y0: word(20),
    fullWidth: word(24),
    fullHeight: word(28),
    scale: view.getFloat32(32, true),
    samples: word(36),
    coarse: (flags & 1) !== 0,
    finished: (flags & 2) !== 0,
    slot: (flags >>> 8) & 255,
    tiles: [],
  };
  let at = (48 + 4 * count + 3) & ~3;
  for (let i = 0; i < count; ++i) {
    const x0 = view.getUint16(48 + 4 * i, true) * tileSize;
    const y0 = view.getUint16(50 + 4 * i, true) * tileSize;
    const x1 = Math.min(width, x0 + tileSize);
    const y1 = Math.min(height, y0 + tileSize);
    if (x1 <= x0 || y1 <= y0) throw new RangeError("a tile outside the picture");
    const length = (x1 - x0) * (y1 - y0) * 3;
    const values = kind === 1 ? new Uint16Array(message, at, length) : new Uint8Array(message, at, length);
    at += values.byteLength;
    pixels.tiles.push({ x0, y0, x1, y1, values });
  }
  return pixels;
}
