#!/usr/bin/env python3
"""One render under each tone map, side by side: docs/pictures/tone_maps.png.

    python3 tools/make_tone_map_sheet.py build/etendue scenes/cornell_box.etd docs/pictures/tone_maps.png

Renders the scene once to radiance and lets `etendue image tonemap` do the rest. Needs nothing but Python.
"""

import os
import struct
import subprocess
import sys
import tempfile
import zlib

WIDTH, HEIGHT, COLUMNS, GAP = 190, 190, 3, 4
TONE_MAPS = [
    "ExposureToneMap {}",
    "NormalizeToneMap {}",
    "ExposureToneMap { exposure: automatic }",
    "ReinhardToneMap {}",
    "ReinhardLocalToneMap {}",
    "WardHistogramToneMap {}",
    "AcesToneMap {}",
    "AgXToneMap { contrast: 2 }",
    "AgXToneMap {}",
]


def read_tga(path):
    """Width, height and rows of R G B, from top to bottom, of an uncompressed picture."""
    with open(path, "rb") as file:
        data = file.read()
    kind, width, height, bits, flags = data[2], *struct.unpack("<HHBB", data[12:18])
    if kind != 2 or bits != 24:
        sys.exit(f"{path}: not what TgaOutput writes")
    rows = [bytearray(data[18 + data[0] + 3 * width * y :][: 3 * width]) for y in range(height)]
    for row in rows:
        row[0::3], row[2::3] = row[2::3], row[0::3]
    return width, height, rows if flags & 0x20 else rows[::-1]


def write_png(path, width, height, rgb):
    def chunk(kind, content):
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    def row(y):  # as differences from the pixel to the left
        line = rgb[3 * width * y : 3 * width * (y + 1)]
        return b"\1" + bytes((v - u) & 255 for u, v in zip(b"\0\0\0" + line, line))

    rows = b"".join(row(y) for y in range(height))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)))
        file.write(chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def main():
    program, scene, out = sys.argv[1:4]
    rows = (len(TONE_MAPS) + COLUMNS - 1) // COLUMNS
    width, height = COLUMNS * (WIDTH + GAP) - GAP, rows * (HEIGHT + GAP) - GAP
    sheet = bytearray(b"\xff" * (3 * width * height))
    with tempfile.TemporaryDirectory() as folder:
        radiance = os.path.join(folder, "radiance.npy")
        subprocess.run([program, "render", scene, "--set", f"image.width={WIDTH}", "--set", f"image.height={HEIGHT}",
                        "--samples", "1000", "--quiet", "-o", radiance], check=True)  # fmt: skip
        for i, tone_map in enumerate(TONE_MAPS):
            shown = os.path.join(folder, f"{i}.tga")
            subprocess.run([program, "image", "tonemap", radiance, shown, "--tone-map", tone_map], check=True)
            for y, row in enumerate(read_tga(shown)[2]):
                at = 3 * (((i // COLUMNS) * (HEIGHT + GAP) + y) * width + (i % COLUMNS) * (WIDTH + GAP))
                sheet[at : at + len(row)] = row
    write_png(out, width, height, bytes(sheet))


if __name__ == "__main__":
    main()
