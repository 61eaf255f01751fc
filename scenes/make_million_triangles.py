#!/usr/bin/env python3
"""Writes data/million_triangles.ply for million_triangles.etd: a knotted, ribbed tube of 1000 x 500 quads.

A binary PLY with float positions and int indices, two triangles a quad: 500 000 vertices, 1 000 000 triangles. Give
another number of rings to make a larger mesh: 10 000 rings are ten million triangles.
"""
import array
import math
import os
import sys

RINGS = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
SIDES = 500
path = sys.argv[2] if len(sys.argv) > 2 else os.path.join(os.path.dirname(os.path.abspath(__file__)), "data", "million_triangles.ply")


def knot(t):
    """A (2, 3) torus knot."""
    r = math.cos(3 * t) + 2
    return (r * math.cos(2 * t), r * math.sin(2 * t), -math.sin(3 * t))


def subtract(a, b):
    return [x - y for x, y in zip(a, b)]


def unit(a):
    n = math.sqrt(sum(x * x for x in a))
    return [x / n for x in a]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


with open(path, "wb") as out:
    out.write(b"ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\n"
              b"element face %d\nproperty list uchar int vertex_indices\nend_header\n" % (RINGS * SIDES, 2 * RINGS * SIDES))
    for ring in range(RINGS):
        t = 2 * math.pi * ring / RINGS
        centre = knot(t)
        tangent = unit(subtract(knot(t + 1e-4), knot(t - 1e-4)))
        side = unit(cross(tangent, [centre[0], centre[1], 0.3]))
        up = cross(tangent, side)
        row = array.array("f")
        for k in range(SIDES):
            phi = 2 * math.pi * k / SIDES
            radius = 0.42 + 0.05 * math.sin(9 * phi + 40 * t) + 0.008 * math.sin(90 * phi) * math.sin(300 * t)
            c, s = radius * math.cos(phi), radius * math.sin(phi)
            row.extend(centre[i] + c * side[i] + s * up[i] for i in range(3))
        out.write(row.tobytes())
    for ring in range(RINGS):
        a, b = ring * SIDES, (ring + 1) % RINGS * SIDES
        faces = bytearray()
        for k in range(SIDES):
            n = (k + 1) % SIDES
            for triangle in ((a + k, a + n, b + k), (b + k, a + n, b + n)):
                faces.append(3)
                faces += array.array("i", triangle).tobytes()
        out.write(faces)
print("wrote", path)
