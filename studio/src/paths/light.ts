// What a renderer holds of light in space, as the program tells it, and how it is drawn: photons as points with short tails
// where they came from, a guide's directions as a ball that reaches farther where they are likelier.
import type * as Three from "./three_parts.ts";
import type { Triple } from "./model.ts";

export interface Photons {
  all: number;
  /** Three numbers of each: place [m], unit way it went, flux in linear sRGB. */
  positions: number[];
  directions: number[];
  powers: number[];
  segments: number[];
  caustic: boolean[];
}

export interface Lobes {
  position: Triple;
  normal: Triple;
  /** With what probability the guide is asked; 0: nothing is learned yet. */
  share: number;
  rows: number;
  columns: number;
  /** [1/sr], row by row: by equal steps of z from 1 to -1, and of the angle from x towards y. */
  density: number[];
}

/** Colours by which photons are seen: their own, the brighter the more they carry; linear. */
export function photonColors(powers: readonly number[]): Float32Array {
  const most = (i: number): number => Math.max(powers[i] ?? 0, powers[i + 1] ?? 0, powers[i + 2] ?? 0);
  const sizes: number[] = [];
  for (let i = 0; i < powers.length; i += 3) sizes.push(most(i));
  const usual = [...sizes].sort((a, b) => a - b)[Math.floor(0.9 * (sizes.length - 1))] || 1;
  const colors = new Float32Array(powers.length);
  for (let i = 0; i < powers.length; i += 3) {
    const whole = most(i);
    const bright = 0.2 + 0.8 * Math.min(1, Math.sqrt(whole / usual));
    for (let c = 0; c < 3; ++c) colors[i + c] = whole > 0 ? (bright * Math.max(0, powers[i + c] as number)) / whole : bright;
  }
  return colors;
}

/** Places of a ball around a guide's point: as far out as directions are likely, `reach` for the likeliest. The first column follows the last. */
export function lobePlaces({ rows, columns, density, position }: Lobes, reach: number): { places: Float32Array; part: Float32Array; triangles: number[] } {
  const most = Math.max(...density, 1e-30);
  const places = new Float32Array(rows * columns * 3);
  const part = new Float32Array(rows * columns);
  const triangles: number[] = [];
  for (let row = 0; row < rows; ++row) {
    const z = 1 - (2 * (row + 0.5)) / rows;
    const r = Math.sqrt(1 - z * z);
    for (let column = 0; column < columns; ++column) {
      const at = row * columns + column;
      const phi = (2 * Math.PI * (column + 0.5)) / columns;
      const far = (part[at] = (density[at] ?? 0) / most);
      [r * Math.cos(phi), r * Math.sin(phi), z].forEach((d, axis) => (places[3 * at + axis] = (position[axis] as number) + reach * Math.max(0.03, far) * d));
      if (row === 0) continue;
      const next = row * columns + ((column + 1) % columns);
      triangles.push(at - columns, at, next, at - columns, next, next - columns);
    }
  }
  return { places, part, triangles };
}

export function photonsObject(three: typeof Three, photons: Photons, size: number): Three.Object3D[] {
  const { BufferGeometry, Float32BufferAttribute, LineBasicMaterial, LineSegments, Points, PointsMaterial } = three;
  const colors = photonColors(photons.powers);
  const points = new BufferGeometry();
  points.setAttribute("position", new Float32BufferAttribute(photons.positions, 3));
  points.setAttribute("color", new Float32BufferAttribute(colors, 3));
  const tails = new Float32Array(photons.positions.length * 2);
  const tailColors = new Float32Array(tails.length);
  for (let i = 0; i < photons.positions.length; i += 3) {
    for (let c = 0; c < 3; ++c) {
      tails[2 * i + c] = photons.positions[i + c] as number;
      tails[2 * i + 3 + c] = (photons.positions[i + c] as number) - size * 0.02 * (photons.directions[i + c] as number);
      tailColors[2 * i + c] = tailColors[2 * i + 3 + c] = colors[i + c] as number;
    }
  }
  const lines = new BufferGeometry();
  lines.setAttribute("position", new Float32BufferAttribute(tails, 3));
  lines.setAttribute("color", new Float32BufferAttribute(tailColors, 3));
  return [
    new Points(points, new PointsMaterial({ size: 3, sizeAttenuation: false, vertexColors: true })),
    new LineSegments(lines, new LineBasicMaterial({ vertexColors: true, transparent: true, opacity: 0.35 })),
  ];
}

export function lobesObject(three: typeof Three, lobes: Lobes, size: number): Three.Object3D[] {
  const { ArrowHelper, BufferGeometry, DoubleSide, Float32BufferAttribute, Mesh, MeshBasicMaterial, Vector3 } = three;
  const { places, part, triangles } = lobePlaces(lobes, size * 0.4);
  const colors = new Float32Array(places.length);
  part.forEach((p, i) => colors.set([0.05 + 0.95 * p, 0.2 + 0.4 * p, 0.6 * (1 - p) + 0.02], 3 * i));
  const ball = new BufferGeometry();
  ball.setAttribute("position", new Float32BufferAttribute(places, 3));
  ball.setAttribute("color", new Float32BufferAttribute(colors, 3));
  ball.setIndex(triangles);
  const material = new MeshBasicMaterial({ vertexColors: true, side: DoubleSide, transparent: true, opacity: 0.85 });
  return [new Mesh(ball, material), new ArrowHelper(new Vector3(...lobes.normal), new Vector3(...lobes.position), size * 0.15, 0x888888, size * 0.03)];
}
