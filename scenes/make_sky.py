#!/usr/bin/env python3
"""Writes data/sky.hdr: a simple sky over dark ground, for image_lit.etd. Up is +y; the row at the top is the zenith.

The sky brightens towards the horizon and around the sun, whose disc is far brighter than all else: what an image-lit
scene needs importance sampling for. Radiance is linear sRGB, in arbitrary units. Plain Radiance RGBE, no run lengths.
"""
import math
import os

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
