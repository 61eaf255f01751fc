"""Small right files of every format that Étendue reads, byte by byte, and what to do with each.

`seeds(program, plugin, folder)` gives a list of Seed. A case puts damaged bytes into a file named `Seed.name`, beside the files
of `Seed.beside`, and runs the program with one of `Seed.commands` in that folder.
"""
import dataclasses
import json
import pathlib
import struct
import subprocess
import tempfile

import seed_images
import seed_models
import seed_scenes
from seed_models import CORNERS, FACES, obj


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


def images():
    # EXR files of the damaged kinds that were once found by chance: each made the program ask for gigabytes.
    found = [(f"exr found {p.stem}", "exr", p.read_bytes()) for p in sorted(pathlib.Path(__file__).parent.glob("*.exr"))]
    for name, ending, data in list(seed_images.small_images()) + found:
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


def ply(kind):
    order = ">" if "big" in kind else "<"
    text = f"ply\nformat {kind} 1.0\ncomment made for a test\nelement vertex {len(CORNERS)}\n"
    text += "".join(f"property float {n}\n" for n in ("x", "y", "z", "nx", "ny", "nz", "u", "v"))
    text += "property uchar red\nproperty uchar green\nproperty uchar blue\n"
    text += f"element face {len(FACES)}\nproperty list uchar int vertex_indices\n"
    text += "property float weight_0\nproperty float weight_1\nend_header\n"
    body = b""
    for x, y, z in CORNERS:
        numbers = (x, y, z, 0, 0, 1, (x + 1) / 2, (y + 1) / 2)
        if kind == "ascii":
            body += (" ".join(map(str, numbers)) + " 200 100 50\n").encode()
        else:
            body += struct.pack(order + "8f3B", *numbers, 200, 100, 50)
    for face in FACES:
        if kind == "ascii":
            body += (" ".join(map(str, (len(face), *face))) + " 0.5 0.25\n").encode()
        else:
            body += struct.pack(f"{order}B{len(face)}i2f", len(face), *face, 0.5, 0.25)
    return text.encode() + body


def meshes():
    for kind in ("ascii", "binary_little_endian", "binary_big_endian"):
        for thing in ("TriangleMesh", "SubdivisionSurface"):
            text = scene(f'{thing} {{ file: "input.ply" }}')
            yield Seed(f"ply {kind} {thing}", "input.ply", ply(kind), [RENDER], {"scene.etd": text}, kind == "ascii")
    for thing in ("TriangleMesh", "SubdivisionSurface"):
        yield Seed(f"obj {thing}", "input.obj", obj(), [RENDER], {"scene.etd": scene(f'{thing} {{ file: "input.obj" }}')}, True)


# ---- models ---------------------------------------------------------------------------------------------------------------

SMALL = ["--quiet", "--set", "image.width=4", "--set", "image.height=4", "--set", "renderer.samples=1", "-o", "out.npy"]


def models(program):
    for name, file, data, text, files in seed_models.models():
        read = "model.obj" if name == "mtl" else file
        yield Seed(name, file, data, [["render", read, *SMALL], ["convert", read, "-o", "-"]], files, text)
    for name, file, data, text, files in seed_models.models_of_libraries():
        if name != "usd" or reads_usd(program, data):
            yield Seed(name, file, data, [["render", file, *SMALL]], files, text)


def reads_usd(program, data):
    """Whether the Python package is there that reads it."""
    with tempfile.NamedTemporaryFile(suffix=".usda") as file:
        file.write(data)
        file.flush()
        return subprocess.run([program, "check", file.name], capture_output=True).returncode == 0


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
LENS = b"# radius thickness index diameter\n60 5 1.5 24\n-60 3 1 24\n0 50 0 16\n"
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
    lens = scene("Sphere { emission: DiffuseEmission {} }").replace(b"PerspectiveCamera {", b'LensCamera { file: "input.dat",')
    yield Seed("lens", "input.dat", LENS, [RENDER], {"scene.etd": lens}, True)
    grid = {"scene.etd": scene('SignedDistanceGrid { file: "input.npy" }')}
    yield Seed("npy grid", "input.npy", numpy_array((4, 5, 6)), [RENDER], grid)
    cloud = {"scene.etd": scene('Sphere { shader: PassThrough {}, interior: GridVolume { file: "input.vol", file_box: true, '
                                'extinction: 1 } }')}
    for channels, encoding in ((1, 1), (3, 1), (1, 3)):
        yield Seed(f"vol {channels} {encoding}", "input.vol", seed_scenes.volume(channels, encoding), [RENDER], cloud)
    smoke = {"scene.etd": scene('Sphere { shader: PassThrough {}, interior: MapVolume { absorption: GridMap { file: "input.nvdb", '
                                'file_box: true } } }')}
    yield Seed("nvdb", "input.nvdb", seed_scenes.nanovdb(), [RENDER], smoke)
    for kind in ("f4", "f8"):
        yield Seed("npy " + kind, "input.npy", numpy_array((3, 4, 3), kind), [["image", "info", "input.npy"]])
    yield Seed("merl", "input.binary", merl(), [RENDER], shading('MerlShader { file: "input.binary" }'))
    yield Seed("rgl", "input.bsdf", rgl(), [RENDER], shading('RglShader { file: "input.bsdf" }'))


# ---- descriptions, checkpoints, plugins -----------------------------------------------------------------------------------


JSON = rb"""{ "$schema": "etendue.schema.json", "$params": { "grey": 0.5 }, "$names": { "red": "rgb(grey, 0.1, 0.1)" },
 "class": "Job", "camera": { "class": "PerspectiveCamera", "from": [0, 0, "5 m"], "to": [0, 0, 0] },
 "image": { "class": "ImageBuffer", "width": 4, "height": 4 }, "renderer": { "class": "PathTracer", "samples": "2 * 2" },
 "scene": { "class": "BruteForceScene", "objects": [
  { "class": "Sphere", "shader": { "class": "Lambertian", "color": "red" }, "transform": "translate(0, \u0031, 0)" },
  { "class": "TriangleMesh", "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]] },
  { "class": "Sphere", "centre": [0, 3, 3], "emission": { "class": "DiffuseEmission", "radiance": [1, 1, 1e0] } } ] } }
"""


def scenes_of_others():
    files = {**seed_scenes.beside(), "brdf.bsdf": rgl()}
    for name, data in seed_scenes.mitsuba_scenes():
        yield Seed(name, "input.xml", data, [["check", "input.xml"]], files, True)
    whole = {"scene.xml": seed_scenes.MITSUBA_INCLUDING}
    yield Seed("mitsuba included", "input.xml", seed_scenes.MITSUBA_FRAGMENT, [["check", "scene.xml"]], whole, True)
    mesh = {"scene.xml": seed_scenes.SERIALIZED_NAMING}
    for version, flags in ((4, 0x1001), (4, 0x200B), (3, 0x1012)):
        data = seed_scenes.serialized_mesh(version, flags)
        yield Seed(f"serialized {version} {flags:x}", "input.serialized", data, [["check", "scene.xml"]], mesh)
    for name, data in seed_scenes.pbrt_scenes():
        yield Seed(name, "input.pbrt", data, [["check", "input.pbrt"]], files, True)
    whole = {"scene.pbrt": seed_scenes.PBRT_INCLUDING}
    yield Seed("pbrt included", "input.pbrt", seed_scenes.PBRT_FRAGMENT, [["check", "scene.pbrt"]], whole, True)


def descriptions():
    root = pathlib.Path(__file__).resolve().parents[2]
    # Those whose files lie elsewhere are read as far as that, which the messages then name.
    for path in sorted((root / "tests/fuzz/corpus").glob("*.etd")) + [root / "scenes/cornell_box.etd", root / "scenes/csg.etd"]:
        yield Seed("etd " + path.stem, "scene.etd", path.read_bytes(), [CHECK], {}, True)
    yield Seed("etd json", "scene.json", JSON, [["check", "scene.json"]], {}, True)
    included = {"scene.etd": scene("Sphere { radius: r }", 'include "input.etd"\n')}
    yield Seed("etd included", "input.etd", b"r = 1 + 2 * sqrt(0.5)\ns = [1, 2, [3, -4]]\n", [CHECK], included, True)
    included = {"scene.etd": scene("Sphere { radius: a.r }, b.s[1]", 'include "input.etd" with { n: 4 } as a\ninclude "input.etd" as b\n')}
    functions = b"param n = 3\nr = f(n)\ns = [Sphere { radius: i + 1 } for i in 0..n if i < 9]\nf(x, y = 2) = if x > 0 then y * f(x - 1) else y\n"
    yield Seed("etd included twice", "input.etd", functions, [CHECK], included, True)
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
    found = (list(images()) + list(meshes()) + list(models(program)) + list(tables()) + list(descriptions()) + list(scenes_of_others()) +
             checkpoints(program, folder))
    if plugin:
        data = pathlib.Path(plugin).read_bytes()
        found.append(Seed("plugin", "libinput.so", data, [["classes", "--plugin", "./libinput.so"]]))
    return found
