#!/usr/bin/env python3
"""Writes ../data/page.png for magnifying_glass.etd: a page of text in a typeface of 5 x 7 dots, with the Python library alone."""
import os
import struct
import zlib

GLYPHS = {  # seven rows of five dots each, the leftmost dot in the highest bit
    "A": "0E11111F111111", "B": "1E11111E11111E", "C": "0E11101010110E", "D": "1C12111111121C", "E": "1F10101E10101F",
    "F": "1F10101E101010", "G": "0E11101711110F", "H": "1111111F111111", "I": "0E04040404040E", "J": "0702020202120C",
    "K": "11121418141211", "L": "1010101010101F", "M": "111B1515111111", "N": "11111915131111", "O": "0E11111111110E",
    "P": "1E11111E101010", "Q": "0E11111115120D", "R": "1E11111E141211", "S": "0F10100E01011E", "T": "1F040404040404",
    "U": "1111111111110E", "V": "11111111110A04", "W": "11111115151B11", "X": "11110A040A1111", "Y": "1111110A040404",
    "Z": "1F01020408101F", ".": "0000000000000C", ",": "0000000C0C0408", "-": "0000001F000000", " ": "00000000000000",
}
TEXT = """WHAT A LENS GATHERS

LIGHT THAT CROSSES A SURFACE HAS A
PLACE AND A DIRECTION. THE EXTENT OF
BOTH TOGETHER, THE AREA TIMES THE
SOLID ANGLE, IS CALLED ETENDUE. NO
LENS AND NO MIRROR CAN MAKE IT LESS.
WHERE GLASS CONTRACTS A BEAM TO A
BRIGHT SPOT, ITS RAYS MEET THERE AT
WIDER ANGLES, AND THE RADIANCE IN
EACH OF THEM STAYS WHAT IT WAS BEFORE,
BUT FOR THE LITTLE THAT IS REFLECTED.

SO A GLASS SHOWS A PAGE ENLARGED, YET
NEVER BRIGHTER THAN IT IS. A CAUSTIC
IS BRIGHT SINCE IT IS LIT FROM A CONE
AND NOT BECAUSE ANY RAY HAS GAINED.

A PICTURE OF ALL THIS NEEDS NO MORE
THAN MANY PATHS, CHOSEN BY CHANCE, AND
WHAT EACH OF THEM IS WORTH, DIVIDED
BY HOW LIKELY IT WAS. THE MEAN IS THE
LIGHT THAT THERE IS, SOONER OR LATER.
"""
DOT, MARGIN, LEADING, SIDE = 4, 36, 10, 1024  # all in pixels but the leading, which is in dots
PAPER, INK = 236, 26

lines = TEXT.splitlines()
page = [bytearray([PAPER]) * SIDE for _ in range(SIDE)]
for row, line in enumerate(lines):
    for column, letter in enumerate(line):
        for y in range(7):
            bits = int(GLYPHS[letter][2 * y:2 * y + 2], 16)
            for x in range(5):
                if bits >> (4 - x) & 1:
                    left, top = MARGIN + (6 * column + x) * DOT, MARGIN + (LEADING * row + y) * DOT
                    for k in range(top, top + DOT):
                        page[k][left:left + DOT] = bytearray([INK]) * DOT


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "data", "page.png")
with open(path, "wb") as out:
    out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", SIDE, SIDE, 8, 0, 0, 0, 0)) +
              chunk(b"IDAT", zlib.compress(b"".join(b"\0" + bytes(row) for row in page), 9)) + chunk(b"IEND", b""))
print("wrote", os.path.normpath(path))
