#!/usr/bin/env python3
"""etendue_usd.py FILE [SECONDS [FOLDER ...]]: a USD stage as .glb on standard output; what is wrong goes to standard error.

It is started by UsdImporter, in a process of its own. Meshes, GeomSubsets, transforms, instances, UsdPreviewSurface materials,
lights and cameras are converted; what is not is told in asset.extras.notes, which the importer shows.
"""
import json
import math
import os
import resource
import struct
import sys
import urllib.parse

try:
    import numpy
    from pxr import Ar, Gf, Usd, UsdGeom, UsdLux, UsdShade
except ImportError as missing:
    sys.exit(f"USD files are read by Python packages that are not installed ({missing.name}): pip install usd-core numpy; "
             "the environment variable ETENDUE_PYTHON names the Python that has them")


class Glb:
    def __init__(self):
        self.json = {"asset": {"version": "2.0", "extras": {"notes": []}}}
        self.buffer = bytearray()

    def add(self, where, element):
        self.json.setdefault(where, []).append(element)
        return len(self.json[where]) - 1

    def view(self, data):
        self.buffer += bytes(-len(self.buffer) % 4)
        offset = len(self.buffer)
        self.buffer += data
        return self.add("bufferViews", {"buffer": 0, "byteOffset": offset, "byteLength": len(data)})

    def accessor(self, values, component, kind):
        count = len(values)
        return self.add("accessors", {"bufferView": self.view(values.tobytes()), "componentType": component, "type": kind, "count": count})

    def vectors(self, values):
        values = numpy.ascontiguousarray(values, dtype="<f4")
        return self.accessor(values, 5126, f"VEC{values.shape[1]}")

    def indices(self, values):
        return self.accessor(numpy.ascontiguousarray(values.reshape(-1), dtype="<u4"), 5125, "SCALAR")

    def note(self, text):
        if text not in self.json["asset"]["extras"]["notes"]:
            self.json["asset"]["extras"]["notes"].append(text)

    def write(self, out):
        self.buffer += bytes(-len(self.buffer) % 4)
        self.json["buffers"] = [{"byteLength": len(self.buffer)}]
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        out.write(b"glTF" + struct.pack("<II", 2, 28 + len(text) + len(self.buffer)))
        out.write(struct.pack("<I", len(text)) + b"JSON" + text + struct.pack("<I", len(self.buffer)) + b"BIN\0")
        out.write(self.buffer)


def plain(values):
    return [float(x) for x in values]


class Materials:
    """UsdPreviewSurface as glTF's metal and roughness."""

    def __init__(self, glb, time):
        self.glb, self.time, self.known, self.images = glb, time, {}, {}

    def get(self, prim):
        material = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()[0]
        if not material:
            return None
        path = material.GetPath()
        if path not in self.known:
            self.known[path] = self.make(material)
        return self.known[path]

    def make(self, material):
        surface = material.ComputeSurfaceSource()[0]
        name = material.GetPrim().GetName()
        if not surface or surface.GetIdAttr().Get() != "UsdPreviewSurface":
            self.glb.note("of materials UsdPreviewSurface is read; others are grey")
            return self.glb.add("materials", {"name": name})
        value = lambda key, otherwise: self.value(surface, key, otherwise)
        texture = lambda key: self.texture(surface, key)
        diffuse, diffuse_map = plain(value("diffuseColor", (0.18, 0.18, 0.18))), texture("diffuseColor")
        opacity, opacity_map = float(value("opacity", 1)), texture("opacity")
        pbr = {"baseColorFactor": ([1, 1, 1] if diffuse_map else diffuse) + [1 if opacity_map else opacity]}
        if diffuse_map:
            pbr["baseColorTexture"] = diffuse_map[0]
        metal_map, rough_map = texture("metallic"), texture("roughness")
        pbr["metallicFactor"], pbr["roughnessFactor"] = float(value("metallic", 0)), float(value("roughness", 0.5))
        together = metal_map or rough_map
        fits = all(m is None or (m[0] == together[0] and m[1] == c) for m, c in ((metal_map, "b"), (rough_map, "g")))
        if together and fits:
            pbr["metallicRoughnessTexture"] = together[0]
            pbr.update({"metallicFactor": 1.0 if metal_map else pbr["metallicFactor"], "roughnessFactor": 1.0 if rough_map else pbr["roughnessFactor"]})
        elif together:
            self.glb.note("textures of metalness and roughness are read from blue and green of one image only")
        made = {"name": name, "pbrMetallicRoughness": pbr, "extensions": {"KHR_materials_ior": {"ior": float(value("ior", 1.5))}}}
        if opacity_map and diffuse_map and opacity_map[0] == diffuse_map[0]:
            made["alphaMode"] = "BLEND"
        elif opacity_map:
            self.glb.note("textures of opacity are left out where they are not the colour's own")
        if opacity < 1:
            made["alphaMode"] = "BLEND"
        if float(value("opacityThreshold", 0)) > 0:
            made["alphaMode"], made["alphaCutoff"] = "MASK", float(value("opacityThreshold", 0))
        emission, emission_map = plain(value("emissiveColor", (0, 0, 0))), texture("emissiveColor")
        made["emissiveFactor"] = [1, 1, 1] if emission_map else emission
        if emission_map:
            made["emissiveTexture"] = emission_map[0]
        if texture("normal"):
            made["normalTexture"] = texture("normal")[0]
        if float(value("clearcoat", 0)) > 0:
            made["extensions"]["KHR_materials_clearcoat"] = {"clearcoatFactor": float(value("clearcoat", 0)),
                                                             "clearcoatRoughnessFactor": float(value("clearcoatRoughness", 0.01))}
        return self.glb.add("materials", made)

    def value(self, shader, key, otherwise):
        given = shader.GetInput(key)
        found = given.Get(self.time) if given else None
        return otherwise if found is None else found

    def texture(self, shader, key):
        """(texture info, channel) or None."""
        given = shader.GetInput(key)
        if not given or not given.HasConnectedSource():
            return None
        source, output, _ = given.GetConnectedSource()
        reader = UsdShade.Shader(source.GetPrim())
        if reader.GetIdAttr().Get() != "UsdUVTexture":
            self.glb.note("networks of shaders are left out, but for textures")
            return None
        asset = self.value(reader, "file", None)
        if not asset:
            return None
        wraps = {"repeat": 10497, "mirror": 33648, "clamp": 33071, "black": 33071, "useMetadata": 10497}
        sampler = {"wrapS": wraps.get(self.value(reader, "wrapS", "repeat"), 10497), "wrapT": wraps.get(self.value(reader, "wrapT", "repeat"), 10497)}
        made = {"source": self.image(asset), "sampler": self.same("samplers", sampler)}
        return {"index": self.same("textures", made)}, output

    def same(self, where, element):
        known = self.glb.json.get(where, [])
        return known.index(element) if element in known else self.glb.add(where, element)

    def image(self, asset):
        path = asset.resolvedPath or asset.path
        if path not in self.images:
            if "[" in path:  # within a package
                data = Ar.GetResolver().OpenAsset(Ar.ResolvedPath(path))
                image = {"bufferView": self.glb.view(bytes(data.GetBuffer())) , "mimeType": "image/png"} if data else {"uri": "missing"}
            else:
                image = {"uri": urllib.parse.quote(path)}
            self.images[path] = self.glb.add("images", image)
        return self.images[path]


class Meshes:
    def __init__(self, glb, materials, time):
        self.glb, self.materials, self.time, self.known = glb, materials, time, {}

    def get(self, prim):
        original = prim.GetPrimInPrototype() if prim.IsInstanceProxy() else prim
        key = original.GetPath()
        if key not in self.known:
            self.known[key] = self.make(prim)
        return self.known[key]

    def make(self, prim):
        mesh = UsdGeom.Mesh(prim)
        points = numpy.array(mesh.GetPointsAttr().Get(self.time) or [], dtype="f4").reshape(-1, 3)
        counts = numpy.array(mesh.GetFaceVertexCountsAttr().Get(self.time) or [], dtype="i8")
        corners = numpy.array(mesh.GetFaceVertexIndicesAttr().Get(self.time) or [], dtype="i8")
        if len(points) == 0 or counts.sum() != len(corners) or len(corners) == 0:
            return None
        if corners.min() < 0 or corners.max() >= len(points) or counts.min() < 0:
            raise ValueError(f"{prim.GetPath()}: its faces refer to points that are not there")
        scheme = mesh.GetSubdivisionSchemeAttr().Get()
        if scheme != "none" and not mesh.GetNormalsAttr().HasAuthoredValue():
            self.glb.note("subdivision surfaces are shown as their cages")
        faces, triangles = self.fans(counts)
        if mesh.GetOrientationAttr().Get() == "leftHanded":
            triangles = triangles[:, ::-1]
        each = {"uv": self.uvs(prim), "normal": self.normals(mesh), "color": self.colors(mesh)}
        by_corner = any(v is not None and v[1] == "faceVarying" for v in each.values()) or any(v is not None and v[1] == "uniform" for v in each.values())
        face_of_corner = numpy.repeat(numpy.arange(len(counts)), counts)
        attributes = {"POSITION": self.glb.vectors(points[corners] if by_corner else points)}
        for key, name in (("uv", "TEXCOORD_0"), ("normal", "NORMAL"), ("color", "COLOR_0")):
            if each[key] is None:
                continue
            values, how = each[key]
            if how == "constant":
                spread = numpy.repeat(values[:1], len(corners) if by_corner else len(points), axis=0)
            elif how == "uniform":
                spread = values[face_of_corner] if len(values) == len(counts) else None
            elif how == "faceVarying":
                spread = values if len(values) == len(corners) else None
            else:
                spread = (values[corners] if by_corner else values) if len(values) == len(points) else None
            if spread is None:
                self.glb.note(f"{name.lower()} that does not fit its mesh is left out")
            else:
                attributes[name] = self.glb.vectors(spread)
        whole = triangles if by_corner else corners[triangles]
        primitives, left = [], numpy.ones(len(counts), bool)
        for subset in UsdShade.MaterialBindingAPI(prim).GetMaterialBindSubsets():
            chosen = numpy.zeros(len(counts), bool)
            chosen[[i for i in subset.GetIndicesAttr().Get(self.time) if 0 <= i < len(counts)]] = True
            primitives.append((whole[chosen[faces]], self.materials.get(subset.GetPrim())))
            left &= ~chosen
        primitives.append((whole[left[faces]], self.materials.get(prim)))
        made = []
        for triangles_here, material in primitives:
            if len(triangles_here):
                one = {"attributes": attributes, "indices": self.glb.indices(triangles_here)}
                made.append(one if material is None else dict(one, material=material))
        return self.glb.add("meshes", {"name": prim.GetName(), "primitives": made}) if made else None

    @staticmethod
    def fans(counts):
        """The face of each triangle, and its corners' places in the list of corners."""
        starts = numpy.concatenate(([0], numpy.cumsum(counts)[:-1]))
        per = numpy.maximum(counts - 2, 0)
        faces = numpy.repeat(numpy.arange(len(counts)), per)
        within = numpy.arange(per.sum()) - numpy.repeat(numpy.cumsum(per) - per, per)
        first = starts[faces]
        return faces, numpy.stack((first, first + within + 1, first + within + 2), axis=1)

    def uvs(self, prim):
        for primvar in UsdGeom.PrimvarsAPI(prim).FindPrimvarsWithInheritance() if hasattr(UsdGeom.PrimvarsAPI, "FindPrimvarsWithInheritance") else []:
            if primvar.GetTypeName().role == "TextureCoordinate" or primvar.GetPrimvarName() in ("st", "uv", "UVMap", "map1"):
                values = primvar.ComputeFlattened(self.time)
                if values is not None and len(values) and len(values[0]) == 2:
                    uv = numpy.array(values, dtype="f4").reshape(-1, 2)
                    uv[:, 1] = 1 - uv[:, 1]
                    return uv, primvar.GetInterpolation()
        return None

    def normals(self, mesh):
        primvar = UsdGeom.PrimvarsAPI(mesh).GetPrimvar("normals")
        values = primvar.ComputeFlattened(self.time) if primvar and primvar.HasValue() else mesh.GetNormalsAttr().Get(self.time)
        how = primvar.GetInterpolation() if primvar and primvar.HasValue() else mesh.GetNormalsInterpolation()
        return (numpy.array(values, dtype="f4").reshape(-1, 3), how) if values is not None and len(values) else None

    def colors(self, mesh):
        if self.materials.get(mesh.GetPrim()) is not None:
            return None
        primvar = mesh.GetDisplayColorPrimvar()
        values = primvar.ComputeFlattened(self.time) if primvar and primvar.HasValue() else None
        return (numpy.array(values, dtype="f4").reshape(-1, 3), primvar.GetInterpolation()) if values is not None and len(values) else None


class Converter:
    def __init__(self, stage, seconds):
        self.stage, self.glb = stage, Glb()
        moves = stage.HasAuthoredTimeCodeRange()
        self.time = Usd.TimeCode(stage.GetStartTimeCode() + seconds * stage.GetTimeCodesPerSecond()) if moves else Usd.TimeCode.Default()
        self.places = UsdGeom.XformCache(self.time)
        self.materials = Materials(self.glb, self.time)
        self.meshes = Meshes(self.glb, self.materials, self.time)
        self.nodes, self.lights = [], []

    def run(self):
        for prim in Usd.PrimRange(self.stage.GetPseudoRoot(), Usd.TraverseInstanceProxies()):
            imageable = UsdGeom.Imageable(prim)
            if not imageable or imageable.ComputeVisibility(self.time) == "invisible" or imageable.ComputePurpose() in ("guide", "proxy"):
                continue
            self.convert(prim)
        scale = UsdGeom.GetStageMetersPerUnit(self.stage)
        root = {"children": self.nodes, "scale": [scale] * 3}
        if UsdGeom.GetStageUpAxis(self.stage) == "Z":
            root["rotation"] = [-math.sqrt(0.5), 0, 0, math.sqrt(0.5)]
        self.glb.json["scenes"] = [{"nodes": [self.glb.add("nodes", root)] if self.nodes else []}]
        if self.lights:
            self.glb.json["extensions"] = {"KHR_lights_punctual": {"lights": self.lights}}
        return self.glb

    def convert(self, prim):
        place = self.places.GetLocalToWorldTransform(prim)
        kind = prim.GetTypeName()
        if kind == "Mesh":
            mesh = self.meshes.get(prim)
            if mesh is not None:
                self.node(prim, place, mesh=mesh)
        elif kind == "PointInstancer":
            self.instances(prim, place)
        elif kind == "Camera":
            self.camera(prim, place)
        elif kind.endswith("Light"):
            self.light(prim, place, kind)
        elif prim.IsA(UsdGeom.Gprim):
            self.glb.note(f"objects of the type {kind} are left out")

    def node(self, prim, place, **what):
        matrix = [place[r][c] for r in range(4) for c in range(4)]  # USD's rows are glTF's columns
        self.nodes.append(self.glb.add("nodes", dict(what, name=prim.GetName(), matrix=matrix)))

    def instances(self, prim, place):
        instancer = UsdGeom.PointInstancer(prim)
        moved = instancer.ComputeInstanceTransformsAtTime(self.time, self.time) or []
        which = instancer.GetProtoIndicesAttr().Get(self.time) or []
        targets = instancer.GetPrototypesRel().GetTargets()
        for index, transform in zip(which, moved):
            prototype = self.stage.GetPrimAtPath(targets[index]) if 0 <= index < len(targets) else None
            for inner in Usd.PrimRange(prototype, Usd.TraverseInstanceProxies()) if prototype else []:
                mesh = self.meshes.get(inner) if inner.GetTypeName() == "Mesh" else None
                if mesh is not None:
                    own = self.places.GetLocalToWorldTransform(inner) * self.places.GetLocalToWorldTransform(prototype.GetParent()).GetInverse()
                    base = self.places.GetLocalToWorldTransform(prototype) * self.places.GetLocalToWorldTransform(prototype.GetParent()).GetInverse()
                    self.node(inner, own * base.GetInverse() * Gf.Matrix4d(transform) * place, mesh=mesh)

    def camera(self, prim, place):
        camera = UsdGeom.Camera(prim).GetCamera(self.time)
        aspect = camera.aspectRatio or 1
        if camera.projection == Gf.Camera.Perspective:
            fov = math.radians(camera.GetFieldOfView(Gf.Camera.FOVVertical))
            made = {"type": "perspective", "perspective": {"yfov": fov, "aspectRatio": aspect}}
        else:
            half = camera.horizontalAperture * Gf.Camera.APERTURE_UNIT / 2
            made = {"type": "orthographic", "orthographic": {"xmag": half, "ymag": half / aspect}}
        # What the file leaves at its defaults (1 and 1000000 units) is no choice of its makers: nothing is clipped then. glTF's
        # planes are not stretched with the camera, so they are in metres.
        if UsdGeom.Camera(prim).GetClippingRangeAttr().HasAuthoredValue():
            metres = UsdGeom.GetStageMetersPerUnit(self.stage)
            made[made["type"]].update(znear=max(camera.clippingRange.min, 0) * metres, zfar=camera.clippingRange.max * metres)
        self.node(prim, place, camera=self.glb.add("cameras", dict(made, name=prim.GetName())))

    def light(self, prim, place, kind):
        light = UsdLux.LightAPI(prim)
        strength = float(light.GetIntensityAttr().Get(self.time)) * 2 ** float(light.GetExposureAttr().Get(self.time))
        color = plain(light.GetColorAttr().Get(self.time))
        made = {"name": prim.GetName(), "color": color, "intensity": strength}
        if kind == "DistantLight":
            made["type"] = "directional"
        elif kind == "SphereLight":
            # Its intensity towards any side is its radiance times the area of its disc.
            radius = float(UsdLux.SphereLight(prim).GetRadiusAttr().Get(self.time)) * UsdGeom.GetStageMetersPerUnit(self.stage)
            made.update(type="point", intensity=strength * math.pi * radius * radius)
            self.glb.note("lights that are spheres are points")
        else:
            self.glb.note(f"lights of the type {kind} are left out")
            return
        self.lights.append(made)
        self.node(prim, place, extensions={"KHR_lights_punctual": {"light": len(self.lights) - 1}})


def main():
    path = sys.argv[1]
    size = os.path.getsize(path)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_AS, ((4 << 30) + 64 * size, resource.RLIM_INFINITY))
    resource.setrlimit(resource.RLIMIT_CPU, (120 + (size >> 20), resource.RLIM_INFINITY))
    stage = Usd.Stage.Open(path)
    glb = Converter(stage, float(sys.argv[2]) if len(sys.argv) > 2 else 0).run()
    glb.write(sys.stdout.buffer)


if __name__ == "__main__":
    try:
        main()
    except MemoryError:
        sys.exit("it needs more memory than a file of its size may")
    except Exception as error:  # whatever the library finds wrong
        sys.exit(str(error).strip().splitlines()[-1][:400] if str(error).strip() else type(error).__name__)
