"""Right models: formats that are read natively, and some of those that are read through Assimp and USD's own library.

`models()` gives (what it is, file, bytes, whether it is text, files beside it).
"""
import base64
import json
import struct

import seed_images

CORNERS = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0), (0, 0, 1)]
FACES = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4), (0, 1, 2, 3)]


def obj():
    lines = ["# made for a test"] + ["v %g %g %g" % c for c in CORNERS] + ["vt %g %g" % c[:2] for c in CORNERS] + ["vn 0 0 1"]
    lines += ["f " + " ".join(f"{i + 1}/{i + 1}/1" for i in f) for f in FACES[:3]]
    lines += ["f " + " ".join(str(i + 1) for i in FACES[3]), "f -5// -4// -3//", "f 1 2 \\", " 3 4"]
    return "\n".join(lines).encode() + b"\n"


# ---- glTF -----------------------------------------------------------------------------------------------------------------


def picture():
    return next(data for name, ending, data in seed_images.small_images() if ending == "png")


class Buffer:
    """What accessors are made of."""

    def __init__(self):
        self.bytes, self.views, self.accessors = b"", [], []

    def view(self, data, **more):
        self.bytes += bytes(-len(self.bytes) % 4)
        self.views.append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data), **more})
        self.bytes += data
        return len(self.views) - 1

    def accessor(self, kind, values, width=1, **more):
        letter, code = {"f": ("f", 5126), "B": ("B", 5121), "H": ("H", 5123), "I": ("I", 5125)}[kind]
        shape = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}[width]
        view = self.view(struct.pack(f"<{len(values)}{letter}", *values))
        self.accessors.append({"bufferView": view, "componentType": code, "type": shape, "count": len(values) // width, **more})
        return len(self.accessors) - 1


def gltf_json(uri=None):
    """A shape with a skin and a morph, an animated one, one by sparse accessors and a strip; lights; a material of each kind."""
    b = Buffer()
    positions = b.accessor("f", [x for c in CORNERS for x in c], 3)
    indices = b.accessor("H", [i for f in FACES[:4] for i in f])
    normals = b.accessor("f", [0, 0, 1] * 5, 3)
    uvs = b.accessor("H", [0, 65535] * 5, 2, normalized=True)
    colors = b.accessor("B", [255, 128, 0, 255] * 5, 4, normalized=True)
    joints, weights = b.accessor("B", [0, 1, 0, 0] * 5, 4), b.accessor("f", [0.5, 0.5, 0, 0] * 5, 4)
    inverse = b.accessor("f", [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] * 2, 16)
    morph = b.accessor("f", [0, 0.5, 0] * 5, 3)
    times, moved = b.accessor("f", [0, 1]), b.accessor("f", [0, 0, 0, 1, 0, 0], 3)
    turned, morphed = b.accessor("f", [0, 0, 0, 1, 0, 1, 0, 0], 4), b.accessor("f", [0, 1, 0, 0, 1, 0])  # the last: a cubic spline
    sparse = {"count": 1, "indices": {"bufferView": b.view(struct.pack("<H", 2)), "componentType": 5123},
              "values": {"bufferView": b.view(struct.pack("<3f", 2, 2, 0))}}
    image = b.view(picture())
    b.accessors.append({"bufferView": b.accessors[positions]["bufferView"], "componentType": 5126, "type": "VEC3", "count": 5, "sparse": sparse})
    texture = {"index": 0, "texCoord": 0, "extensions": {"KHR_texture_transform": {"offset": [0.1, 0], "rotation": 0.3, "scale": [2, 2]}}}
    pbr = {"baseColorFactor": [1, 0.5, 0.2, 0.7], "baseColorTexture": texture, "metallicFactor": 0.3, "metallicRoughnessTexture": {"index": 1}}
    extensions = {
        "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessTexture": {"index": 1}},
        "KHR_materials_transmission": {"transmissionFactor": 0.5}, "KHR_materials_ior": {"ior": 1.4},
        "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 2, "attenuationColor": [0.5, 0.6, 0.7]},
        "KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [1, 0.5, 0.5]}, "KHR_materials_dispersion": {"dispersion": 0.3},
        "KHR_materials_sheen": {"sheenColorFactor": [0.2, 0.3, 0.4], "sheenRoughnessFactor": 0.3},
        "KHR_materials_iridescence": {"iridescenceFactor": 0.5, "iridescenceThicknessMaximum": 300},
        "KHR_materials_anisotropy": {"anisotropyStrength": 0.4}, "KHR_materials_emissive_strength": {"emissiveStrength": 3}}
    attributes = {"POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uvs, "COLOR_0": colors}
    text = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 2, 3, 6, 7, 8]}],
        "extensionsUsed": ["KHR_lights_punctual", "KHR_texture_transform", *extensions],
        "extensions": {"KHR_lights_punctual": {"lights": [
            {"type": "point", "intensity": 40, "range": 10}, {"type": "directional", "color": [1, 0.9, 0.8]},
            {"type": "spot", "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.4}}]}},
        "nodes": [
            {"children": [1], "scale": [1, 2, 1]}, {"mesh": 0, "translation": [0, 1, 0], "name": "moved"},
            {"camera": 0, "translation": [0, 0, 5]}, {"mesh": 1, "skin": 0, "weights": [0.5]}, {"children": [5]}, {"rotation": [0, 0, 0, 1]},
            {"extensions": {"KHR_lights_punctual": {"light": 0}}, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 3, 3, 1], "children": [4]},
            {"extensions": {"KHR_lights_punctual": {"light": 2}}}, {"camera": 1, "extensions": {"KHR_lights_punctual": {"light": 1}}}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "aspectRatio": 1.0, "znear": 0.1}},
                    {"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 2, "zfar": 10, "znear": 0}}],
        "meshes": [{"primitives": [{"attributes": attributes, "indices": indices, "material": 0},
                                   {"attributes": {"POSITION": len(b.accessors) - 1}, "mode": 5, "material": 1}]},
                   {"primitives": [{"attributes": {**attributes, "JOINTS_0": joints, "WEIGHTS_0": weights}, "indices": indices,
                                    "targets": [{"POSITION": morph}], "material": 2}], "weights": [0.3]}],
        "skins": [{"joints": [4, 5], "inverseBindMatrices": inverse}],
        "materials": [
            {"pbrMetallicRoughness": pbr, "alphaMode": "MASK", "alphaCutoff": 0.3, "extensions": extensions, "normalTexture": {"index": 1, "scale": 0.5},
             "emissiveFactor": [0.1, 0, 0], "emissiveTexture": {"index": 0}, "doubleSided": True, "occlusionTexture": {"index": 1}},
            {"alphaMode": "BLEND", "extensions": {"KHR_materials_unlit": {}}},
            {"extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0.2, 0.2, 0.2, 1], "specularFactor": [0.1, 0.1, 0.1]}}}],
        "textures": [{"source": 0, "sampler": 0}, {"source": 1}], "samplers": [{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728}],
        "images": [{"uri": "data:image/png;base64," + base64.b64encode(picture()).decode()}, {"bufferView": image, "mimeType": "image/png"}],
        "animations": [{"samplers": [{"input": times, "output": moved}, {"input": times, "output": turned, "interpolation": "STEP"},
                                     {"input": times, "output": morphed, "interpolation": "CUBICSPLINE"}],
                        "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}, {"sampler": 1, "target": {"node": 5, "path": "rotation"}},
                                     {"sampler": 2, "target": {"node": 3, "path": "weights"}}]}],
        "accessors": b.accessors, "bufferViews": b.views, "buffers": [{"byteLength": len(b.bytes), **({"uri": uri} if uri else {})}],
    }
    return json.dumps(text).encode(), b.bytes


def glb(text, binary):
    text += b" " * (-len(text) % 4)
    binary += bytes(-len(binary) % 4)
    return (b"glTF" + struct.pack("<III", 2, 28 + len(text) + len(binary), len(text)) + b"JSON" + text
            + struct.pack("<I", len(binary)) + b"BIN\0" + binary)


def compressed_json(primitive, accessors, views, binary, extension):
    text = {"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "meshes": [{"primitives": [primitive]}],
            "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(binary)}, {"byteLength": 200}], "extensionsRequired": [extension]}
    return glb(json.dumps(text).encode(), binary)


def glb_meshopt():
    """The pyramid's places with exponents, normals on an octahedron, colours by luma and chroma, its corners in both ways: by
    meshoptimizer 1.3."""
    views, accessors, binary = [], [], b""
    for data, count, stride, mode, filter, accessor in (
            ("ob6epgCAAH9AAAIAAQIAAIAAPwAEAAIAEABAAAAAAAAAAAAAAOD/8wDg//MAAADzAAAA", 5, 12, "ATTRIBUTES", "EXPONENTIAL", (5126, "VEC3")),
            ("oAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAB/AA==", 5, 4, "ATTRIBUTES", "OCTAHEDRAL", (5120, "VEC3")),
            ("of8A29ukWQAAAP79AAAAgH8Aa5JtkgAAAAAAAAAAAAAAAAAAAAAAAAAl3AC2AA==", 5, 4, "ATTRIBUTES", "COLOR", (5121, "VEC4")),
            ("4f4QAAQPCAB2h1ZneKmGZYlomAFpAAA=", 12, 2, "TRIANGLES", "NONE", (5123, "SCALAR")),
            ("0QAEDAoECAYEBAIKEAAAAAA=", 12, 2, "INDICES", "NONE", (5123, "SCALAR"))):
        data = base64.b64decode(data)
        by = {"buffer": 0, "byteOffset": len(binary), "byteLength": len(data), "count": count, "byteStride": stride, "mode": mode, "filter": filter}
        views.append({"buffer": 1, "byteLength": count * stride, "extensions": {"KHR_meshopt_compression": by}, **({"byteStride": stride} if stride > 2 else {})})
        accessors.append({"bufferView": len(views) - 1, "componentType": accessor[0], "type": accessor[1], "count": count, "normalized": accessor[0] in (5120, 5121)})
        binary += data
    primitive = {"attributes": {"POSITION": 0, "NORMAL": 1, "COLOR_0": 2}, "indices": 3}
    return compressed_json(primitive, accessors, views, binary, "KHR_meshopt_compression")


def glb_draco(sequential):
    """The pyramid with normals and colours, by Draco 1.5.7."""
    binary = base64.b64decode(
        "RFJBQ08CAgEAAAAEBQEAAQQBAgQCAwQDAAQBAwAJAwAAAQkDAAECAgQAAgIDAQABAQAMA2kmzQwfzQwDBfWdiIT/9///AAAAAP8HAAAAAwEBBIABmTn/92kGAxa4hf8A"
        "AAB/AAAAAAEBAQVhNQNbNQNbNQNbNQNbMTMFQN1/UJYAAAAA5AAAAAAAgL8AAIC/AAAAAAAAAEALCA==" if sequential else
        "RFJBQ08CAgEBAAAABQQCBAAAAm8B/wER/wJEQP8CREAD/wABAAAAAQAAAQAJAwAAAgEBCQMAAQMBAgIEAAIBAQEBAAwHzQwfNTMD8t+C///////v//8j/gfA/wHg//8D"
        "AAAAAP8HAAAAAIC/AACAvwAAAAAAAABACwYDAQEEwgHNDHeZGf//g50ZBAuH4aX/AAAAfwAAAP8CVUAIAQEBAAkDzQwTmRmdGQOhlLDJWCbw/X6/qqqqqiCsff0LAAAAAOQAAAA=")
    accessors = [{"componentType": 5126, "type": "VEC3", "count": 5}, {"componentType": 5126, "type": "VEC3", "count": 5},
                 {"componentType": 5121, "type": "VEC4", "count": 5, "normalized": True}, {"componentType": 5123, "type": "SCALAR", "count": 12}]
    attributes = {"POSITION": 0, "NORMAL": 1, "COLOR_0": 2}
    primitive = {"attributes": attributes, "indices": 3, "extensions": {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": attributes}}}
    return compressed_json(primitive, accessors, [{"buffer": 0, "byteLength": len(binary)}], binary, "KHR_draco_mesh_compression")


# ---- formats of triangles alone -------------------------------------------------------------------------------------------


def stl_binary():
    data = b"made for a test".ljust(80) + struct.pack("<I", 4)
    for face in FACES[:4]:
        data += struct.pack("<12fH", 0, 0, 1, *(x for i in face for x in CORNERS[i]), 0)
    return data


def stl_text():
    lines = []
    for name, faces in (("a", FACES[:2]), ("b", FACES[2:4])):
        lines.append(f"solid {name}")
        for face in faces:
            lines += ["facet normal 0 0 1", "outer loop", *("vertex %g %g %g" % CORNERS[i] for i in face), "endloop", "endfacet"]
        lines.append(f"endsolid {name}")
    return "\n".join(lines).encode()


def off(kind="OFF"):
    more = {"OFF": "", "COFF": " 0.5 0.2 0.1 1", "NOFF": " 0 0 1", "STOFF": " 0 1"}[kind]
    return (f"{kind}\n# made for a test\n5 5 0\n" + "".join("%g %g %g" % c + more + "\n" for c in CORNERS)
            + "".join(f"{len(f)} {' '.join(map(str, f))}\n" for f in FACES)).encode()


MTL = (b"newmtl a\nKa 1 1 1\nKd 0.5 0.2 0.1\nKs 0.5 0.5 0.5\nNs 50\nillum 2\nmap_Kd -s 2 2 -o 0.5 0 -clamp on picture.png\nmap_d picture.png\n"
       b"newmtl b\nPr 0.2\nPm 1\nPs 0.3\nPc 0.5\nPcr 0.1\naniso 0.3\nd 0.5\nKe 1 1 1\nTf 1 1 1\nNi 1.5\nbump -bm 0.2 picture.png\nmap_Pr picture.png\n"
       b"newmtl glass\nillum 7\nNi 1.5\nTf 0.9 1 0.9\nd 0.2\nnorm picture.png\nrefl -type sphere none.png\nmap_Ke picture.png\n")
USING_MTL = b"mtllib input.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\nusemtl glass\nf 1 2 4\n"

# ---- formats that other libraries read ------------------------------------------------------------------------------------


def chunk(kind, *content):
    body = b"".join(content)
    return struct.pack("<HI", kind, 6 + len(body)) + body


def three_ds():
    """3D Studio: a pyramid with a material and its texture, a light, a camera, and keys."""
    colour = chunk(0x0011, bytes([200, 100, 50]))
    material = chunk(0xAFFF, chunk(0xA000, b"paint\0"), chunk(0xA020, colour), chunk(0xA030, colour), chunk(0xA040, chunk(0x0030, b"\x1e\0")),
                     chunk(0xA050, chunk(0x0030, b"\x0a\0")), chunk(0xA200, chunk(0xA300, b"picture.png\0"), chunk(0xA354, struct.pack("<f", 2))))
    vertices = chunk(0x4110, struct.pack("<H15f", 5, *(x for c in CORNERS for x in c)))
    uvs = chunk(0x4140, struct.pack("<H10f", 5, *(x for c in CORNERS for x in c[:2])))
    place = chunk(0x4160, struct.pack("<12f", 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0))
    faces = chunk(0x4120, struct.pack("<H16H", 4, *(x for f in FACES[:4] for x in (*f, 7))),
                  chunk(0x4130, b"paint\0", struct.pack("<5H", 4, 0, 1, 2, 3)), chunk(0x4150, struct.pack("<4I", 1, 1, 1, 1)))
    mesh = chunk(0x4000, b"pyramid\0", chunk(0x4100, vertices, uvs, place, faces))
    lamp = chunk(0x4000, b"lamp\0", chunk(0x4600, struct.pack("<3f", 2, 2, 2), chunk(0x0010, struct.pack("<3f", 1, 1, 1))))
    camera = chunk(0x4000, b"eye\0", chunk(0x4700, struct.pack("<8f", 0, -5, 1, 0, 0, 0, 0, 35)))
    def key(kind, name, track):
        return chunk(kind, chunk(0xB010, name, struct.pack("<HHh", 0, 0, -1)), chunk(0xB013, struct.pack("<3f", 0, 0, 0)),
                     chunk(track, struct.pack("<HIIIIH3f", 0, 0, 0, 1, 0, 0, 0, 0, 0)))

    keys = chunk(0xB000, chunk(0xB00A, struct.pack("<H", 3), b"x\0", struct.pack("<I", 100)), chunk(0xB008, struct.pack("<II", 0, 100)),
                 key(0xB002, b"pyramid\0", 0xB020), key(0xB003, b"eye\0", 0xB020), key(0xB005, b"lamp\0", 0xB020))
    return chunk(0x4D4D, chunk(0x0002, struct.pack("<I", 3)), chunk(0x3D3D, chunk(0x3D3E, struct.pack("<I", 3)), material, mesh, lamp, camera), keys)


def lightwave():
    """LWO2: a pyramid with a surface."""
    def part(name, body, short=False):
        return name + struct.pack(">H" if short else ">I", len(body)) + body + bytes(len(body) % 2)

    points = part(b"PNTS", struct.pack(">15f", *(x for c in CORNERS for x in c)))
    polygons = part(b"POLS", b"FACE" + b"".join(struct.pack(f">H{len(f)}H", len(f), *f) for f in FACES))
    tags, used = part(b"TAGS", b"paint\0"), part(b"PTAG", b"SURF" + b"".join(struct.pack(">2H", i, 0) for i in range(len(FACES))))
    surface = part(b"SURF", b"paint\0\0\0" + part(b"COLR", struct.pack(">3fH", 0.5, 0.2, 0.1, 0), True) + part(b"DIFF", struct.pack(">fH", 1, 0), True)
                   + part(b"SPEC", struct.pack(">fH", 0.5, 0), True) + part(b"GLOS", struct.pack(">fH", 0.4, 0), True))
    body = b"LWO2" + tags + part(b"LAYR", struct.pack(">2H3f", 0, 0, 0, 0, 0) + b"a\0") + points + polygons + used + surface
    return b"FORM" + struct.pack(">I", len(body)) + body


POINTS_TEXT = " ".join("%g %g %g" % c for c in CORNERS)
COLLADA = f"""<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit name="inch" meter="0.0254"/><up_axis>Z_UP</up_axis></asset>
<library_images><image id="i"><init_from>picture.png</init_from></image></library_images>
<library_effects><effect id="e"><profile_COMMON><newparam sid="s"><surface type="2D"><init_from>i</init_from></surface></newparam>
<newparam sid="t"><sampler2D><source>s</source></sampler2D></newparam><technique sid="c"><phong><diffuse><texture texture="t" texcoord="UV"/></diffuse>
<specular><color>0.5 0.5 0.5 1</color></specular><shininess><float>20</float></shininess></phong></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_lights><light id="l"><technique_common><point><color>1 1 1</color></point></technique_common></light></library_lights>
<library_cameras><camera id="k"><optics><technique_common><perspective><yfov>40</yfov><znear>0.1</znear><zfar>9</zfar></perspective></technique_common></optics>
</camera></library_cameras>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" count="15">{POINTS_TEXT}</float_array><technique_common>
<accessor source="#pa" count="5" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor>
</technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4" material="m"><input semantic="VERTEX" source="#v" offset="0"/><p>{" ".join(str(i) for f in FACES[:4] for i in f)}</p></triangles>
<polylist count="1" material="m"><input semantic="VERTEX" source="#v" offset="0"/><vcount>4</vcount><p>0 1 2 3</p></polylist></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="w"><node id="a"><translate>1 0 0</translate><rotate>0 0 1 30</rotate><instance_geometry url="#g"><bind_material>
<technique_common><instance_material symbol="m" target="#m"/></technique_common></bind_material></instance_geometry>
<node><instance_light url="#l"/></node></node><node><instance_camera url="#k"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#w"/></scene></COLLADA>
"""

ASE = """*3DSMAX_ASCIIEXPORT 200
*SCENE {
 *SCENE_FIRSTFRAME 0
 *SCENE_LASTFRAME 10
}
*MATERIAL_LIST {
 *MATERIAL_COUNT 1
 *MATERIAL 0 {
  *MATERIAL_NAME "paint"
  *MATERIAL_CLASS "Standard"
  *MATERIAL_DIFFUSE 0.5 0.2 0.1
  *MATERIAL_SHINE 0.3
  *MAP_DIFFUSE {
   *BITMAP "picture.png"
  }
 }
}
*GEOMOBJECT {
 *NODE_NAME "pyramid"
 *NODE_TM {
  *TM_ROW0 1 0 0
  *TM_ROW1 0 1 0
  *TM_ROW2 0 0 1
  *TM_ROW3 0 0 0
 }
 *MESH {
  *MESH_NUMVERTEX 5
  *MESH_NUMFACES 4
  *MESH_VERTEX_LIST {
""" + "".join("   *MESH_VERTEX %d %g %g %g\n" % (i, *c) for i, c in enumerate(CORNERS)) + """  }
  *MESH_FACE_LIST {
""" + "".join("   *MESH_FACE %d: A: %d B: %d C: %d AB: 1 BC: 1 CA: 1 *MESH_SMOOTHING 1 *MESH_MTLID 0\n" % (i, *f)
              for i, f in enumerate(FACES[:4])) + """  }
 }
 *MATERIAL_REF 0
}
"""

DIRECTX = ("xof 0303txt 0032\nFrame Root {\n FrameTransformMatrix { 1.0,0.0,0.0,0.0, 0.0,1.0,0.0,0.0, 0.0,0.0,1.0,0.0, 0.0,0.0,0.0,1.0;; }\n Mesh pyramid {\n  5;\n"
           + ",\n".join("  %.1f;%.1f;%.1f;" % c for c in CORNERS) + ";\n  4;\n" + ",\n".join("  3;%d,%d,%d;" % f for f in FACES[:4])
           + ";\n  MeshMaterialList {\n   1;\n   4;\n   0,0,0,0;;\n   Material paint { 0.5;0.2;0.1;1.0;; 10.0; 0.5;0.5;0.5;; 0.0;0.0;0.0;;\n"
             "    TextureFilename { \"picture.png\"; } }\n  }\n }\n}\n")

AC3D = ("AC3Db\nMATERIAL \"paint\" rgb 0.5 0.2 0.1 amb 0.2 0.2 0.2 emis 0 0 0 spec 0.5 0.5 0.5 shi 10 trans 0\nOBJECT world\nkids 1\nOBJECT poly\n"
        "name \"pyramid\"\ntexture \"picture.png\"\nloc 0 1 0\nnumvert 5\n" + "".join("%g %g %g\n" % c for c in CORNERS) + "numsurf 4\n"
        + "".join("SURF 0x10\nmat 0\nrefs 3\n" + "".join(f"{i} 0.5 0.5\n" for i in f) for f in FACES[:4]) + "kids 0\n")

FBX = ("; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n FBXHeaderVersion: 1003\n FBXVersion: 7400\n}\nObjects:  {\n"
       " Geometry: 1, \"Geometry::pyramid\", \"Mesh\" {\n  Vertices: *15 {\n   a: " + ",".join("%g" % x for c in CORNERS for x in c)
       + "\n  }\n  PolygonVertexIndex: *16 {\n   a: " + ",".join(str(i if k < len(f) - 1 else -i - 1) for f in FACES for k, i in enumerate(f))
       + "\n  }\n  GeometryVersion: 124\n  LayerElementMaterial: 0 {\n   MappingInformationType: \"AllSame\"\n   ReferenceInformationType: \"IndexToDirect\"\n"
         "   Materials: *1 {\n    a: 0\n   }\n  }\n  Layer: 0 {\n   Version: 100\n   LayerElement:  {\n    Type: \"LayerElementMaterial\"\n    TypedIndex: 0\n   }\n  }\n }\n"
         " Model: 2, \"Model::pyramid\", \"Mesh\" {\n  Version: 232\n  Properties70:  {\n   P: \"Lcl Translation\", \"Lcl Translation\", \"\", \"A\",1,0,0\n  }\n }\n"
         " Material: 3, \"Material::paint\", \"\" {\n  ShadingModel: \"phong\"\n  Properties70:  {\n   P: \"DiffuseColor\", \"Color\", \"\", \"A\",0.5,0.2,0.1\n  }\n }\n}\n"
         "Connections:  {\n C: \"OO\",1,2\n C: \"OO\",3,2\n C: \"OO\",2,0\n}\n")

USDA = """#usda 1.0
(
    defaultPrim = "root"
    upAxis = "Z"
    metersPerUnit = 1
)
def Xform "root" {
    double3 xformOp:translate = (0, 0, 1)
    uniform token[] xformOpOrder = ["xformOp:translate"]
    def Mesh "pyramid" {
        int[] faceVertexCounts = [3, 3, 3, 3, 4]
        int[] faceVertexIndices = [""" + ", ".join(str(i) for f in FACES for i in f) + """]
        point3f[] points = [""" + ", ".join("(%g, %g, %g)" % c for c in CORNERS) + """]
        uniform token subdivisionScheme = "none"
        rel material:binding = </root/paint>
    }
    def Material "paint" {
        token outputs:surface.connect = </root/paint/surface.outputs:surface>
        def Shader "surface" {
            uniform token info:id = "UsdPreviewSurface"
            color3f inputs:diffuseColor = (0.5, 0.2, 0.1)
            float inputs:roughness = 0.3
            token outputs:surface
        }
    }
    def SphereLight "lamp" { float inputs:intensity = 30 double3 xformOp:translate = (2, 2, 2) uniform token[] xformOpOrder = ["xformOp:translate"] }
    def Camera "eye" { float focalLength = 35 double3 xformOp:translate = (0, 0, 5) uniform token[] xformOpOrder = ["xformOp:translate"] }
}
"""


def models():
    text, binary = gltf_json("input.bin")
    image = {"picture.png": picture()}
    yield "glb", "input.glb", glb(*gltf_json()), False, {}
    yield "glb meshopt", "input.glb", glb_meshopt(), False, {}
    yield "gltf", "input.gltf", text, True, {"input.bin": binary}
    parts = b"mtllib input.mtl\n" + obj() + b"g one\ns 1\nusemtl a\nf 1 2 3\no two\ns off\nusemtl b\nf 1 3 4\nv 0 0 2 0.5 0.2 0.1\nl 1 2\np 1\n"
    yield "obj model", "input.obj", parts, True, {"input.mtl": MTL, **image}
    yield "mtl", "input.mtl", MTL, True, {"model.obj": USING_MTL, **image}
    yield "stl binary", "input.stl", stl_binary(), False, {}
    yield "stl text", "input.stl", stl_text(), True, {}
    for kind in ("OFF", "COFF", "NOFF", "STOFF"):
        yield kind.lower(), "input.off", off(kind), True, {}


def models_of_libraries():
    """Those that are read in a process of its own."""
    image = {"picture.png": picture()}
    yield "draco", "input.glb", glb_draco(False), False, {}
    yield "draco sequential", "input.glb", glb_draco(True), False, {}
    yield "assimp 3ds", "input.3ds", three_ds(), False, image
    yield "assimp lwo", "input.lwo", lightwave(), False, image
    for name, ending, text in (("collada", "dae", COLLADA), ("ase", "ase", ASE), ("x", "x", DIRECTX), ("ac", "ac", AC3D), ("fbx", "fbx", FBX)):
        yield f"assimp {name}", f"input.{ending}", text.encode(), True, image
    yield "usd", "input.usda", USDA.encode(), True, image
