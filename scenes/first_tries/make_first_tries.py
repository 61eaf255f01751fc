#!/usr/bin/env python3
"""Writes still_life.obj with its .mtl and images, and chess.glb: what programs for modelling export, small.

Room.xml and balls.pbrt beside it are written by hand, and use wood.png.
"""
import json
import math
import os
import random
import struct
import zlib

HERE = os.path.dirname(os.path.abspath(__file__))


def png(width, height, pixel):
    """An image of 8 bits; `pixel(u, v)` gives red, green and blue from 0 to 1, v upwards."""
    rows = b""
    for y in range(height):
        rows += b"\0"
        for x in range(width):
            rows += bytes(max(0, min(255, round(255 * c))) for c in pixel((x + 0.5) / width, 1 - (y + 0.5) / height))

    def piece(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + piece(b"IHDR", header) + piece(b"IDAT", zlib.compress(rows, 9)) + piece(b"IEND", b"")


class Noise:
    """Smooth noise on a square whose opposite sides fit together."""

    def __init__(self, seed, cells):
        generator = random.Random(seed)
        self.cells = cells
        self.values = [[generator.random() for _ in range(cells)] for _ in range(cells)]

    def __call__(self, u, v):
        x, y = u * self.cells, v * self.cells
        i, j = math.floor(x), math.floor(y)
        a, b = (3 * t * t - 2 * t * t * t for t in (x - i, y - j))

        def at(p, q):
            return self.values[q % self.cells][p % self.cells]

        return (at(i, j) * (1 - a) + at(i + 1, j) * a) * (1 - b) + (at(i, j + 1) * (1 - a) + at(i + 1, j + 1) * a) * b


def wood(u, v):
    board = math.floor(4 * v)
    shade = 0.75 + 0.25 * math.sin(7 * board + 2)
    grain = 0.5 + 0.5 * math.sin(60 * v + 5 * WOOD(u + 0.37 * board, 3 * v))
    gap = 0.35 if 4 * v - board < 0.02 else 1
    return [gap * shade * (c + 0.12 * grain) for c in (0.52, 0.31, 0.16)]


WOOD, PEEL = Noise(1, 16), Noise(2, 48)


def glaze(u, v):
    """Blue bands and waves on white, as on a Delft vase."""
    wave = 0.62 + 0.07 * math.sin(2 * math.pi * 8 * u)
    blue = abs(v - wave) < 0.02 or 0.30 < v < 0.34 or 0.78 < v < 0.8 or (0.36 < v < 0.5 and (12 * u + 8 * v) % 1 < 0.25)
    return (0.05, 0.12, 0.45) if blue else (0.9, 0.9, 0.86)


def peel(u, v):
    return [0.5 + 0.5 * PEEL(u, v)] * 3


def lathe(profile, segments, centre=(0, 0, 0), scale=1.0):
    """A profile of (radius, height) turned around the y axis: points, (u, v), quads and triangles of their places."""
    points, uvs, faces = [], [], []
    steps = [0.0]
    for (r0, h0), (r1, h1) in zip(profile, profile[1:]):
        steps.append(steps[-1] + math.hypot(r1 - r0, h1 - h0))
    for (radius, height), step in zip(profile, steps):
        for k in range(segments + 1):
            angle = 2 * math.pi * k / segments
            points.append((centre[0] + scale * radius * math.cos(angle), centre[1] + scale * height, centre[2] - scale * radius * math.sin(angle)))
            uvs.append((k / segments, step / steps[-1]))
    row = segments + 1
    for i in range(len(profile) - 1):
        for k in range(segments):
            a, b, c, d = i * row + k, i * row + k + 1, (i + 1) * row + k + 1, (i + 1) * row + k
            face = [a, b, c, d]
            if profile[i][0] == 0:
                face = [a, c, d]
            elif profile[i + 1][0] == 0:
                face = [a, b, c]
            faces.append(face)
    return points, uvs, faces


def curve(knots, steps):
    """Points of a Catmull-Rom curve through the knots."""
    knots = [knots[0], *knots, knots[-1]]
    result = []
    for p0, p1, p2, p3 in zip(knots, knots[1:], knots[2:], knots[3:]):
        for k in range(steps):
            t = k / steps
            result.append(tuple(0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t + (3 * b - a - 3 * c + d) * t ** 3)
                                for a, b, c, d in zip(p0, p1, p2, p3)))
    result.append(knots[-1])
    return [(max(0.0, r), h) for r, h in result]


def ball(radius, rows=16):
    return [(radius * math.sin(math.pi * k / rows) if 0 < k < rows else 0.0, radius - radius * math.cos(math.pi * k / rows)) for k in range(rows + 1)]


def write_obj():
    vase = curve([(0, 0), (0.55, 0), (0.62, 0.08), (1.0, 0.9), (0.75, 1.9), (0.38, 2.5), (0.5, 2.8), (0.44, 2.8), (0.3, 2.45), (0, 2.3)], 5)
    parts = [("vase", "glaze", lathe(vase, 48)),
             ("table", "wood", ([(-2.4, 0, 2.2), (2.4, 0, 2.2), (2.4, 0, -1.6), (-2.4, 0, -1.6)], [(0, 0), (1, 0), (1, 1), (0, 1)], [[0, 1, 2, 3]]))]
    for i, (x, z) in enumerate(((1.55, 0.5), (0.75, 1.35), (-1.5, 0.8))):
        parts.append((f"orange{i + 1}", "orange", lathe(ball(0.45), 32, (x, 0, z))))
    parts.append(("bead", "glass", lathe(ball(0.3), 32, (-0.55, 0, 1.55))))
    lines, first = ["# A still life, written by make_first_tries.py", "mtllib still_life.mtl"], 1
    for name, material, (points, uvs, faces) in parts:
        lines += [f"o {name}", f"usemtl {material}", "s 1"]
        lines += ["v %.4g %.4g %.4g" % p for p in points] + ["vt %.4g %.4g" % t for t in uvs]
        lines += ["f " + " ".join(f"{first + i}/{first + i}" for i in face) for face in faces]
        first += len(points)
    with open(os.path.join(HERE, "still_life.obj"), "w") as out:
        out.write("\n".join(lines) + "\n")
    with open(os.path.join(HERE, "still_life.mtl"), "w") as out:
        out.write("newmtl glaze\nmap_Kd glaze.png\nKd 1 1 1\nKs 0.5 0.5 0.5\nNs 900\nillum 2\n\nnewmtl wood\nmap_Kd wood.png\nKd 1 1 1\nKs 0.25 0.25 0.25\nNs 60\n"
                  "illum 2\n\nnewmtl orange\nKd 0.8 0.22 0.01\nKs 0.2 0.2 0.2\nNs 50\nmap_Bump -bm 2 peel.png\nillum 2\n\nnewmtl glass\nKd 0 0 0\n"
                  "Ks 1 1 1\nNs 1000\nNi 1.5\nTf 0.7 0.95 0.8\nd 0.2\nillum 7\n")
    for name, width, height, pixel in (("glaze", 256, 128, glaze), ("wood", 256, 256, wood), ("peel", 192, 192, peel)):
        with open(os.path.join(HERE, name + ".png"), "wb") as out:
            out.write(png(width, height, pixel))


# ---- chess pieces ---------------------------------------------------------------------------------------------------------

PAWN = [(0, 0), (0.4, 0), (0.4, 0.12), (0.3, 0.2), (0.16, 0.45), (0.12, 0.75), (0.24, 0.8), (0.12, 0.86), (0.22, 1.0), (0.22, 1.12), (0.12, 1.24), (0, 1.27)]
KING = [(0, 0), (0.48, 0), (0.48, 0.14), (0.34, 0.26), (0.2, 0.6), (0.17, 1.35), (0.32, 1.42), (0.18, 1.5), (0.3, 1.9), (0.26, 1.96), (0.1, 2.04), (0.12, 2.2), (0, 2.24)]
ROOK = [(0, 0), (0.45, 0), (0.45, 0.13), (0.32, 0.24), (0.24, 0.5), (0.22, 1.0), (0.34, 1.08), (0.34, 1.34), (0.25, 1.34), (0.25, 1.22), (0, 1.22)]


def write_glb():
    binary, views, accessors = bytearray(), [], []

    def view(data):
        binary.extend(bytes(-len(binary) % 4))
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
        binary.extend(data)
        return len(views) - 1

    def accessor(rows, letter, component, kind, **more):
        flat = [x for row in rows for x in row]
        accessors.append({"bufferView": view(struct.pack(f"<{len(flat)}{letter}", *flat)), "componentType": component, "type": kind, "count": len(rows), **more})
        return len(accessors) - 1

    def mesh(name, points, uvs, faces, material):
        triangles = [(f[0], f[k], f[k + 1]) for f in faces for k in range(1, len(f) - 1)]
        sums = [[0.0, 0.0, 0.0] for _ in points]
        joined = {}
        for i, p in enumerate(points):  # the seam of a lathe is one edge
            joined.setdefault(tuple(round(x, 5) for x in p), []).append(i)
        for t in triangles:
            a, b, c = (points[i] for i in t)
            u, v = [b[k] - a[k] for k in range(3)], [c[k] - a[k] for k in range(3)]
            n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
            for i in t:
                for k in range(3):
                    sums[i][k] += n[k]
        for same in joined.values():
            total = [sum(sums[i][k] for i in same) for k in range(3)]
            for i in same:
                sums[i] = total
        normals = [[x / (math.sqrt(sum(y * y for y in n)) or 1) for x in n] for n in sums]
        low, high = ([f(p[k] for p in points) for k in range(3)] for f in (min, max))
        attributes = {"POSITION": accessor(points, "f", 5126, "VEC3", min=low, max=high), "NORMAL": accessor(normals, "f", 5126, "VEC3"),
                      "TEXCOORD_0": accessor([(u, 1 - v) for u, v in uvs], "f", 5126, "VEC2")}
        indices = accessor([[i] for t in triangles for i in t], "H", 5123, "SCALAR")
        return {"name": name, "primitives": [{"attributes": attributes, "indices": indices, "material": material}]}

    def checks(u, v):
        light = (math.floor(8 * u) + math.floor(8 * v)) % 2
        return (0.78, 0.7, 0.55) if light else (0.16, 0.09, 0.05)

    image = view(png(128, 128, checks))
    materials = [
        {"name": "board", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0, "roughnessFactor": 0.25}},
        {"name": "ivory", "pbrMetallicRoughness": {"baseColorFactor": [0.85, 0.78, 0.62, 1], "metallicFactor": 0, "roughnessFactor": 0.5},
         "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.05}}},
        {"name": "ebony", "pbrMetallicRoughness": {"baseColorFactor": [0.02, 0.015, 0.012, 1], "metallicFactor": 0, "roughnessFactor": 0.3}},
        {"name": "brass", "pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.68, 0.3, 1], "metallicFactor": 1, "roughnessFactor": 0.2}},
        {"name": "glass", "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
         "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1},
                        "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 0.6, "attenuationColor": [0.5, 0.8, 0.9]}}}]
    square = ([(-4, 0, 4), (4, 0, 4), (4, 0, -4), (-4, 0, -4)], [(0, 0), (1, 0), (1, 1), (0, 1)], [[0, 1, 2, 3]])
    meshes = [mesh("board", *square, 0)]
    nodes = [{"mesh": 0, "name": "board"}]

    def piece(name, profile, material, x, z):
        meshes.append(mesh(name, *lathe(curve(profile, 4), 32), material))
        nodes.append({"mesh": len(meshes) - 1, "name": name, "translation": [x, 0, z]})

    piece("white king", KING, 1, 0.5, -0.5)
    piece("black king", KING, 2, -1.5, -1.5)
    piece("brass rook", ROOK, 3, -0.5, 1.5)
    piece("glass pawn", PAWN, 4, 1.5, 1.5)
    for x, material in ((-2.5, 2), (-1.5, 2), (2.5, 1), (3.5, 1)):
        meshes.append({"name": "pawn", "primitives": [{**meshes[4]["primitives"][0], "material": material}]})
        nodes.append({"mesh": len(meshes) - 1, "name": "pawn", "translation": [x, 0, 0.5 if material == 2 else -1.5]})
    # The camera looks along -z of its node: from (3, 4, 9) to (0, 0.6, 0), as turns about y and then x.
    back = (3.0, 3.4, 9.0)
    around, down = math.atan2(back[0], back[2]), -math.atan2(back[1], math.hypot(back[0], back[2]))
    (s1, c1), (s2, c2) = ((math.sin(a / 2), math.cos(a / 2)) for a in (around, down))
    nodes.append({"name": "eye", "camera": 0, "translation": [3, 4, 9], "rotation": [c1 * s2, s1 * c2, -s1 * s2, c1 * c2]})
    lights = [{"name": "lamp", "type": "point", "color": [1, 0.85, 0.65], "intensity": 120}, {"name": "window", "type": "directional", "color": [0.75, 0.85, 1], "intensity": 1.2}]
    nodes.append({"name": "lamp", "translation": [-4, 6, 3], "extensions": {"KHR_lights_punctual": {"light": 0}}})
    nodes.append({"name": "window", "rotation": [-0.5, 0.3, 0.1, 0.8], "extensions": {"KHR_lights_punctual": {"light": 1}}})
    text = {"asset": {"version": "2.0", "generator": "make_first_tries.py"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}],
            "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_clearcoat", "KHR_materials_transmission", "KHR_materials_volume"],
            "extensions": {"KHR_lights_punctual": {"lights": lights}}, "nodes": nodes, "meshes": meshes, "materials": materials,
            "cameras": [{"type": "perspective", "perspective": {"yfov": 0.42, "aspectRatio": 4 / 3, "znear": 0.1}}],
            "textures": [{"source": 0, "sampler": 0}], "samplers": [{"magFilter": 9728}], "images": [{"bufferView": image, "mimeType": "image/png"}],
            "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(binary) + -len(binary) % 4}]}
    binary.extend(bytes(-len(binary) % 4))
    encoded = json.dumps(text, separators=(",", ":")).encode()
    encoded += b" " * (-len(encoded) % 4)
    with open(os.path.join(HERE, "chess.glb"), "wb") as out:
        out.write(b"glTF" + struct.pack("<III", 2, 28 + len(encoded) + len(binary), len(encoded)) + b"JSON" + encoded
                  + struct.pack("<I", len(binary)) + b"BIN\0" + binary)


if __name__ == "__main__":
    write_obj()
    write_glb()
