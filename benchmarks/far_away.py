#!/usr/bin/env python3
"""Is what is closed dark, and are pictures the same, far from the origin and at any scale?

    python3 benchmarks/far_away.py [--program build/etendue] [--rays 1e7] > docs/results/leaks.md

Renders closed rooms that are lit from outside, in each structure, and a furnished room by each renderer. Needs NumPy.
"""

import argparse
import math
import pathlib
import subprocess
import sys
import tempfile

import numpy

STRUCTURES = ["EmbreeScene", "BvhScene", "OctreeScene", "GridScene", "BruteForceScene"]
PLACES = [(distance, 1.0) for distance in (0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7)]
SCALES = [(0, scale) for scale in (1e-6, 1e-4, 1e-2, 1e2, 1e4, 1e7)]
RENDERERS = {
    "PathTracer": "samples: 64, max_depth: 6",
    "BidirectionalPathTracer": "samples: 32, max_depth: 5",
    "LightTracer": "samples: 64, max_depth: 5",
    "DirectRenderer": "samples: 32",
    "DistributionRenderer": "samples: 2",
    "WhittedRenderer": "samples: 4",
    "AmbientOcclusionRenderer": "samples: 16, distance: SIZE m",
}
DIRECTION = (0.3713, 0.5571, -0.7428)  # along no axis
MATTE = "shader: Lambertian { color: 0.5 }"
SKY = "Environment { emission: DiffuseEmission { radiance: 1 } }"
FACES = ("triangles: [[0, 3, 2], [0, 2, 1], [4, 5, 6], [4, 6, 7], [0, 1, 5], [0, 5, 4], [1, 2, 6], [1, 6, 5], [2, 3, 7], [2, 7, 6],"
         " [3, 0, 4], [3, 4, 7]]")


class Where:
    """A place in the world, and how large things are there."""

    def __init__(self, distance, scale):
        self.origin = [distance * d for d in DIRECTION]
        self.scale = scale

    def at(self, *offset):
        return "[%.17g, %.17g, %.17g] m" % tuple(o + self.scale * x for o, x in zip(self.origin, offset))

    def size(self, x):
        return "%.17g" % (self.scale * x)


def description(where, renderer, structure, objects, size):
    return f"""Job {{ renderer: {renderer}
camera: PerspectiveCamera {{ from: {where.at(0.31, -1.2, 0.23)}, to: {where.at(0, 0.7, -0.11)}, up: [0, 0, 1], fov: 70 deg }}
image: ImageBuffer {{ width: {size}, height: {size}, filter: BoxFilter {{}} }}
scene: {structure} {{ objects: [ {objects} ] }} }}"""


def box(where):
    edge = where.size(4)
    return f"Box {{ centre: {where.at(0, 0, 0)}, size: [{edge}, {edge}, {edge}] m, {MATTE} }}"


def mesh(where):
    corners = [(-2, -2), (2, -2), (2, 2), (-2, 2)]
    places = ", ".join(where.at(x, y, z)[:-2] for z in (-2, 2) for x, y in corners)
    return f"TriangleMesh {{ positions: [{places}] m, {FACES}, {MATTE} }}"


def furnished(where):
    s = where.size
    moved = "translate(%s) * scale(%.17g)" % (where.at(0, 0, 0), where.scale)
    return f"""{box(where)}
Sphere {{ centre: {where.at(0.4, 0.5, 1.4)}, radius: {s(0.3)} m, emission: DiffuseEmission {{ radiance: 10 }} }}
Sphere {{ centre: {where.at(-0.7, 1, -0.6)}, radius: {s(0.5)} m, shader: Dielectric {{}} }}
Ellipsoid {{ centre: {where.at(0.9, 1.2, -1)}, radii: [{s(0.5)}, {s(0.4)}, {s(0.3)}] m, {MATTE} }}
Cylinder {{ transform: {moved} * translate(0.2, 0.4, -1.8), radius: 0.3, height: 0.7, shader: Conductor {{}} }}"""


class Program:
    def __init__(self, path, folder):
        self.path, self.folder = path, pathlib.Path(folder)

    def render(self, text):
        """The picture's second channel; a place that cannot be rendered has none."""
        scene, picture = self.folder / "scene.etd", self.folder / "picture.npy"
        scene.write_text(text)
        picture.unlink(missing_ok=True)
        subprocess.run([self.path, "render", str(scene), "-o", str(picture), "--quiet"])
        if not picture.exists():
            return numpy.full((1, 1), numpy.nan)
        return numpy.load(picture)[..., 1].astype(float)


def leak_table(program, rays, out):
    size, depth = 16, 8
    # A path has as many rays as segments, and one to the sky from each vertex but the last; none is ended by roulette.
    samples = math.ceil(rays / (size * size * (2 * depth - 1)))
    out(f"Light that gets in, of {rays:.0e} rays for each entry: pixels of {size * size} that are not black, in a room that is a "
        "`Box` / a `TriangleMesh`.\n")
    out("| place | scale | " + " | ".join(STRUCTURES) + " | bidirectional |")
    out("|---|---|" + "---|" * (len(STRUCTURES) + 1))
    total = 0
    for distance, scale in PLACES + SCALES:
        where, cells = Where(distance, scale), []
        for renderer, structure in [("PathTracer", s) for s in STRUCTURES] + [("BidirectionalPathTracer", "BvhScene")]:
            lit = []
            for room in (box, mesh):
                members = f"samples: {samples}, max_depth: {depth}, roulette_depth: {depth}"
                text = description(where, f"{renderer} {{ {members} }}", structure, room(where) + "\n" + SKY, size)
                lit.append(int((program.render(text) > 0).sum()))
            total += sum(lit)
            cells.append(" / ".join(map(str, lit)))
        out(f"| {distance:g} m | {scale:g} | " + " | ".join(cells) + " |")
    out(f"\n**{'None leaks' if total == 0 else str(total) + ' pixels are lit'}.**\n")


def picture_table(program, out):
    out("How much of a picture's light is otherwise than at the origin with the same random numbers, and how much its sum differs.\n")
    places = [p for p in PLACES + SCALES + [(1e3, 1e-6), (1e7, 1e3)] if p != (0, 1)]
    out("| renderer | " + " | ".join(f"{d:g} m, {s:g}" for d, s in places) + " |")
    out("|---|" + "---|" * len(places))
    for renderer, members in RENDERERS.items():
        def picture(distance, scale):
            where = Where(distance, scale)
            return program.render(description(where, f"{renderer} {{ {members.replace('SIZE', where.size(1))} }}", "EmbreeScene", furnished(where), 32))
        here, cells = picture(0, 1.0), []
        for place in places:
            there = picture(*place)
            cells.append("%.2g %% (%+.1g %%)" % (100 * abs(there - here).sum() / here.sum(), 100 * (there.sum() / here.sum() - 1)))
        out(f"| `{renderer}` | " + " | ".join(cells) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/etendue")
    parser.add_argument("--rays", type=float, default=1e7)
    arguments = parser.parse_args()

    def out(line):
        print(line, flush=True)

    out("# Far from the origin, and at any scale\n")
    out("Made by `python3 benchmarks/far_away.py`; see [decision 020](../decisions/020-rendering-space.md). Places lie in a direction "
        "along no axis. A room is 4 m wide, times the scale; the camera is in it.\n\n## Closed rooms are dark\n")
    with tempfile.TemporaryDirectory() as folder:
        program = Program(arguments.program, folder)
        leak_table(program, arguments.rays, out)
        out("## Pictures are the same\n")
        picture_table(program, out)


if __name__ == "__main__":
    sys.exit(main())
