"""Small right images of every format that is read, byte by byte.

`small_images()` gives (what it is, ending, bytes).
"""
import base64
import struct
import zlib


def exr(compression, tiles=None, width=12, height=20, channels=("B", "G", "R")):
    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value

    listed = b"".join(c.encode() + b"\0" + struct.pack("<iB3xii", 1, 0, 1, 1) for c in channels) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = struct.pack("<II", 20000630, 2 | (0x200 if tiles else 0))
    header += attribute("channels", "chlist", listed)
    header += attribute("compression", "compression", bytes([compression]))
    header += attribute("dataWindow", "box2i", window) + attribute("displayWindow", "box2i", window)
    header += attribute("lineOrder", "lineOrder", b"\0")
    header += attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    header += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
    header += attribute("screenWindowWidth", "float", struct.pack("<f", 1))
    if tiles:
        header += attribute("tiles", "tiledesc", struct.pack("<2IB", tiles, tiles, 0))
    header += b"\0"

    def rows(x0, x1, y0, y1):
        return b"".join(
            struct.pack("<e", (x + y + k) / 32) for y in range(y0, y1) for k in range(len(channels)) for x in range(x0, x1)
        )

    def packed(raw):
        if compression == 0:
            return raw
        even, odd = raw[::2], raw[1::2]  # ZIP: bytes of one place together, then differences
        mixed = bytearray(even + odd)
        for i in range(len(mixed) - 1, 0, -1):
            mixed[i] = (mixed[i] - mixed[i - 1] + 128) % 256
        small = zlib.compress(bytes(mixed))
        return small if len(small) < len(raw) else raw

    chunks = []
    if tiles:
        for ty in range(0, height, tiles):
            for tx in range(0, width, tiles):
                data = packed(rows(tx, min(tx + tiles, width), ty, min(ty + tiles, height)))
                chunks.append(struct.pack("<5i", tx // tiles, ty // tiles, 0, 0, len(data)) + data)
    else:
        step = 16 if compression == 3 else 1
        for y in range(0, height, step):
            data = packed(rows(0, width, y, min(y + step, height)))
            chunks.append(struct.pack("<2i", y, len(data)) + data)
    at, table = len(header) + 8 * len(chunks), b""
    for chunk in chunks:
        table += struct.pack("<Q", at)
        at += len(chunk)
    return header + table + b"".join(chunks)


def png(depth, kind, width=9, height=7, interlaced=0):
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    channels = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[kind]

    def rows(width, height):
        return (b"\0" + bytes((37 * i) % 251 for i in range((width * channels * depth + 7) // 8))) * height

    pixels = rows(width, height)
    if interlaced:  # seven passes: from x and y on, every so many
        passes = [(0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2)]
        pixels = b"".join(rows(-(-(width - x) // dx), -(-(height - y) // dy)) for x, y, dx, dy in passes if x < width and y < height)
    extra = chunk(b"PLTE", bytes(range(48))) if kind == 3 else b""
    extra += chunk(b"tEXt", b"transfer\0srgb")
    header = struct.pack(">2I5B", width, height, depth, kind, 0, 0, interlaced)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + extra + chunk(b"IDAT", zlib.compress(pixels)) + chunk(b"IEND", b"")


def hdr(packed, width=16, height=5):
    text = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=1\n\n-Y %d +X %d\n" % (height, width)
    pixels = b"".join(bytes([100, 2 * i, 50, 128]) for i in range(width))
    if not packed:
        return text + pixels * height
    row = b"\2\2" + struct.pack(">H", width) + b"".join(bytes([128 + width, 40 + k]) for k in range(4))
    return text + row * height


def tga(packed=False, palette=False):
    """The palette has 16 colours; behind the pixels lie an area of texts, with a preview of 2 x 2 pixels, and the footer."""
    kind = (9 if packed else 1) if palette else (10 if packed else 2)
    size = 1 if palette else 3
    header = struct.pack("<3B2HB4H2B", 4, palette, kind, 0, 16 * palette, 24 * palette, 0, 0, 8, 6, 8 * size, 0) + b"made"
    data = header + (bytes(range(48)) if palette else b"")
    data += bytes([0x87, 10, 11, 12][: 1 + size]) * 6 if packed else bytes(i % (16 if palette else 256) for i in range(8 * 6 * size))
    if not palette:
        return data
    area = struct.pack("<H41s324s12H", 495, b"who", b"what", *[1] * 12) + bytes(495 - 2 - 41 - 324 - 24)
    preview = len(data) + len(area)
    area = area[:486] + struct.pack("<I", preview) + area[490:]  # where the preview is
    return data + area + bytes([2, 2]) + bytes(range(12)) + struct.pack("<2I", len(data), 0) + b"TRUEVISION-XFILE.\0"


def bmp(bits, packed=False, width=7, height=5):
    """Of 24 bits, or of 8 or 4 with a palette; `packed`: in runs of equal pixels."""
    palette = b"" if bits == 24 else bytes(i % 256 for i in range(4 << bits))
    row = (width * bits + 31) // 32 * 4
    data = bytes((5 * i) % 256 for i in range(row * height))
    if packed:
        data = b"\0\0".join([bytes([width, 3])] * height) + b"\0\1"
    start = 14 + 40 + len(palette)
    header = struct.pack("<2sIHHI", b"BM", start + len(data), 0, 0, start)
    return header + struct.pack("<IiiHHIIiiII", 40, width, height, 1, bits, packed, len(data), 2835, 2835, 0, 0) + palette + data


def tiff(compression, width=10, height=8):
    pixels = bytes((7 * i) % 256 for i in range(width * height * 3))
    data = zlib.compress(pixels) if compression == 8 else pixels
    entries = [(256, 4, 1, width), (257, 4, 1, height), (258, 3, 3, 0), (259, 3, 1, compression), (262, 3, 1, 2)]
    entries += [(273, 4, 1, 0), (277, 3, 1, 3), (278, 4, 1, height), (279, 4, 1, len(data))]
    start = 8 + 2 + 12 * len(entries) + 4
    values = {258: start, 273: start + 6}
    table = b"".join(struct.pack("<2H2I", t, k, n, values.get(t, v)) for t, k, n, v in entries)
    return b"II*\0" + struct.pack("<IH", 8, len(entries)) + table + struct.pack("<I3H", 0, 8, 8, 8) + data


JPEG = base64.b64decode(
    "/9j/4AAQSkZJRgABAQAAAQABAAD/2wBDABsSFBcUERsXFhceHBsgKEIrKCUlKFE6PTBCYFVlZF9VXVtqeJmBanGQc1tdhbWGkJ6jq62rZ4C8ybqmx5moq6T/2wBD"
    "ARweHigjKE4rK06kbl1upKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKT/wAARCAAIABADASIAAhEBAxEB/8QAFQABAQAA"
    "AAAAAAAAAAAAAAAAAAT/xAAXEAEAAwAAAAAAAAAAAAAAAAAAAwVi/8QAFQEBAQAAAAAAAAAAAAAAAAAAAwT/xAAaEQEAAQUAAAAAAAAAAAAAAAACAAEDBDFR"
    "/9oADAMBAAIRAxEAPwCKGtyuhq8glCqtw8a++z//2Q=="
)


def pnm(kind, width=6, height=5):
    """P1 to P6, PF and Pf: bits, greys and colours, as text and as bytes; and floats."""
    count = width * height * (3 if kind in ("P3", "P6", "PF") else 1)
    if kind in ("PF", "Pf"):
        return f"{kind}\n{width} {height}\n-1.0\n".encode() + struct.pack(f"<{count}f", *(i / 64 for i in range(count)))
    header = f"{kind}\n# made for a test\n{width} {height}\n" + ("" if kind in ("P1", "P4") else "255\n")
    if kind in ("P1", "P2", "P3"):
        return header.encode() + " ".join(str(i % (2 if kind == "P1" else 256)) for i in range(count)).encode() + b"\n"
    return header.encode() + bytes(i % 256 for i in range(height if kind == "P4" else count))


# What OpenImageIO 2.4 wrote of a pattern, for what takes more than some lines to write.
PACKED = {
    "exr piz": (
        "eNrtj81OwzAMx91pByQuSLwAb8AaiVHlgviQOCLtsnNInNVSSKIkGuPGkZfbO5G2Q+0YX71jy4n1s/1PvD4viwkASOHvREKIKZBdwWlGbMbmvCw5Y2fN"
        "WfGLmayFtWgiyNpQTHCZ226ggM6KXdwfkMUBAemefMAYydm9vClOlUhiSVa5Z3h0G0ZwAr0d5zjKoSh6I15+7TNk8SEoDIOs/YKnDZrr6FGmhUjkQBsn"
        "Ekzb6derKAOi7eRv0aY8tma6lfywYcuSVKo/ScCq6JvfJt2tWfZ549tqW2mu+YCzId+r7Hg/8TUdqz/21e/0/7cav1Wv8lf9H+go/XejJgBf"
    ),
    "exr pxr24": (
        "eNor0zdkZGJgYEhOLHBJLEllKC4pysxLZxAGChkZGJlZGRpaGRkpgEgLK1OD5IzEvLzUnGKG5IyczOISBnOgMicGkH4QYIRidwyRIAwRhuT83IKi1OLi"
        "zPw8FDZIkjUlsSQxPDMvJb+cISm/wiiTQYABAbiBmAOIUzKLC3ISKwmqy8nMS/UvSkktQmKBnVCQWZGa41hckJpcEpRYkpnPkJaTn1jCwALW3WBfnFyU"
        "mpoHMd45Na8EqK3MKA1sJAwgKwnPTCnJQDOCIZ0RSTEQV8x5euEgb4MCD+uF/cHvfQ4EvLvCGrHA2lPbc/ULxzdn5Tgap/+Zz8SaLBWw8aVjgsMX319z"
        "H7D9ujtRimVxsVuWzMnC/WmSDx0yzLpr52xxsJgwe81Ru/da9a8n7z903M4+IpFzCZtSZO0zHWXl0x0pX28y5vC3rgAAck6CUw=="
    ),
    "exr b44a": (
        "eNor0zdkZGJgYEhOLHBJLEllKC4pysxLZxAGChkZGJlZGRpaGRkpgEgLK1OD5IzEvLzUnGKG5IyczOISBnOgMicGRgYIYIRidwyRIAwRhuT83IKi1OLi"
        "zPw8FDZIkj0lsSQxPDMvJb+cISm/wiiTQYABAbiBmAOIUzKLC3ISKwmqy8nMS/UvSkktQmKBnVCQWZGa41hckJpcEpRYkpnPkJaTn1jCwALW3WBfnFyU"
        "mpoHMd45Na8EqK3MKA1sJAwgKwnPTCnJQDOCIZ0RobgKyG5IU+NQaOKrfD5DoYlDaVuuGJDHodBs8/kch8IOoFxCmwRQgJnH4EFDmvoMhWcg6UVdGgrb"
        "0sQ4jM/bPAAqbrqduwtsCsNhHgugtOWmNCmwKYd5DIDkjmNCYN7rdbuAJFglj8FhIPP5vEqI7RyWz+clAAU2+UpzKBwCCnCtWrUCbLtimwRIosHgMFAl"
        "XwLEkV0aC0C2Qx3ZxA21HexIkClYbYc4AKvtCs3zKp+BbJfiUTgMEtBatWrBDrCcRGIb2F8glVBHNmksAtvexPP5PMi3ulDbQY7kQ7cdrPK8zWcQExpK"
        "ENuBCABXBsgy"
    ),
    "exr dwaa": (
        "eNrtT81OwzAMdicOSFyQeAHegDWCUeWC2JC4ICHtsnNIHBopJFUSdePGER5u70TaDqVl/PWOLSfW58+f7foszyYAwFl1wwKCD06ZRziJEJmSGc1zSshp"
        "8xb0YspLZgxqD7zUyge4jLQ5ZNBZtovbPWS5hwC3T5VD75U1g7wpHgoW2EoZYdfwYDdEwTEkO2oYMYTylWbPv/PWbJEG3GGNGqS2LMBByzufa2Xw3gl0"
        "kLJ2yUptUF/7CnlYsqDsoO/lynOHaLoFFmhCbKuJbId+WJ+yUiKUnyTgLUvk10n3SxJ91vi22BaSStrDSR8fVHZ46vgaHas/dup3+v9Xjb8qqfxV/wd0"
        "lP47BGEK2w=="
    ),
    "exr parts": (
        "eNrtUc1Kw0AQnhgFL0JFvPsE2ixEJRd/KngUeylehOlm2wwms0t2W9ObPoDv4Gv4Jj6Om6bU1KIevTjwLcM3H9837EyPomCjAyDRXKFTYF1JPIY9ABBd"
        "cZxEUSLEQf2eJnFXZsiscgsyy8k6OPGySwigqWCB6zWmv8Z4hwk/9PSEHZDH5oKXujClspY0r/T1LEzR4YA41Y8w1JUg6MBnbXnULilZk+PsV11OrG7K"
        "VJWtbr4ZY7H8h5pAQ5XKL6xR0vXRkYZRrrFZGeDpzMpSKW7yeoqd95mKEWy3MtuSAaUu+2LhZmYZuTPXI9dbUYFj9X+b728z/OvbwG3Y2HAIK7XrUd3L"
        "7HX//fnwPAZ4ie/egp+GH2veyVM="
    ),
    "tif lzw tiles": (
        "eNrz9NRi4GBgYBBgYGBkZmAEskSAmBHKFgJiJiCbBUifA2JmqDgrELNB2UwgdVA2CItC2SA9MkjiRoxMYLO/AbEtkl4nKBvoAgZnJLYLIwvYjHtA7Ap1"
        "wzUgDkIyMxgq/o4BAgSgUJ1RmFGdUZORC6jIEGiJCzMDQzYLSA8EGhkYmVkZGloZGSmASAsrUwOGBgaFAAsVgXT2FscHCzh81MR5W5wfMVtEXEgX63FV"
        "2GhxRUpdqMNDeeKPO5NsFZuOJRtplEwLVG87rWQ0Y881nTRjtfTgHSG7kk2muicUnpzyLVF38ZkHUyS2irUypYVkhUqIGs3nmRzw2kBL5ddE5tXBa0Jf"
        "iZZNdlvr/db4V8yt7OTNV99c2/Xn0duyHXd0xF7lTroYs/aabgSPBNNhu7nnXlnE2D77W3TgzqvtZ9rEVbmP39sw7fRSre+OZxM2z9z1b5L70otZRj/u"
        "vP0fPO9y9tZKz2NqpZsOvDazjJXbX9hzKiOr1GZes/Hx40XF397yxV09d+JLhUxe2PvZkbvv/tr9at/rnddP51VY9G7Tr773oqI2rl4+X3/Gtfemsfrp"
        "wY8f3Hv5136++O01T+w+MHdtV1BoMAYGkwATD4MUz0ODjXPk+Iw7XBLOXEsJ0uTrcUsOSP/9z4ix90RKkKVKn7J62zFVQQ2rTGO9GWopmy2XXMtVNfZL"
        "D55xZp2ibcfMM1c0Uu71ui/xmGyyK1WvVrPdWWPLrKVha9mbjimacMYy6Yqmea/6Zq2SNZ9t86nlV7RTec569h1/dvF2j5yjwia/l5uqniwyDmoN0dlh"
        "tUeIM/DAlYdXL7DW6becSHhrsfOLVbLhLvd1B7iPudtKzz33fvvpEKfbXeeP6014vW8Jo+/ep9kRc/h255qcuZtt0SuzWbNvw5ltfyzuLlfnn+/3dtc9"
        "dRPGqmWZRjPOuDG3l17L/XDBbt3lauENyT8vrjuWl7/z6sv8e+smMOvrP6z4uUGgQbLn5AwVkTRjBqfEgIoUI1EuKZ5HhhYuNoy8bUcXfeywybKU7XZ/"
        "tOHHkiBb+V5j1aCdIWreQhMPPRWSnGPnqt7ntvSj5JGkaslZzgkhVjL/ZB0lgWGz0iRrrv8KYMqxWurFHe5z9tHlnb1he+M3RGRtunW3zNxylnHktNVB"
        "mcZJO2LyQjJZs3Lll8ZlpmVP/vtfiuGG/vUXdezMxd2BWl+49y7yNFj2yCjSasqmyP7pFxeanY421px/ISTvsk4B093lPrc3lP8Ik3Zev/6ixnRvE7Ov"
        "E2+4bq0IYJMv5lzjuGwjT8vh+uM7Xn1o4Fazz1Q/F537p29p2NbFLSdWTF9bHr7X72jBEombX6cb33v63mpnZlxy9yyGkuK7v6Yvj056mvDzS0/a7KD/"
        "a88vYekGphzJBaCUw8sueSgxYIaNkki6sQtbs8UcM3HutoOLPqw4wWTO03P8WOGNOdM0lSccf7xyZsq2SKVJnk8urtjDZS47wyvt40yTc6Xic7yWf5ih"
        "ItRs3e38SC3zSxksmNxi9eYcTt9UtbYMFEzAOOmVa9RM26xrNuVS2uH8HTE5Fzu+ck2W7ojLLBf//c+Kcf39/A132JieSjaFKU+xic1KjTn8pCjUWi5c"
        "u2/tnadiu0MnqwODSdvglQPTbWAwFYS/sBMHBlNgQuVK1jvpVcveKFvtUWDm3dUc+nSXhWme9oEn0V8rDFj7TvfcOrx52uly9bWhcz7qbdyh+jr2+ofg"
        "jTY2eZPOzzj+o3L2vX3Rui/unNWba/O9bfHrazcqK3SXLM7ZpXDWOeC3Q8cpJgDzIzsG"
    ),
    "webp": (
        "eNoB5AEb/lJJRkbcAQAAV0VCUFZQOCDQAQAAUAwAnQEqEAAQAAAAACUATolwDfJeAA/VXrAP0v/uXuAfwX+RXID6ZulZ9QP2Ay1TyL8T9EB/Efwl/JXM"
        "AfwD8EP1V/s3AAexf+DuuA/t38A/DPeAP4R/DP4x+Ln9o5AD9Ezzr9kRCFyCooAA/v/+mWuxf4lT988lsuu18fdi9skd/597PHmNcwbELm5FrWAK4wxN"
        "oyMZpCzNsGIf+J1s65UmexUKkjJ0UTXcNxw4PiNJjp//olixq4G0oYGztjMFAkVN/3DB+lRTkVBuf9g8t4q4hR+t51hlkUnCEJR9tX9xGL4JtvbZ259u"
        "QjZ7pw1rJ8/fZP/3iGtLhCrL//pvBl9Dh3Zwt/8UQdy0ThDVx1/lNFGoXzjPgh422hiXLc9RD/SdFpDcK5Jtf/+cWR4/d3eq+GuK1hSvKBXYOR+VoLX+"
        "4XFdeDY+6lmiZPGmH2YuwkL6c+uW20IUsE/CO+af//PXu+Or1HA9DTdCV0rMAm8MDn+ZmExayo5gRl+d29+8ZGSPMV/pLX9cn06fjTH8D61Ysd/+Epzm"
        "XNKm6xP+H2iVjLB/4apNzA13uo/1GxHqQfM9c9bz0f5nfCf0K65E5fAEL8zFuYp/4odCGOVoAAC1qO1a"
    ),
}


def small_images():
    yield "exr plain", "exr", exr(0)
    yield "exr zip", "exr", exr(3)
    yield "exr tiled", "exr", exr(3, 8)
    yield "exr channels", "exr", exr(2, None, 5, 3, ("A", "coat.B", "coat.G", "coat.R", "depth.Z"))
    yield "png rgb", "png", png(8, 2)
    yield "png grey 16", "png", png(16, 0)
    yield "png palette", "png", png(4, 3)
    yield "png alpha", "png", png(8, 6)
    yield "png interlaced", "png", png(8, 2, interlaced=1)
    yield "hdr plain", "hdr", hdr(False)
    yield "hdr packed", "hdr", hdr(True)
    for packed in (False, True):
        for palette in (False, True):
            yield "tga" + " packed" * packed + " palette" * palette, "tga", tga(packed, palette)
    for bits in (24, 8, 4):
        yield f"bmp {bits}", "bmp", bmp(bits)
    yield "bmp packed", "bmp", bmp(8, True)
    yield "tiff", "tif", tiff(1)
    yield "tiff zip", "tif", tiff(8)
    yield "jpeg", "jpg", JPEG
    for kind in ("P1", "P2", "P3", "P4", "P5", "P6", "PF", "Pf"):
        yield "pnm " + kind, "pfm" if "f" in kind.lower() else "ppm", pnm(kind)
    for name, text in PACKED.items():
        yield name, name.split()[0], zlib.decompress(base64.b64decode(text))
