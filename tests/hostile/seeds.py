"""Small right files of every format that Étendue reads, byte by byte, and what to do with each.

`seeds(program, plugin, folder)` gives a list of Seed. A case puts damaged bytes into a file named `Seed.name`, beside the files
of `Seed.beside`, and runs the program with one of `Seed.commands` in that folder.
"""
import dataclasses
import json
import pathlib
import struct
import subprocess
import zlib

import seed_images


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

CORNERS = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0), (0, 0, 1)]
FACES = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4), (0, 1, 2, 3)]


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


# ---- models ---------------------------------------------------------------------------------------------------------------

SMALL = ["--quiet", "--set", "image.width=4", "--set", "image.height=4", "--set", "renderer.samples=1", "-o", "out.npy"]


def gltf_json(uri=None):
    positions = struct.pack("<15f", *(x for c in CORNERS for x in c))
    indices = struct.pack("<12H", *(i for f in FACES[:4] for i in f))
    times = struct.pack("<2f", 0, 1)
    moved = struct.pack("<6f", 0, 0, 0, 1, 0, 0)
    pieces = [positions, indices, times, moved]
    views, offset = [], 0
    for piece in pieces:
        views.append({"buffer": 0, "byteOffset": offset, "byteLength": len(piece)})
        offset += len(piece)
    text = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 2]}],
        "nodes": [{"children": [1], "scale": [1, 2, 1]}, {"mesh": 0, "translation": [0, 1, 0]}, {"camera": 0, "translation": [0, 0, 5]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "aspectRatio": 1.0, "znear": 0.1}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.2, 0.7], "baseColorTexture": {"index": 0}},
                       "alphaMode": "MASK", "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1}}}],
        "textures": [{"source": 0, "sampler": 0}], "samplers": [{"wrapS": 33071}],
        "images": [{"uri": "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="}],
        "animations": [{"samplers": [{"input": 2, "output": 3}], "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 5},
                      {"bufferView": 1, "componentType": 5123, "type": "SCALAR", "count": 12},
                      {"bufferView": 2, "componentType": 5126, "type": "SCALAR", "count": 2},
                      {"bufferView": 3, "componentType": 5126, "type": "VEC3", "count": 2}],
        "bufferViews": views, "buffers": [{"byteLength": offset, **({"uri": uri} if uri else {})}],
    }
    return json.dumps(text).encode(), b"".join(pieces)


def glb():
    text, binary = gltf_json()
    text += b" " * (-len(text) % 4)
    binary += bytes(-len(binary) % 4)
    return (b"glTF" + struct.pack("<III", 2, 28 + len(text) + len(binary), len(text)) + b"JSON" + text
            + struct.pack("<I", len(binary)) + b"BIN\0" + binary)


def stl_binary():
    data = b"made for a test".ljust(80) + struct.pack("<I", 4)
    for face in FACES[:4]:
        data += struct.pack("<12fH", 0, 0, 1, *(x for i in face for x in CORNERS[i]), 0)
    return data


def stl_text():
    lines = ["solid test"]
    for face in FACES[:4]:
        lines += ["facet normal 0 0 1", "outer loop", *("vertex %g %g %g" % CORNERS[i] for i in face), "endloop", "endfacet"]
    return "\n".join(lines + ["endsolid"]).encode()


OFF = ("OFF\n5 5 0\n" + "".join("%g %g %g\n" % c for c in CORNERS) + "".join(f"{len(f)} {' '.join(map(str, f))}\n" for f in FACES)).encode()
MTL = (b"newmtl a\nKd 0.5 0.2 0.1\nKs 0.5 0.5 0.5\nNs 50\nillum 2\nmap_Kd -s 2 2 -o 0.5 0 -clamp on none.png\nnewmtl b\nPr 0.2\nPm 1\n"
       b"d 0.5\nKe 1 1 1\nTf 1 1 1\nNi 1.5\nbump -bm 0.2 none.png\n")


def models():
    text, binary = gltf_json("input.bin")
    yield Seed("glb", "input.glb", glb(), [["render", "input.glb", *SMALL], ["convert", "input.glb", "-o", "-"]])
    yield Seed("gltf", "input.gltf", text, [["render", "input.gltf", *SMALL]], {"input.bin": binary}, True)
    yield Seed("obj model", "input.obj", b"mtllib input.mtl\n" + obj() + b"usemtl a\nf 1 2 3\ns 1\nusemtl b\nf 1 3 4\n",
               [["render", "input.obj", *SMALL]], {"input.mtl": MTL}, True)
    yield Seed("mtl", "input.mtl", MTL, [["render", "model.obj", *SMALL]],
               {"model.obj": b"mtllib input.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\n"}, True)
    yield Seed("stl binary", "input.stl", stl_binary(), [["render", "input.stl", *SMALL]])
    yield Seed("stl text", "input.stl", stl_text(), [["render", "input.stl", *SMALL]], {}, True)
    yield Seed("off", "input.off", OFF, [["render", "input.off", *SMALL]], {}, True)


# ---- measured data --------------------------------------------------------------------------------------------------------


def volume(channels):
    """A cloud of 3 x 2 x 2 cells in Mitsuba's format."""
    return b"VOL\3" + struct.pack(f"<5i6f{12 * channels}f", 1, 3, 2, 2, channels, -1, -1, -1, 1, 1, 1,
                                  *((i % 5) / 4 for i in range(12 * channels)))


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
    cloud = {"scene.etd": scene('Sphere { shader: PassThrough {}, interior: GridVolume { file: "input.vol", file_box: true, '
                                'extinction: 1 } }')}
    for channels in (1, 3):
        yield Seed(f"vol {channels}", "input.vol", volume(channels), [RENDER], cloud)
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


PBRT = b"""LookAt 0 0 -5 0 0 0 0 1 0
Camera "perspective" "float fov" [ 40 ] "float shutteropen" 0
Sampler "halton" "integer pixelsamples" 1
Integrator "volpath" "integer maxdepth" 3
Film "rgb" "integer xresolution" 4 "integer yresolution" [ 4 ] "string filename" "out.exr"
TransformTimes 0 1
WorldBegin # a comment
LightSource "infinite" "blackbody L" 5000 "float scale" .5
Texture "checks" "spectrum" "checkerboard" "float uscale" 4 "rgb tex1" [ .1 .2 .3 ] "spectrum tex2" [ 400 .1 700 .9 ]
MakeNamedMaterial "matt" "string type" "diffuse" "texture reflectance" "checks"
MakeNamedMaterial "both" "string type" "mix" "string materials" [ "matt" "matt" ] "float amount" .25
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ 1 2 3 ] "float scale" 0.1
AttributeBegin
  ActiveTransform EndTime Translate 1 0 0 ActiveTransform All
  Rotate 30 0 1 0 Scale 1 2 -1 ConcatTransform [ 1 0 0 0 0 1 0 0 0 0 1 0 1 1 1 1 ]
  AreaLightSource "diffuse" "spectrum L" "stdillum-A" "bool twosided" true
  Shape "trianglemesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 1 1 0 ] "integer indices" [ 0 1 2 1 3 2 ] "normal N" [ 0 0 1 0 0 1 0 0 1 0 0 1 ]
AttributeEnd
Attribute "shape" "float radius" 2
ObjectBegin "thing" NamedMaterial "both" MediumInterface "fog" "" Shape "sphere" Shape "disk" "float phimax" 90 ObjectEnd
CoordinateSystem "here" CoordSysTransform "camera" ObjectInstance "thing" ReverseOrientation
Material "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k" "float roughness" .1
Shape "curve" "point3 P" [ 0 0 0 1 0 0 1 1 0 0 1 1 ] "float width0" .1 "float width1" .2
Shape "loopsubdiv" "integer levels" 1 "point3 P" [ 0 0 0 1 0 0 0 1 0 0 0 1 ] "integer indices" [ 0 2 1 0 1 3 1 2 3 0 3 2 ]
"""
PBRT_V3 = b"""Film "image" "integer xresolution" 2 "integer yresolution" 2 Camera "orthographic" WorldBegin
LightSource "spot" "rgb I" [ 1 1 1 ] "point from" [ 0 1 0 ] "rgb scale" [ 2 2 2 ] LightSource "distant" "color L" [ 1 0 1 ]
Material "uber" "rgb Kd" [ .1 .2 .3 ] "float opacity" .5 Shape "cylinder" Material "glass" "float index" 1.3 Shape "cone"
Material "substrate" "float uroughness" .2 Shape "heightfield" "integer nu" 2 "integer nv" 2 "float Pz" [ 0 1 2 3 ]
Material "translucent" Shape "hyperboloid" "point p1" [ 1 0 0 ] "point p2" [ .5 1 1 ] Material "disney" Shape "paraboloid" WorldEnd
"""


MITSUBA = b"""<?xml version="1.0" encoding="utf-8"?>
<scene version="3.0.0">
  <default name="spp" value="4"/> <default name="kind" value="path"/>
  <integrator type="$kind"><integer name="max_depth" value="5"/></integrator>
  <sensor type="thinlens"><float name="fov" value="40"/><string name="fov_axis" value="smaller"/>
    <float name="aperture_radius" value="0.1"/><float name="focus_distance" value="3"/>
    <transform name="to_world"><lookat origin="0, 1, 5" target="0 0 0" up="0 1 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="6"/><rfilter type="mitchell"/></film>
    <sampler type="multijitter"><integer name="sample_count" value="$spp"/></sampler></sensor>
  <bsdf type="twosided" id="paint"><bsdf type="diffuse"><texture type="checkerboard" name="reflectance">
    <rgb name="color0" value="0.1 0.2 0.3"/><spectrum name="color1" value="400:0.1, 500:0.8, 700:0.4"/>
    <transform name="to_uv"><scale x="3" y="4"/><rotate z="1" angle="30"/></transform></texture></bsdf></bsdf>
  <alias id="paint" as="colour"/>
  <medium type="homogeneous" id="fog"><rgb name="sigma_t" value="#102030"/><phase type="hg"><float name="g" value="0.3"/></phase></medium>
  <shape type="shapegroup" id="group"><shape type="sphere"><point name="center" x="1"/><ref id="colour"/></shape>
    <shape type="cube"><bsdf type="roughplastic"><string name="distribution" value="ggx"/></bsdf></shape></shape>
  <shape type="instance"><ref id="group"/><transform name="to_world"><matrix value="1 0 0 0 0 2 0 1 0 0 1 0 0 0 0 1"/></transform></shape>
  <shape type="rectangle"><bsdf type="mask"><float name="opacity" value="0.5"/><bsdf type="roughconductor">
    <string name="material" value="Au"/></bsdf></bsdf></shape>
  <shape type="cylinder"><bsdf type="dielectric"><string name="int_ior" value="bk7"/></bsdf><ref name="interior" id="fog"/></shape>
  <emitter type="spot"><rgb name="intensity" value="5"/></emitter> <emitter type="constant"/>
</scene>
"""
MITSUBA_OLD = b"""<scene version="0.5.0"><integrator type="volpath"><integer name="maxDepth" value="65"/></integrator>
  <sensor type="perspective"><float name="fov" value="70"/><transform name="toWorld"><matrix value="-1 0 0 6 0 1 0 1 0 0 -1 2 0 0 0 1"/>
    </transform><film type="ldrfilm"><integer name="width" value="8"/><integer name="height" value="8"/><float name="gamma" value="2.2"/>
    <boolean name="banner" value="false"/></film></sensor>
  <bsdf type="mixturebsdf" id="mix"><string name="weights" value="0.3, 0.5"/><bsdf type="phong"><float name="exponent" value="10"/></bsdf>
    <bsdf type="coating"><rgb name="sigmaA" value="0.1"/><bsdf type="conductor"><rgb name="eta" value="1 2 3"/><rgb name="k" value="3"/>
    </bsdf></bsdf></bsdf>
  <shape type="disk"><ref id="mix"/><emitter type="area"><srgb name="radiance" value="#ffcc00"/></emitter></shape></scene>
"""


def serialized_mesh():
    """Two meshes of one triangle each, as Mitsuba 0.5 writes them."""
    body = struct.pack("<I", 0x1001) + b"name\0" + struct.pack("<QQ", 3, 1)
    body += struct.pack("<18f", 0, 0, 0, 1, 0, 0, 0, 1, 0, *[0, 0, 1] * 3) + struct.pack("<3I", 0, 1, 2)
    part = struct.pack("<HH", 0x041C, 4) + zlib.compress(body)
    return part * 2 + struct.pack("<QQI", 0, len(part), 2)


def scenes_of_others():
    yield Seed("mitsuba", "input.xml", MITSUBA, [["check", "input.xml"]], {}, True)
    yield Seed("mitsuba 0.5", "input.xml", MITSUBA_OLD, [["check", "input.xml"]], {}, True)
    fragment = b'<scene version="3.0.0"><bsdf type="diffuse" id="white"/><shape type="sphere"><ref id="white"/></shape></scene>'
    whole = {"scene.xml": b'<scene version="3.0.0"><include filename="input.xml"/><sensor type="perspective"/></scene>'}
    yield Seed("mitsuba included", "input.xml", fragment, [["check", "scene.xml"]], whole, True)
    mesh = {"scene.xml": b'<scene version="3.0.0"><shape type="serialized"><string name="filename" value="input.serialized"/>'
                         b'<integer name="shape_index" value="1"/></shape><sensor type="perspective"/></scene>'}
    yield Seed("serialized mesh", "input.serialized", serialized_mesh(), [["check", "scene.xml"]], mesh, False)
    yield Seed("pbrt v4", "input.pbrt", PBRT, [["check", "input.pbrt"]], {}, True)
    yield Seed("pbrt v3", "input.pbrt", PBRT_V3, [["check", "input.pbrt"]], {}, True)
    whole = {"scene.pbrt": b'Camera "perspective" Film "rgb" WorldBegin Include "input.pbrt" Shape "sphere"'}
    yield Seed("pbrt included", "input.pbrt", PBRT.split(b"comment")[1], [["check", "scene.pbrt"]], whole, True)


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
    found = (list(images()) + list(meshes()) + list(models()) + list(tables()) + list(descriptions()) + list(scenes_of_others()) +
             checkpoints(program, folder))
    if plugin:
        data = pathlib.Path(plugin).read_bytes()
        found.append(Seed("plugin", "libinput.so", data, [["classes", "--plugin", "./libinput.so"]]))
    return found
