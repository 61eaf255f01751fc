"""Small right files of every format that Étendue reads, byte by byte, and what to do with each.

`seeds(program, plugin, folder)` gives a list of Seed. A case puts damaged bytes into a file named `Seed.name`, beside the files
of `Seed.beside`, and runs the program with one of `Seed.commands` in that folder.
"""
import base64
import dataclasses
import pathlib
import struct
import subprocess
import zlib


@dataclasses.dataclass
class Seed:
    format: str
    name: str
    data: bytes
    commands: list
    beside: dict = dataclasses.field(default_factory=dict)
    text: bool = False


def scene(objects, extra=""):
    return (
        f"{extra}Job {{ camera: PerspectiveCamera {{ from: [0, 0, 5], to: [0, 0, 0] }}\n"
        " image: ImageBuffer { width: 4, height: 4 }, renderer: PathTracer { samples: 1, max_depth: 3 }\n"
        f" scene: BruteForceScene {{ objects: [ {objects}, Sphere {{ centre: [0, 3, 3], emission: DiffuseEmission {{}} }} ] }} }}\n"
    ).encode()


RENDER = ["render", "scene.etd", "--quiet", "-o", "out.npy"]
CHECK = ["check", "scene.etd"]


# ---- images ---------------------------------------------------------------------------------------------------------------


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
    row = b"\0" + bytes((37 * i) % 251 for i in range((width * channels * depth + 7) // 8))
    extra = chunk(b"PLTE", bytes(range(48))) if kind == 3 else b""
    extra += chunk(b"tEXt", b"transfer\0srgb")
    header = struct.pack(">2I5B", width, height, depth, kind, 0, 0, interlaced)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + extra + chunk(b"IDAT", zlib.compress(row * height)) + chunk(b"IEND", b"")


def hdr(packed, width=16, height=5):
    text = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=1\n\n-Y %d +X %d\n" % (height, width)
    pixels = b"".join(bytes([100, 2 * i, 50, 128]) for i in range(width))
    if not packed:
        return text + pixels * height
    row = b"\2\2" + struct.pack(">H", width) + b"".join(bytes([128 + width, 40 + k]) for k in range(4))
    return text + row * height


def tga(packed):
    header = struct.pack("<3B2HB4H2B", 0, 0, 10 if packed else 2, 0, 0, 0, 0, 0, 8, 6, 24, 0)
    return header + (bytes([0x87, 10, 20, 30]) * 6 if packed else bytes(i % 256 for i in range(8 * 6 * 3)))


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


def images():
    # EXR files of the damaged kinds that were once found by chance: each made the program ask for gigabytes.
    found = [(f"exr found {p.stem}", "exr", p.read_bytes()) for p in sorted(pathlib.Path(__file__).parent.glob("*.exr"))]
    made = [
        ("exr plain", "exr", exr(0)),
        ("exr zip", "exr", exr(3)),
        ("exr tiled", "exr", exr(3, 8)),
        ("exr channels", "exr", exr(2, None, 5, 3, ("A", "coat.B", "coat.G", "coat.R", "depth.Z"))),
        ("png rgb", "png", png(8, 2)),
        ("png grey 16", "png", png(16, 0)),
        ("png palette", "png", png(4, 3)),
        ("png alpha", "png", png(8, 6)),
        ("hdr plain", "hdr", hdr(False)),
        ("hdr packed", "hdr", hdr(True)),
        ("tga", "tga", tga(False)),
        ("tga packed", "tga", tga(True)),
        ("tiff", "tif", tiff(1)),
        ("tiff zip", "tif", tiff(8)),
        ("jpeg", "jpg", JPEG),
    ]
    for name, ending, data in made + found:
        file = f"input.{ending}"
        texture = scene(f'Sphere {{ shader: Lambertian {{ color: ImageMap {{ file: "{file}" }} }} }}')
        sky = scene(f'Environment {{ emission: EnvironmentEmission {{ file: "{file}" }} }}')
        yield Seed(name, file, data, [["image", "info", file], RENDER], {"scene.etd": texture})
        yield Seed(name + " sky", file, data, [RENDER], {"scene.etd": sky})


def numpy_array(shape, kind="f4"):
    count = 1
    for n in shape:
        count *= n
    text = "{'descr': '<%s', 'fortran_order': False, 'shape': (%s,), }" % (kind, ", ".join(map(str, shape)))
    text += " " * (63 - (10 + len(text)) % 64) + "\n"
    data = struct.pack(f"<{count}{'f' if kind == 'f4' else 'd'}", *((i % 17) / 8 - 1 for i in range(count)))
    return b"\x93NUMPY\1\0" + struct.pack("<H", len(text)) + text.encode() + data


# ---- meshes ---------------------------------------------------------------------------------------------------------------

CORNERS = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0), (0, 0, 1)]
FACES = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4), (0, 1, 2, 3)]


def ply(kind):
    order = ">" if "big" in kind else "<"
    text = f"ply\nformat {kind} 1.0\ncomment made for a test\nelement vertex {len(CORNERS)}\n"
    text += "".join(f"property float {n}\n" for n in ("x", "y", "z", "nx", "ny", "nz", "u", "v"))
    text += "property uchar red\nproperty uchar green\nproperty uchar blue\n"
    text += f"element face {len(FACES)}\nproperty list uchar int vertex_indices\nend_header\n"
    body = b""
    for x, y, z in CORNERS:
        numbers = (x, y, z, 0, 0, 1, (x + 1) / 2, (y + 1) / 2)
        if kind == "ascii":
            body += (" ".join(map(str, numbers)) + " 200 100 50\n").encode()
        else:
            body += struct.pack(order + "8f3B", *numbers, 200, 100, 50)
    for face in FACES:
        if kind == "ascii":
            body += (" ".join(map(str, (len(face), *face))) + "\n").encode()
        else:
            body += struct.pack(f"{order}B{len(face)}i", len(face), *face)
    return text.encode() + body


def obj():
    lines = ["# made for a test"] + ["v %g %g %g" % c for c in CORNERS] + ["vt %g %g" % c[:2] for c in CORNERS] + ["vn 0 0 1"]
    lines += ["f " + " ".join(f"{i + 1}/{i + 1}/1" for i in f) for f in FACES[:3]]
    lines += ["f " + " ".join(str(i + 1) for i in FACES[3]), "f -5// -4// -3//", "f 1 2 \\", " 3 4"]
    return "\n".join(lines).encode() + b"\n"


def meshes():
    for kind in ("ascii", "binary_little_endian", "binary_big_endian"):
        for thing in ("TriangleMesh", "SubdivisionSurface"):
            text = scene(f'{thing} {{ file: "input.ply" }}')
            yield Seed(f"ply {kind} {thing}", "input.ply", ply(kind), [RENDER], {"scene.etd": text}, kind == "ascii")
    for thing in ("TriangleMesh", "SubdivisionSurface"):
        yield Seed(f"obj {thing}", "input.obj", obj(), [RENDER], {"scene.etd": scene(f'{thing} {{ file: "input.obj" }}')}, True)


# ---- measured data --------------------------------------------------------------------------------------------------------


def merl(half=3, difference=2, azimuth=4):
    count = half * difference * azimuth
    return struct.pack("<3i", half, difference, azimuth) + struct.pack(f"<{3 * count}d", *(i % 5 for i in range(3 * count)))


def tensor(fields):
    data = b"tensor_file\0" + bytes([1, 0]) + struct.pack("<I", len(fields))
    kinds = {"B": 1, "f": 10}
    size = len(data) + sum(2 + len(n) + 2 + 1 + 8 + 8 * len(s) for n, _, s, _ in fields)
    body = b""
    for name, kind, shape, values in fields:
        data += struct.pack("<H", len(name)) + name.encode() + struct.pack("<HBQ", len(shape), kinds[kind], size + len(body))
        data += struct.pack(f"<{len(shape)}Q", *shape)
        body += struct.pack(f"<{len(values)}{kind}", *values)
    return data + body


def rgl():
    def ramp(n):
        return [0.5 + (i % 3) / 4 for i in range(n)]

    note = list(b"made for a test")
    return tensor(
        [
            ("description", "B", [len(note)], note),
            ("jacobian", "B", [1], [1]),
            ("phi_i", "f", [1], [0.0]),
            ("theta_i", "f", [2], [0.0, 1.4]),
            ("ndf", "f", [2, 3], ramp(6)),
            ("sigma", "f", [2, 3], ramp(6)),
            ("vndf", "f", [1, 2, 3, 3], ramp(18)),
            ("luminance", "f", [1, 2, 3, 3], ramp(18)),
            ("rgb", "f", [1, 2, 3, 3, 3], ramp(54)),
        ]
    )


IES = (
    b"IESNA:LM-63-2002\n[TEST] made up\nTILT=INCLUDE\n1\n3\n0 45 90\n1.0 0.9 0.8\n1 1000 1.0 5 3 1 2 0.1 0.1 0.0\n1.0 1.0 10.0\n"
    b"0 20 40 60 90\n0 90 180\n900 800 420 80 0\n800 700 300 60 0\n900 800 420 80 0\n"
)
CSV = b"# made up\nwavelength_nm,green,\"red\"\n360,0.1,0.2\n500,0.7,0.1\n640.5,2e-1,+0.9\n830,0.1,0.8\n"
SPD = b"400 0.3\n450 0.5\n500\t0.7\n700 0.1\n"


def tables():
    def shading(shader):
        return {"scene.etd": scene("Sphere { shader: " + shader + " }")}

    for ending, data in (("csv", CSV), ("spd", SPD)):
        file = f"input.{ending}"
        yield Seed(ending, file, data, [RENDER], shading(f'Lambertian {{ color: spectrum("{file}") }}'), True)
    lamp = {"scene.etd": scene('Point { emission: IesEmission { file: "input.ies" } }')}
    yield Seed("ies", "input.ies", IES, [RENDER], lamp, True)
    grid = {"scene.etd": scene('SignedDistanceGrid { file: "input.npy" }')}
    yield Seed("npy grid", "input.npy", numpy_array((4, 5, 6)), [RENDER], grid)
    for kind in ("f4", "f8"):
        yield Seed("npy " + kind, "input.npy", numpy_array((3, 4, 3), kind), [["image", "info", "input.npy"]])
    yield Seed("merl", "input.binary", merl(), [RENDER], shading('MerlShader { file: "input.binary" }'))
    yield Seed("rgl", "input.bsdf", rgl(), [RENDER], shading('RglShader { file: "input.bsdf" }'))


# ---- descriptions, checkpoints, plugins -----------------------------------------------------------------------------------


def descriptions():
    root = pathlib.Path(__file__).resolve().parents[2]
    # Those whose files lie elsewhere are read as far as that, which the messages then name.
    for path in sorted((root / "tests/fuzz/corpus").glob("*.etd")) + [root / "scenes/cornell_box.etd", root / "scenes/csg.etd"]:
        yield Seed("etd " + path.stem, "scene.etd", path.read_bytes(), [CHECK], {}, True)
    included = {"scene.etd": scene("Sphere { radius: r }", 'include "input.etd"\n')}
    yield Seed("etd included", "input.etd", b"r = 1 + 2 * sqrt(0.5)\ns = [1, 2, [3, -4]]\n", [CHECK], included, True)
    yield Seed("etd rendered", "scene.etd", scene("Sphere { shader: Plastic {} }, Box { transform: rotate(30, \"y\") }"), [CHECK], {}, True)


def checkpoints(program, folder):
    text = scene("Sphere {}")
    (folder / "scene.etd").write_bytes(text)
    command = [program, "render", "scene.etd", "--quiet", "--samples", "1", "--checkpoint", "seed.part", "-o", "seed.npy"]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    data = (folder / "seed.part").read_bytes()
    commands = [
        ["image", "merge", "input.part", "-o", "out.npy"],
        ["render", "scene.etd", "--samples", "2", "--quiet", "--resume", "input.part", "-o", "out.npy"],
    ]
    return [Seed("checkpoint", "input.part", data, commands, {"scene.etd": text})]


def seeds(program, plugin, folder):
    found = list(images()) + list(meshes()) + list(tables()) + list(descriptions()) + checkpoints(program, folder)
    if plugin:
        data = pathlib.Path(plugin).read_bytes()
        found.append(Seed("plugin", "libinput.so", data, [["classes", "--plugin", "./libinput.so"]]))
    return found
