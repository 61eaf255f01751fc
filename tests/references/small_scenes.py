"""Small scenes of other programs' formats: each has shared parts, textures, meshes in files and what its format says otherwise."""

import json
import struct
import zlib

# A square of two triangles in z = 0, from -1 to 1.
CORNERS = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
UVS = [(0, 0), (1, 0), (1, 1), (0, 1)]
TRIANGLES = [(0, 1, 2), (0, 2, 3)]


def png(pixels):
    """Rows of (r, g, b), 8 bits."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    rows = b"".join(b"\0" + bytes(value for pixel in row for value in pixel) for row in pixels)
    header = struct.pack(">IIBBBBB", len(pixels[0]), len(pixels), 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


IMAGE = png([[(200, 40, 30), (30, 180, 60)], [(50, 60, 220), (230, 220, 80)]])


def obj(material=""):
    text = material
    text += "".join(f"v {x} {y} {z}\n" for x, y, z in CORNERS) + "".join(f"vt {u} {v}\n" for u, v in UVS)
    return text + "".join("f " + " ".join(f"{i + 1}/{i + 1}" for i in t) + "\n" for t in TRIANGLES)


PLY = ("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float s\n"
       "property float t\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n" +
       "".join(f"{x} {y} {z} {u} {v}\n" for (x, y, z), (u, v) in zip(CORNERS, UVS)) +
       "".join("3 " + " ".join(map(str, t)) + "\n" for t in TRIANGLES))

MITSUBA = """<scene version="3.0.0">
  <default name="spp" value="8"/>
  <integrator type="volpath"><integer name="max_depth" value="6"/></integrator>
  <sensor type="thinlens">
    <float name="fov" value="40"/><float name="aperture_radius" value="0.05"/><float name="focus_distance" value="4"/>
    <transform name="to_world"><lookat origin="0.3, 1.2, 5.1" target="0, 0.1, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="40"/><integer name="height" value="30"/><rfilter type="gaussian"/></film>
    <sampler type="independent"><integer name="sample_count" value="$spp"/></sampler>
  </sensor>
  <texture type="bitmap" id="a picture"><string name="filename" value="image.png"/><transform name="to_uv"><scale x="3" y="2"/></transform>
  </texture>
  <bsdf type="twosided" id="painted"><bsdf type="diffuse"><ref id="a picture" name="reflectance"/></bsdf></bsdf>
  <bsdf type="roughconductor" id="copper"><string name="material" value="Cu"/><float name="alpha" value="0.17"/></bsdf>
  <bsdf type="dielectric" id="glass"><float name="int_ior" value="1.517"/></bsdf>
  <medium type="homogeneous" id="smoke"><rgb name="albedo" value="0.8, 0.7, 0.4"/><float name="sigma_t" value="1.7"/></medium>
  <shape type="obj"><string name="filename" value="square.obj"/><ref id="painted"/>
    <transform name="to_world"><rotate x="1" angle="-90"/><scale value="3"/><translate y="-0.7"/></transform></shape>
  <shape type="sphere"><point name="center" x="-1.1" y="0.1" z="0.3"/><float name="radius" value="0.7"/><ref id="copper"/></shape>
  <shape type="sphere"><point name="center" x="0.5" y="0.05" z="0.2"/><float name="radius" value="0.71"/><ref id="glass"/></shape>
  <shape type="cube"><transform name="to_world"><scale value="0.4"/><translate x="1.7" y="0.1"/></transform>
    <bsdf type="null"/><ref id="smoke" name="interior"/></shape>
  <shape type="shapegroup" id="group"><shape type="ply"><string name="filename" value="square.ply"/><ref id="painted"/></shape></shape>
  <shape type="instance"><ref id="group"/><transform name="to_world"><rotate y="1" angle="31.7"/><translate x="1" y="1" z="-2"/></transform>
  </shape>
  <shape type="instance"><ref id="group"/><transform name="to_world"><scale x="0.7" y="1.3"/><translate x="-1.3" y="0.7" z="-2.1"/></transform>
  </shape>
  <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="90"/><scale value="0.6"/><translate y="3"/></transform>
    <emitter type="area"><rgb name="radiance" value="11, 9.7, 6.1"/></emitter></shape>
  <emitter type="constant"><rgb name="radiance" value="0.13, 0.19, 0.31"/></emitter>
  <emitter type="spot"><transform name="to_world"><lookat origin="2, 3, 3" target="0, 0, 0" up="0, 1, 0"/></transform>
    <spectrum name="intensity" value="400:2.1, 500:3.3, 600:5.7, 700:4.1"/><float name="cutoff_angle" value="27"/></emitter>
</scene>
"""

PBRT = """LookAt 0.3 1.2 5.1  0 0.1 0  0 1 0
Camera "perspective" "float fov" 37.3 "float lensradius" 0.05 "float focaldistance" 4.1
Film "rgb" "integer xresolution" 40 "integer yresolution" 30
PixelFilter "mitchell"
Sampler "zsobol" "integer pixelsamples" 8
Integrator "volpath" "integer maxdepth" 5
MakeNamedMedium "smoke" "string type" "homogeneous" "rgb sigma_a" [0.3 0.5 0.9] "rgb sigma_s" [1.1 0.7 0.5] "float g" 0.3
WorldBegin
Texture "a picture" "spectrum" "imagemap" "string filename" "image.png" "float uscale" 3
MakeNamedMaterial "painted" "string type" "diffuse" "texture reflectance" "a picture"
MakeNamedMaterial "brass" "string type" "conductor" "spectrum eta" "metal-CuZn-eta" "spectrum k" "metal-CuZn-k" "float roughness" 0.11
MakeNamedMaterial "coated" "string type" "coateddiffuse" "rgb reflectance" [0.2 0.4 0.7] "float roughness" 0.2
AttributeBegin
  Translate 0 -0.7 0
  Rotate -90 1 0 0
  Scale 3 3 3
  NamedMaterial "painted"
  Shape "plymesh" "string filename" "square.ply"
AttributeEnd
AttributeBegin
  NamedMaterial "brass"
  Translate -1.1 0.1 0.3
  Shape "sphere" "float radius" 0.7
AttributeEnd
AttributeBegin
  Material "dielectric" "spectrum eta" "glass-BK7"
  Translate 0.5 0.05 0.2
  Shape "sphere" "float radius" 0.71
AttributeEnd
ObjectBegin "group"
  NamedMaterial "coated"
  Shape "loopsubdiv" "integer levels" 2 "integer indices" [0 1 2 0 2 3] "point3 P" [-1 -1 0 1 -1 0.3 1 1 0 -1 1 0.2]
ObjectEnd
AttributeBegin
  Translate 1 1 -2
  Rotate 31.7 0 1 0
  ObjectInstance "group"
AttributeEnd
AttributeBegin
  Translate -1.3 0.7 -2.1
  ObjectInstance "group"
AttributeEnd
AttributeBegin
  MediumInterface "smoke" ""
  Material "interface"
  Translate 1.7 0.1 0
  Shape "sphere" "float radius" 0.4
AttributeEnd
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [11 9.7 6.1] "float scale" 1.3
  Translate 0 3 0
  Rotate 90 1 0 0
  Shape "disk" "float radius" 0.7
AttributeEnd
LightSource "infinite" "rgb L" [0.13 0.19 0.31]
LightSource "point" "blackbody I" 3500 "point3 from" [2 3 3] "float power" 90
"""


def gltf():
    binary = b"".join(struct.pack("<3f", *p) for p in CORNERS) + b"".join(struct.pack("<2f", u, 1 - v) for u, v in UVS)
    binary += struct.pack("<6H", *[i for t in TRIANGLES for i in t])
    image = len(binary)
    binary += IMAGE
    binary += b"\0" * (-len(binary) % 4)
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2, 3, 4]}],
        "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_transmission", "KHR_materials_ior"],
        "buffers": [{"byteLength": len(binary)}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 32},
                        {"buffer": 0, "byteOffset": 80, "byteLength": 12}, {"buffer": 0, "byteOffset": image, "byteLength": len(IMAGE)}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]},
                      {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
                      {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}],
        "images": [{"bufferView": 3, "mimeType": "image/png"}], "textures": [{"source": 0}],
        "materials": [
            {"name": "painted wall", "doubleSided": True,
             "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0, "roughnessFactor": 0.71}},
            {"name": "metal", "pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.71, 0.33, 1], "roughnessFactor": 0.23}},
            {"name": "lamp", "emissiveFactor": [1, 0.83, 0.7]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": m}]} for m in range(3)],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.71, "aspectRatio": 1.33, "znear": 0.1, "zfar": 50}}],
        "nodes": [{"mesh": 0, "rotation": [-0.7071068, 0, 0, 0.7071068], "scale": [3, 3, 3], "translation": [0, -0.7, 0]},
                  {"mesh": 1, "translation": [0.3, 0.5, -1], "children": [5]},
                  {"mesh": 2, "rotation": [0.7071068, 0, 0, 0.7071068], "translation": [0, 3, 0]},
                  {"camera": 0, "translation": [0.3, 0.4, 5.1]},
                  {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [2, 3, 3]},
                  {"mesh": 0, "rotation": [0, 0.3826834, 0, 0.9238795], "translation": [-1.7, 0, 0.3], "scale": [0.5, 0.7, 1]}],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 37, "color": [1, 0.9, 0.7]}]}},
    }
    return document, binary


def glb():
    document, binary = gltf()
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    return (b"glTF" + struct.pack("<II", 2, 12 + 8 + len(text) + 8 + len(binary)) + struct.pack("<I", len(text)) + b"JSON" + text +
            struct.pack("<I", len(binary)) + b"BIN\0" + binary)


def write_small_scenes(folder):
    """The files of scenes and models that were written."""
    document, binary = gltf()
    document["buffers"][0]["uri"] = "model.bin"
    stl = b"\0" * 80 + struct.pack("<I", 2) + b"".join(
        struct.pack("<12fH", 0, 0, 1, *(c for i in t for c in CORNERS[i]), 0) for t in TRIANGLES)
    off = "OFF\n4 2 0\n" + "".join(f"{x} {y} {z}\n" for x, y, z in CORNERS) + "".join("3 %d %d %d\n" % t for t in TRIANGLES)
    files = {
        "scene.xml": MITSUBA, "scene.pbrt": PBRT, "model.gltf": json.dumps(document), "model.glb": glb(),
        "model.obj": obj("mtllib model.mtl\nusemtl painted wall\n"), "square.ply": PLY, "model.stl": stl, "model.off": off,
        "square.obj": obj(), "model.mtl": "newmtl painted wall\nKd 0.7 0.6 0.5\nmap_Kd image.png\nKs 0.2 0.2 0.2\nNs 90\n",
        "image.png": IMAGE, "model.bin": binary,
    }
    for name, content in files.items():
        (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    return [folder / name for name in list(files)[:9]]
