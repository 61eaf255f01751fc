#!/usr/bin/env python3
"""Writes forest/trees.etd for forest.etd: scenes in scenes in scenes, each stored once and placed many times.

A leaf is 4 triangles; a twig is 14 leaves on a stalk; a tree 48 to 59 twigs on a trunk with boughs; a grove 22 trees; the
forest 36 groves: 631 848 instances, of which 588 952 are leaves, from 345 that are written out. +y is up; lengths are in metres.
"""
import math
import os
import random

rng = random.Random(2002)
GROVE_SIDE, GROVES = 22.0, 6


def numbers(values):
    return "[" + ", ".join("%.4g" % (v + 0.0) for v in values) + "]"


def instance(scene, place, turns, size, shader=None):
    """turns: (degrees, axis) from the last done to the first."""
    turn = " * ".join('rotate(%.0f, "%s")' % t for t in turns)
    return "    Instance { scene: %s, transform: translate%s * %s * scale(%.3g)%s }" % (
        scene, "(" + numbers(place)[1:-1] + ")", turn, size, ", shader: " + shader if shader else "")


def curve(strands, radii, shader):
    points = ", ".join(numbers(p) for s in strands for p in s)
    return "    Curve { basis: catmull_rom, turn: 20 deg, shader: %s, counts: [%s], radius: [%s]\n            points: [%s] }" % (
        shader, ", ".join(str(len(s)) for s in strands), ", ".join("%.3g" % r for s in radii for r in s), points)


def scene(name, objects):
    return "%s = EmbreeScene { objects: [\n%s\n] }\n" % (name, "\n".join(objects))


def twig(name):
    """A stalk along +y, 1 m long, with leaves that look outwards and up."""
    objects = [curve([[[0, 0, 0], [0.03, 0.35, 0.02], [-0.02, 0.7, -0.02], [0.02, 1, 0]]], [[0.016, 0.013, 0.009, 0.004]], "bark")]
    for k in range(14):
        y = 0.22 + 0.78 * k / 13
        objects.append(instance("leaf", (0, y, 0), [(137.5 * k + rng.uniform(-20, 20), "y"), (rng.uniform(30, 75) if k < 13 else 5, "z"),
                                                    (rng.uniform(-25, 25), "y")], rng.uniform(0.3, 0.42)))
    return scene(name, objects)


def broadleaf(name, shader, height, spread, boughs):
    """A trunk that forks into boughs with twigs along their outer parts, in the shape of an egg."""
    lean = [rng.uniform(-0.3, 0.3) for _ in range(4)]
    strands = [[[0, -0.3, 0], [lean[0] * 0.3, 0.3 * height, lean[1] * 0.3], [lean[0], 0.6 * height, lean[1]], [lean[2], 0.93 * height, lean[3]]]]
    radii = [[0.034 * height, 0.024 * height, 0.014 * height, 0.003 * height]]
    twigs = []
    for k in range(boughs):
        t = 0.3 + 0.62 * (k + 0.5) / boughs
        around = math.radians(137.5 * k + rng.uniform(-15, 15))
        reach = spread * math.sin(math.pi * (0.22 + 0.72 * (t - 0.3) / 0.62)) * rng.uniform(0.85, 1.1)
        rise = reach * rng.uniform(0.35, 0.6)
        bough = []
        for f in (0, 0.35, 0.7, 1):
            bough.append([lean[0] * t + f * reach * math.cos(around), t * height + rise * f ** 1.3, lean[1] * t + f * reach * math.sin(around)])
        strands.append(bough)
        radii.append([0.011 * height * (1.2 - t), 0.008 * height * (1.2 - t), 0.005 * height * (1.2 - t), 0.002 * height])
        for f in (0.45, 0.62, 0.78, 0.92, 1.0):
            place = [lean[0] * t + f * reach * math.cos(around), t * height + rise * f ** 1.3, lean[1] * t + f * reach * math.sin(around)]
            twigs.append((place, math.degrees(-around) + rng.uniform(-70, 70), rng.uniform(25, 75)))
    for k in range(4):
        twigs.append(([lean[2], height * (0.86 + 0.035 * k), lean[3]], 97 * k, rng.uniform(10, 45)))
    objects = [curve(strands, radii, "bark")]
    for place, about, tilt in twigs:
        objects.append(instance("twig", place, [(about, "y"), (-tilt, "z"), (rng.uniform(0, 360), "y")], rng.uniform(0.13, 0.19) * height, shader))
    return scene(name, objects)


def fir(name, height, whorls):
    """A straight trunk, whorls of twigs that hang a little and grow longer downwards."""
    objects = [curve([[[0, -0.3, 0], [0, 0.4 * height, 0], [0, 0.75 * height, 0], [0, height, 0]]],
                     [[0.02 * height, 0.014 * height, 0.006 * height, 0.002 * height]], "bark")]
    for k in range(whorls):
        y = height * (0.12 + 0.84 * k / (whorls - 1))
        for n in range(6 if k < whorls - 3 else 4):
            objects.append(instance("needles", (0, y, 0), [(60 * n + 35 * k + rng.uniform(-12, 12), "y"), (-rng.uniform(95, 108), "z"), (0, "y")],
                                    height * (0.025 + 0.23 * (1 - (y / height)) * rng.uniform(0.9, 1.1))))
    return scene(name, objects)


def needles():
    """A fir's bough: 14 leaves, narrow and in one plane, along 1 m."""
    objects = [curve([[[0, 0, 0], [0, 0.35, 0], [0, 0.7, 0], [0, 1, 0]]], [[0.012, 0.01, 0.007, 0.003]], "bark")]
    for k in range(14):
        side = 1 if k % 2 else -1
        y = 0.12 + 0.86 * k / 13
        objects.append("    Instance { scene: leaf, transform: translate(0, %.3g, 0) * rotate(%d, \"x\") * scale(%.3g, %.3g, %.3g), shader: fir_green }" % (
            y, side * rng.randint(38, 55) if k < 13 else 0, 0.4, 0.52 * (1.08 - y) + 0.1, 0.4))
    return scene("needles", objects)


def grove(name, kinds):
    """22 trees on a square, none too near another; mostly of the first kind."""
    objects, taken = [], []
    while len(objects) < 22:
        x, z = (rng.uniform(-0.5, 0.5) * GROVE_SIDE for _ in range(2))
        if any((x - a) ** 2 + (z - b) ** 2 < 3.1 ** 2 for a, b in taken):
            continue
        taken.append((x, z))
        kind = rng.choice(kinds)
        objects.append(instance(kind, (x, 0, z), [(rng.uniform(0, 360), "y"), (rng.uniform(-3, 3), "x")], rng.uniform(0.75, 1.2)))
    return scene(name, objects)


def ground(x, z):
    """The height of forest.etd's ground at a place: hills that rise inland, and the bed of a lake, whose water stands at -0.5 m."""
    shore = z + 1.6 * math.sin(0.13 * x) + 0.9 * math.sin(0.31 * x + 1)
    inland = max(0.0, min(1.0, (-4 - z) / 36))
    bed = max(0.0, min(1.0, (shore + 3) / 12))
    hills = 2.2 * math.sin(0.045 * x + 0.6) * math.cos(0.037 * z) + 0.9 * math.sin(0.11 * z + 0.05 * x)
    return inland * (hills + 0.07 * (-4 - z)) - 3 * bed * bed * (3 - 2 * bed)


parts = ["# The trees of forest.etd, as make_forest.py wrote them: leaves in twigs in trees in groves in the forest.\n",
         """bark = Lambertian { color: srgb(0.36, 0.28, 0.21) }
leaf_green = DiffuseTransmitter { reflectance: srgb(0.25, 0.36, 0.15), transmittance: srgb(0.3, 0.42, 0.1) }
birch_green = DiffuseTransmitter { reflectance: srgb(0.38, 0.45, 0.17), transmittance: srgb(0.45, 0.52, 0.14) }
autumn = DiffuseTransmitter { reflectance: srgb(0.62, 0.36, 0.1), transmittance: srgb(0.62, 0.33, 0.06) }
fir_green = DiffuseTransmitter { reflectance: srgb(0.16, 0.28, 0.17), transmittance: srgb(0.08, 0.16, 0.07) }
""",
         # A leaf of length 1 from the origin along +y, folded along its middle.
         """leaf = EmbreeScene { objects: [
    TriangleMesh { positions: [[0, 0, 0], [0.02, 0.45, 0.24], [-0.05, 0.5, 0], [0.02, 0.45, -0.24], [0, 1, 0]]
                   triangles: [[0, 2, 1], [0, 3, 2], [2, 4, 1], [3, 4, 2]], shader: leaf_green }
] }
""",
         twig("twig"), needles(),
         broadleaf("oak", None, 8.5, 3.1, 11), broadleaf("birch", "birch_green", 10, 2.1, 10), broadleaf("maple", "autumn", 7.5, 2.6, 10),
         fir("fir", 12, 9),
         grove("grove_oaks", ["oak", "oak", "oak", "birch", "maple"]), grove("grove_mixed", ["oak", "birch", "fir", "fir", "maple"]),
         grove("grove_firs", ["fir", "fir", "fir", "birch"])]

groves = []
for i in range(GROVES):
    for k in range(GROVES):
        x, z = (i - (GROVES - 1) / 2) * GROVE_SIDE, -(k + 0.5) * GROVE_SIDE - 4
        kind = rng.choice(["grove_oaks", "grove_mixed", "grove_firs"] if k > 1 else ["grove_oaks", "grove_mixed"])
        groves.append(instance(kind, (x, ground(x, z) - 0.4, z), [(90 * rng.randrange(4), "y"), (0, "x")], 1))
parts.append(scene("trees", groves))

# The ground, 160 m x 200 m about (0, -60), as a height field: x along x, and y along -z once it is turned upright.
nx, ny = 41, 51
heights = [ground(-80 + 4 * i, -(-40 + 4 * j)) for j in range(ny) for i in range(nx)]
parts.append("""forest_floor = Heightfield {
    nx: %d, ny: %d, size: [160, 200] m, height: 1 m, smooth: true, transform: translate(0, 0, -60) * rotate(-90, "x")
    heights: [%s]
    shader: Lambertian { color: FbmMap { first: srgb(0.3, 0.26, 0.17), second: srgb(0.38, 0.44, 0.2), size: 6 m } }
}
""" % (nx, ny, ", ".join("%.2f" % h for h in heights)))

folder = os.path.join(os.path.dirname(os.path.abspath(__file__)), "forest")
os.makedirs(folder, exist_ok=True)
with open(os.path.join(folder, "trees.etd"), "w") as out:
    out.write("\n".join(parts))
text = "".join(parts)
print("wrote forest/trees.etd:", text.count("Instance {"), "instances written out")
