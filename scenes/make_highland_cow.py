#!/usr/bin/env python3
"""Writes data/highland_cow.etd for highland_cow.etd: the hair of the cow of figures/cow.etd, strand by strand. Takes a minute.

A strand begins where the soft balls' density is that of the surface, leans backwards and down over the body, and is bent down by
its weight; where it would get into the body it is pushed out. Strands that begin near each other form locks: they lean the same
way. +z is up; lengths are in metres.
"""
import math
import os
import random
import re

HERE = os.path.dirname(os.path.abspath(__file__))
THRESHOLD, STRANDS, POINTS = 0.25, 60000, 5
rng = random.Random(1884)


def lists(text):
    """The numbers of the two lists of cow.etd, comments left out."""
    text = re.sub("#.*", "", text)
    found = {}
    for name, body in re.findall(r"(\w+) = (\[.*?\])\s*m?\s*(?=\w+ =|\Z)", text, re.S):
        numbers = [float(n) for n in re.findall(r"-?\d+\.?\d*(?:e-?\d+)?", body)]
        found[name] = numbers
    centres = found["cow_centers"]
    return list(zip(centres[0::3], centres[1::3], centres[2::3])), found["cow_radii"]


CENTRES, RADII = lists(open(os.path.join(HERE, "figures", "cow.etd"), encoding="utf-8").read())
CELL = 0.1
CELLS = {}  # which balls reach into a cell
for index, ((bx, by, bz), br) in enumerate(zip(CENTRES, RADII)):
    spans = [range(math.floor((c - br) / CELL), math.floor((c + br) / CELL) + 1) for c in (bx, by, bz)]
    for i in spans[0]:
        for j in spans[1]:
            for k in spans[2]:
                CELLS.setdefault((i, j, k), []).append(index)


def field(x, y, z):
    """The density, its gradient, and the ball that brings the most."""
    density, gx, gy, gz, best, most = 0.0, 0.0, 0.0, 0.0, -1, 0.0
    for index in CELLS.get((math.floor(x / CELL), math.floor(y / CELL), math.floor(z / CELL)), ()):
        cx, cy, cz = CENTRES[index]
        dx, dy, dz = x - cx, y - cy, z - cz
        rr = RADII[index] ** 2
        t = 1 - (dx * dx + dy * dy + dz * dz) / rr
        if t <= 0:
            continue
        share = t * t * t
        density += share
        slope = -6 * t * t / rr
        gx += slope * dx
        gy += slope * dy
        gz += slope * dz
        if share > most:
            best, most = index, share
    return density, (gx, gy, gz), best


def unit(v):
    size = math.sqrt(sum(c * c for c in v)) or 1
    return tuple(c / size for c in v)


def along(*terms):
    """The direction of a sum of vectors, each with its weight."""
    return unit(tuple(sum(w * v[c] for w, v in terms) for c in range(3)))


def chance():
    while True:
        v = tuple(rng.uniform(-1, 1) for _ in range(3))
        if 0.01 < sum(c * c for c in v) < 1:
            return unit(v)


def root(index):
    """A place on the surface over a ball, or none."""
    cx, cy, cz = CENTRES[index]
    d = chance()
    low, high = 0.0, RADII[index]
    if field(cx, cy, cz)[0] < THRESHOLD or field(cx + d[0] * high, cy + d[1] * high, cz + d[2] * high)[0] > THRESHOLD:
        return None
    for _ in range(14):
        middle = (low + high) / 2
        if field(cx + d[0] * middle, cy + d[1] * middle, cz + d[2] * middle)[0] > THRESHOLD:
            low = middle
        else:
            high = middle
    p = (cx + d[0] * low, cy + d[1] * low, cz + d[2] * low)
    density, gradient, best = field(*p)
    return (p, unit(tuple(-g for g in gradient))) if best == index else None


def locks(p):
    """A direction that all strands of a lock share, which is about 5 cm wide."""
    noise = random.Random(hash(tuple(math.floor(c / 0.05 + 0.5 * math.sin(17 * (a + 1) * p[a - 1])) for a, c in enumerate(p))))
    return unit((noise.uniform(-1, 1), noise.uniform(-1, 1), noise.uniform(-1, 1)))


def style(p):
    """Length of the strands at a place, and which way they are combed."""
    x, y, z = p
    if z > 1.33 and x > 0.93:  # the forelock, which falls over the face, and the ears
        return (0.3 if abs(y) < 0.14 else 0.2), (0.8, 0.4 * y, -0.6)
    if x > 1.18:  # the face
        return 0.05, (0.5, 0, -0.9)
    if x < -0.95:  # the tail, with its tassel
        return (0.3 if z < 0.6 else 0.12), (-0.2, 0, -1)
    if z < 0.5:  # the legs, longer around the hooves
        return (0.1 if z < 0.2 else 0.08), (-0.2, 0, -1)
    if x > 0.6:  # the neck and the dewlap
        return 0.22, (-0.3, 0, -0.9)
    return 0.17 + 0.08 * (z < 0.85), (-0.55, 0, -0.8)


def strand(p, normal):
    length, comb = style(p)
    length *= rng.uniform(0.7, 1.15)
    direction = along((0.55, normal), (0.75, unit(comb)), (0.45, locks(p)), (0.12, chance()))
    step, points = length / (POINTS - 1), [p]
    for _ in range(POINTS - 1):
        direction = along((1, direction), (0.3, (0, 0, -1)), (0.06, chance()))
        q = tuple(a + step * b for a, b in zip(points[-1], direction))
        density, gradient, _ball = field(*q)
        if density > THRESHOLD * 0.9:  # out of the body
            out = unit(tuple(-g for g in gradient))
            q = tuple(a + 0.6 * step * b for a, b in zip(q, out))
            direction = along((1, direction), (0.7, out))
        q = (q[0], q[1], max(q[2], 0.004))
        points.append(q)
    return points


weights = [r * r if not (0.03 < r < 0.08 and z > 1.52) else 0 for (x, y, z), r in zip(CENTRES, RADII)]  # horns have none
strands = []
while len(strands) < STRANDS:
    found = root(rng.choices(range(len(CENTRES)), weights)[0])
    if not found or found[0][2] < 0.07 or (found[0][0] > 1.33 and found[0][2] < 1.2):  # neither hooves nor the muzzle
        continue
    strands.append(strand(*found))

path = os.path.join(HERE, "data", "highland_cow.etd")
with open(path, "w", encoding="utf-8") as out:
    out.write("# The hair of highland_cow.etd, as make_highland_cow.py wrote it.\n\n")
    names = []
    for part in range(0, STRANDS, 10000):
        names.append("hair_%d" % (part // 10000))
        chosen = strands[part:part + 10000]
        out.write("%s = Curve {\n    basis: catmull_rom, turn: 15 deg, shader: fur, counts: [%d for i in 0..%d]\n" % (names[-1], POINTS, len(chosen)))
        out.write("    radius: [0.0013 * (1.05 - 0.2 * k) for i in 0..%d for k in 0..%d] m\n    points: [\n" % (len(chosen), POINTS))
        for s in chosen:
            out.write("        " + ", ".join("[%.4g, %.4g, %.4g]" % p for p in s) + "\n")
        out.write("    ] m\n}\n")
    out.write("\nhair = [%s]\n" % ", ".join(names))
print("wrote", path)
