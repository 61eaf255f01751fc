#!/usr/bin/env python3
"""Writes data/sky.hdr, a simple sky over dark ground, and data/clouds.hdr, an evening with clouds, for image_lit.etd. Up is +y; the
row at the top is the zenith.

The sky brightens towards the horizon and around the sun, whose disc is far brighter than all else: what an image-lit
scene needs importance sampling for. Radiance is linear sRGB, in arbitrary units. Radiance RGBE; the sky is plain, the clouds in run
lengths.
"""
import math
import os
import random

WIDTH, HEIGHT = 512, 256
SUN = (math.radians(55), math.radians(35))  # azimuth, elevation
SUN_RADIUS = math.radians(1.6)


def radiance(azimuth, elevation):
    if elevation < 0:
        shade = 0.12 + 0.05 * math.exp(elevation * 4)
        return (shade, shade * 0.95, shade * 0.85)
    height = math.sin(elevation)
    haze = math.exp(-4 * height)
    colour = [0.18 + 0.55 * haze, 0.32 + 0.48 * haze, 0.72 + 0.12 * haze]
    cosine = math.sin(SUN[1]) * height + math.cos(SUN[1]) * math.cos(elevation) * math.cos(azimuth - SUN[0])
    angle = math.acos(max(-1.0, min(1.0, cosine)))
    glow = 1.6 * math.exp(-angle * 5)
    colour = [colour[0] + glow, colour[1] + glow * 0.85, colour[2] + glow * 0.6]
    if angle < SUN_RADIUS:
        colour = [1400.0, 1250.0, 1000.0]
    return colour


def rgbe(r, g, b):
    peak = max(r, g, b)
    mantissa, exponent = math.frexp(peak)
    scale = mantissa * 256 / peak
    return bytes((int(r * scale), int(g * scale), int(b * scale), exponent + 128))


path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "data", "sky.hdr")
with open(path, "wb") as out:
    out.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (HEIGHT, WIDTH))
    for row in range(HEIGHT):
        elevation = math.pi / 2 - (row + 0.5) / HEIGHT * math.pi
        out.write(b"".join(rgbe(*radiance((c + 0.5) / WIDTH * 2 * math.pi, elevation)) for c in range(WIDTH)))
print("wrote", path)

# ---- the clouds -------------------------------------------------------------------------------------------------------------

CLOUD_WIDTH, CLOUD_HEIGHT = 1024, 512
EVENING = (math.radians(-52), math.radians(24))
TO_SUN = (math.cos(EVENING[1]) * math.sin(EVENING[0]), math.sin(EVENING[1]), -math.cos(EVENING[1]) * math.cos(EVENING[0]))
rng = random.Random(3)
LATTICE = [rng.random() for _ in range(256 * 256)]


def mix(a, b, t):
    return a + (b - a) * t


def smooth(low, high, x):
    t = max(0.0, min(1.0, (x - low) / (high - low)))
    return t * t * (3 - 2 * t)


def noise(x, y):
    i, j = math.floor(x), math.floor(y)
    fx, fy = x - i, y - j
    fx, fy = fx * fx * (3 - 2 * fx), fy * fy * (3 - 2 * fy)
    row, next_row = (j & 255) * 256, (j + 1 & 255) * 256
    a, b = i & 255, i + 1 & 255
    return mix(mix(LATTICE[row + a], LATTICE[row + b], fx), mix(LATTICE[next_row + a], LATTICE[next_row + b], fx), fy)


def cover(x, y):
    """How dense clouds are over a place of the plane they lie in."""
    wx, wy = x + 0.5 * noise(0.7 * x + 9, 0.7 * y), y + 0.5 * noise(0.7 * x, 0.7 * y + 5)
    total, size = 0.0, 0.5
    for octave in range(6):
        total += size * noise(wx / (2 * size) * 1.1, wy / (2 * size) * 1.1 + 31 * octave)
        size /= 2
    return smooth(0.47, 0.78, total)


def evening(azimuth, elevation):
    if elevation < 0:
        return (0.09, 0.085, 0.08)
    d = (math.cos(elevation) * math.sin(azimuth), math.sin(elevation), -math.cos(elevation) * math.cos(azimuth))
    cosine = sum(a * b for a, b in zip(d, TO_SUN))
    angle = math.acos(max(-1.0, min(1.0, cosine)))
    haze = math.exp(-5 * d[1])
    glow = math.exp(-3.2 * angle)
    clear = [mix(a, b, haze) + glow * c for a, b, c in zip((0.10, 0.22, 0.52), (0.75, 0.66, 0.62), (1.5, 1.0, 0.55))]
    lift = 1 / (d[1] + 0.09)
    x, y = 1.6 * d[0] * lift, 1.6 * d[2] * lift
    dense = cover(x, y) * smooth(0.0, 0.12, d[1])
    if dense > 0:
        # What lies between a place and the sun makes it darker: silver linings, and grey middles.
        shade = math.exp(-2.2 * (0.6 * dense + 0.4 * cover(x + 0.25 * TO_SUN[0], y + 0.25 * TO_SUN[2])))
        light = [(0.25 + 1.1 * shade) * a + 1.6 * glow * shade * b for a, b in zip((0.95, 0.86, 0.80), (1.6, 1.15, 0.75))]
        clear = [mix(a, b, min(1.0, 1.15 * dense)) for a, b in zip(clear, light)]
    if angle < SUN_RADIUS:
        clear = [1500.0, 1150.0, 760.0]
    return clear


def runs(values):
    """One channel of a row in run lengths: 128 + n and a byte that stands n times, or n and as many bytes."""
    out, i = bytearray(), 0
    while i < len(values):
        same = 1
        while i + same < len(values) and same < 127 and values[i + same] == values[i]:
            same += 1
        if same > 2:
            out += bytes((128 + same, values[i]))
            i += same
            continue
        end = i
        while end < len(values) and end - i < 128 and not (end + 2 < len(values) and values[end] == values[end + 1] == values[end + 2]):
            end += 1
        out += bytes((end - i,)) + bytes(values[i:end])
        i = end
    return bytes(out)


path = os.path.join(os.path.dirname(path), "clouds.hdr")
with open(path, "wb") as out:
    out.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (CLOUD_HEIGHT, CLOUD_WIDTH))
    for row in range(CLOUD_HEIGHT):
        elevation = math.pi / 2 - (row + 0.5) / CLOUD_HEIGHT * math.pi
        pixels = [rgbe(*evening((c + 0.5) / CLOUD_WIDTH * 2 * math.pi, elevation)) for c in range(CLOUD_WIDTH)]
        out.write(bytes((2, 2, CLOUD_WIDTH >> 8, CLOUD_WIDTH & 255)) + b"".join(runs([p[k] for p in pixels]) for k in range(4)))
print("wrote", path)
