"""UsdPreviewSurface (Pixar, "UsdPreviewSurface Specification") as materials of a .glb: numbers in glTF's words, textures in ours."""
import os
import urllib.parse

from pxr import Ar, Usd, UsdShade

import etendue_usd_materialx as materialx
import etendue_usd_values as values

WRAPS = {"repeat": "repeat", "mirror": "mirror", "clamp": "clamp", "black": "black", "useMetadata": "repeat"}
CHANNELS = {"r": "R", "g": "G", "b": "B", "a": "A"}
SPREAD = 0.25  # above this reflectance, with little scattered light, what has a specular colour is metal


class Materials:
    def __init__(self, glb, files, time):
        self.glb, self.files, self.time = glb, files, time
        self.known, self.images, self.uv_sets = {}, {}, {"st": 0}
        self.uses = {}  # of a material's place: the names of surface coordinates, and whether vertices' colours count

    def bound(self, prim):
        """The place of the material of a prim, or None."""
        material = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial(UsdShade.Tokens.full)[0]
        if not material:
            return None
        prim = material.GetPrim()
        path = (prim.GetPrimInPrototype() if prim.IsInstanceProxy() else prim).GetPath()
        if path not in self.known:
            self.reading = {"st"}
            self.by_vertex = False
            place = self.make(material)
            self.known[path] = place
            self.uses[place] = (self.reading, self.by_vertex)
        return self.known[path]

    def plain(self, opaque):
        """What has no material: displayColor, or a grey."""
        made = {"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.5}}
        if not opaque:
            made["alphaMode"] = "BLEND"
        return self.glb.same("materials", made)

    def make(self, material):
        surface = material.ComputeSurfaceSource()[0]
        name = material.GetPrim().GetName()
        source = materialx.source_of(material, self.files.path, self.glb.note)
        if source and materialx.installed():
            names = materialx.coordinates_of(material)
            self.reading.update(names)
            source["uv_set"] = self.uv_sets.setdefault(names[0], len(self.uv_sets))
            if len(names) > 1:
                self.glb.note("a material of MaterialX that reads several surface coordinates has those that its mesh keeps by their names, or the first")
            return self.glb.add("materials", {"name": name, "extensions": {"ETENDUE_materialx": source}})
        if source:
            self.glb.note("materials of MaterialX are read by the Python package materialx, which is not installed (pip install materialx): they are "
                          "their UsdPreviewSurface, or grey")
        for other in ("displacement", "volume"):
            if getattr(material, f"Compute{other.capitalize()}Source")()[0]:
                self.glb.note(f"the {other} of materials is left out")
        if not surface or surface.GetIdAttr().Get() != "UsdPreviewSurface":
            self.glb.note("of materials UsdPreviewSurface is read; others are grey")
            return self.glb.add("materials", {"name": name, "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0,
                                                                                     "roughnessFactor": 0.5}})
        own = {"base_color": self.color(surface, "diffuseColor", (0.18, 0.18, 0.18)),
               "roughness": self.number(surface, "roughness", 0.5),
               "emission": self.color(surface, "emissiveColor", (0, 0, 0)),
               "coat": self.number(surface, "clearcoat", 0), "coat_roughness": self.number(surface, "clearcoatRoughness", 0.01)}
        made = {"name": name, "extensions": {"ETENDUE_surface": own}, "doubleSided": False}
        ior = self.scalar(surface, "ior", 1.5)
        if self.scalar(surface, "useSpecularWorkflow", 0) == 1:
            ior = self.specular(surface, own, ior)
        else:
            own["metalness"] = self.number(surface, "metallic", 0)
        made["extensions"]["KHR_materials_ior"] = {"ior": ior if ior > 0 else 1.5}
        opacity, threshold = self.number(surface, "opacity", 1), self.scalar(surface, "opacityThreshold", 0)
        if opacity["value"] < 1 or "texture" in opacity:
            own["opacity"] = opacity
            made["alphaMode"] = "MASK" if threshold > 0 else "BLEND"
            if threshold > 0:
                made["alphaCutoff"] = threshold
            elif self.word(surface, "opacityMode", "transparent") == "transparent" and "texture" not in opacity:
                self.glb.note("surfaces of an opacity below 1 let light through as holes do: what they reflect becomes less too")
        normals = self.texture(surface, "normal")
        if normals:
            own["normals"] = self.normals(normals)
        displacement = surface.GetInput("displacement")
        if displacement and (displacement.HasConnectedSource() or self.scalar(surface, "displacement", 0) != 0):
            self.glb.note("the displacement of materials is left out")
        return self.glb.add("materials", made)

    def specular(self, surface, own, ior):
        """The workflow of a specular colour: that reflects at normal incidence, all at grazing."""
        color = self.color(surface, "specularColor", (0, 0, 0))
        strongest = max(color["value"])
        own["metalness"] = {"value": 0}
        if "texture" in color:
            self.glb.note("textures of specularColor are left out: what is reflected follows from the index of refraction")
            return ior
        if strongest > SPREAD and max(own["base_color"]["value"]) < 0.1:
            own["metalness"], own["base_color"] = {"value": 1}, color
            return ior
        root = min(strongest, 0.36) ** 0.5
        if strongest > 0:
            own["specular_color"] = {"value": [x / strongest for x in color["value"]]}
        if strongest > 0.36:
            self.glb.note("a reflectance above 0.36 of what is no metal becomes 0.36")
        return max((1 + root) / (1 - root), 1.0001)

    def normals(self, texture):
        scale, bias = texture.pop("scale4"), texture.pop("bias4")
        found = {"texture": texture["texture"], "downwards": scale[1] < 0}
        if texture["texture"].get("transfer") == "auto":
            texture["texture"]["transfer"] = "linear"
        usual = all(abs(abs(s) - 2) < 1e-3 and abs(abs(b) - 1) < 1e-3 for s, b in zip(scale[:3], bias[:3]))
        if not usual and scale[:3] != [1, 1, 1]:
            self.glb.note("an image of normals has no scale of 2 and bias of -1: it is read as if it had")
        return found

    # ---- inputs ------------------------------------------------------------------------------------------------------------

    def value(self, shader, key, otherwise):
        """Of an input, or of what is connected to it when that is no shader."""
        given = shader.GetInput(key)
        if not given:
            return otherwise
        for attribute in given.GetValueProducingAttributes():
            if UsdShade.Utils.GetType(attribute.GetName()) == UsdShade.AttributeType.Input:
                found = attribute.Get(self.time)
                return otherwise if found is None else found
        return otherwise

    def scalar(self, shader, key, otherwise):
        return values.number(self.value(shader, key, None), otherwise, f"'{key}' of {shader.GetPath()}", self.glb.note)

    def vector(self, shader, key, otherwise):
        return values.vector(self.value(shader, key, None), otherwise, f"'{key}' of {shader.GetPath()}", self.glb.note)

    def word(self, shader, key, otherwise):
        return values.word(self.value(shader, key, None), otherwise, f"'{key}' of {shader.GetPath()}", self.glb.note)

    def color(self, shader, key, otherwise):
        found = self.texture(shader, key, colored=True)
        if not found:
            return {"value": self.vector(shader, key, otherwise)}
        if "primvar" in found:
            self.by_vertex = True
            return {"value": [1, 1, 1]}
        if found["channel"] != "rgb":
            found["texture"] = dict(found["texture"])
            self.glb.note("one channel of an image as a colour: all its colours are used")
        return {"value": found["scale4"][:3], "offset": found["bias4"][:3], "texture": found["texture"], "without": found["without"][:3]}

    def number(self, shader, key, otherwise):
        found = self.texture(shader, key)
        if not found:
            return {"value": self.scalar(shader, key, otherwise)}
        which = "rgba".find(found["channel"]) if len(found["channel"]) == 1 else 0
        return {"value": found["scale4"][which], "offset": found["bias4"][which], "texture": found["texture"],
                "channel": CHANNELS.get(found["channel"], ""), "without": found["without"][which]}

    def texture(self, shader, key, colored=False):
        given = shader.GetInput(key)
        if not given or not given.HasConnectedSource():
            return None
        for attribute in given.GetValueProducingAttributes():
            if UsdShade.Utils.GetType(attribute.GetName()) != UsdShade.AttributeType.Output:
                return None  # a number given to the material
            reader, output = UsdShade.Shader(attribute.GetPrim()), UsdShade.Output(attribute).GetBaseName()
            kind = reader.GetIdAttr().Get()
            if kind == "UsdUVTexture":
                return self.image_texture(reader, output)
            if colored and str(kind).startswith("UsdPrimvarReader_float3") and self.word(reader, "varname", "") == "displayColor":
                return {"primvar": "displayColor"}
            self.glb.note(f"shaders of the kind {str(kind)[:60]} in '{key}' are left out")
        return None

    def image_texture(self, reader, output):
        asset = values.asset(self.value(reader, "file", None), f"'file' of {reader.GetPath()}", self.glb.note)
        scale, bias = self.vector(reader, "scale", (1, 1, 1, 1)), self.vector(reader, "bias", (0, 0, 0, 0))
        fallback = self.vector(reader, "fallback", (0, 0, 0, 1))
        without = fallback
        if not asset or not asset.path:
            self.glb.note("a UsdUVTexture without a file has its fallback's colour")
            return {"texture": {"image": self.missing()}, "channel": output, "scale4": scale, "bias4": bias, "without": without}
        space = {"raw": "linear", "sRGB": "srgb"}.get(self.word(reader, "sourceColorSpace", "auto"), "auto")
        texture = {"image": self.image(asset, reader.GetInput("file").GetAttr()), "transfer": space,
                   "wrap": [WRAPS.get(self.word(reader, key, "useMetadata"), "repeat") for key in ("wrapS", "wrapT")]}
        if output == "a":
            texture["transfer"] = "linear"
        self.coordinates(reader, texture)
        return {"texture": texture, "channel": output, "scale4": scale, "bias4": bias, "without": without}

    def coordinates(self, reader, texture):
        """What is connected to 'st': a UsdPrimvarReader_float2, or a UsdTransform2d of one."""
        shader, key = reader, "st"
        for _ in range(2):
            given = shader.GetInput(key)
            sources = [a for a in given.GetValueProducingAttributes()] if given and given.HasConnectedSource() else []
            shader = UsdShade.Shader(sources[0].GetPrim()) if sources else None
            kind = str(shader.GetIdAttr().Get()) if shader else ""
            if kind == "UsdTransform2d" and key == "st":
                texture["scale"] = self.vector(shader, "scale", (1, 1))
                texture["shift"] = self.vector(shader, "translation", (0, 0))
                texture["angle"] = self.scalar(shader, "rotation", 0) * 3.141592653589793 / 180
                if 0 in texture["scale"]:
                    self.glb.note("a texture that is scaled to nothing is laid as it is")
                    texture["scale"] = [1, 1]
                key = "in"
                continue
            if kind == "UsdPrimvarReader_float2":
                name = self.word(shader, "varname", "") or "st"
                self.reading.add(name)
                texture["uv_set"] = self.uv_sets.setdefault(name, len(self.uv_sets))
            elif kind:
                self.glb.note(f"surface coordinates of the kind {kind[:60]} are left out")
            return

    # ---- images ------------------------------------------------------------------------------------------------------------

    def missing(self):
        return self.glb.same("images", {"uri": "a-texture-without-a-file"})

    def gather(self, stage):
        """All images of a stage, in the order of its prims: their numbers are the same at any time."""
        found = {}
        for root in [stage.GetPseudoRoot(), *stage.GetPrototypes()]:
            for prim in Usd.PrimRange.AllPrims(root):
                attribute = prim.GetAttribute("inputs:file") if prim.GetTypeName() == "Shader" else None
                value = attribute.Get(self.time) if attribute else None
                value = values.asset(value, f"'file' of {prim.GetPath()}", self.glb.note) if value is not None else None
                if value and value.path:
                    found[value.resolvedPath or value.path] = value, attribute
        for path in sorted(found):
            self.image(*found[path])

    @staticmethod
    def path_of(asset, attribute):
        """Where a file is; of one with <UDIM> in its name, which stands for several, that name with its folder."""
        if "<UDIM>" in asset.path and attribute:
            for given in attribute.GetPropertyStack(Usd.TimeCode.Default()):
                path = UsdShade.UdimUtils.ResolveUdimPath(asset.path, given.layer)
                if path:
                    return path
        return asset.resolvedPath or asset.path

    def image(self, asset, attribute=None):
        path = self.path_of(asset, attribute)
        if path not in self.images:
            if Ar.IsPackageRelativePath(path) and "<UDIM>" in path:
                self.glb.note("images in several files (<UDIM>) within a package are left out")
                image = {"uri": "missing"}
            elif Ar.IsPackageRelativePath(path):
                self.files.require(path, asset.path)
                data = Ar.GetResolver().OpenAsset(Ar.ResolvedPath(path))
                if not data:
                    self.glb.note(f"there is no file '{asset.path}'")
                image = {"bufferView": self.glb.view(bytes(data.GetBuffer())), "mimeType": "image/png"} if data else {"uri": "missing"}
                ending = os.path.splitext(Ar.SplitPackageRelativePathInner(path)[1])[1].lower()
                if ending == ".tga":
                    image["mimeType"] = "image/x-tga"
            else:
                image = {"uri": urllib.parse.quote(path)}
            self.images[path] = self.glb.add("images", image)
        return self.images[path]
