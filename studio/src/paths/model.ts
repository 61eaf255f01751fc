// Replayed paths as the program tells them (docs/finding-fireflies.md).

export type Triple = [number, number, number];

export interface Vertex {
  kind: string;
  object: string;
  position: (number | null)[] | null;
  normal: (number | null)[] | null;
  lobe: string;
  density: number | null;
  throughput: (number | null)[];
  emitted: (number | null)[];
  direct: (number | null)[];
  note: string;
}

export interface Contribution {
  strategy: string;
  length: number;
  weight: number | null;
  luminance: number | null;
  splat: boolean;
}

export interface ReplayedPath {
  sample: number;
  wavelengths: number[];
  luminance: number | null;
  share: number | null;
  bad: boolean;
  vertices: Vertex[];
  light_vertices: Vertex[];
  contributions: Contribution[];
}

export interface Replay {
  renderer: string;
  pixel: [number, number];
  samples: number;
  luminance: number | null;
  paths: ReplayedPath[];
}

export interface Wireframe {
  lines: number[];
  camera?: { from?: Triple; to?: Triple; up?: Triple };
}

export function triple(v: (number | null)[] | null): Triple | null {
  const [x, y, z] = v ?? [];
  return typeof x === "number" && typeof y === "number" && typeof z === "number" ? [x, y, z] : null;
}

/** The places a path goes through. Of one that escapes, its last piece is drawn as long as `far`. */
export function places(vertices: Vertex[], far: number): Triple[] {
  const result: Triple[] = [];
  for (const vertex of vertices) {
    const at = triple(vertex.position);
    if (vertex.kind === "escaped") {
      const from = result[result.length - 1];
      const along = triple(vertex.normal);
      if (from && along) result.push([from[0] + far * along[0], from[1] + far * along[1], from[2] + far * along[2]]);
    } else if (at) result.push(at);
  }
  return result;
}
