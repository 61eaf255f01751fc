"""UsdLux' lights as luminaires, with the quantities that its documentation states: intensity 1 is a luminance of 1 cd/m^2."""
import math

import numpy
from pxr import Ar, Gf, UsdGeom, UsdLux

from etendue_usd_glb import plain
from etendue_usd_values import metres_per_unit, of_kind

TURN_UP = Gf.Matrix4d().SetRotate(Gf.Rotation(Gf.Vec3d(1, 0, 0), 90))  # +y to +z, +z to -y


class Lights:
    def __init__(self, glb, materials, time, stage):
        self.glb, self.materials, self.time, self.stage = glb, materials, time, stage
        self.metres = metres_per_unit(stage)

    def get(self, prim, place):
        """(ETENDUE_part, place) of a light, or None."""
        self.prim, kind = prim, prim.GetTypeName()
        make = {"DistantLight": self.distant, "SphereLight": self.sphere, "RectLight": self.rectangle, "DiskLight": self.disc,
                "CylinderLight": self.cylinder, "DomeLight": self.dome, "DomeLight_1": self.dome}.get(kind)
        if make is None:
            self.glb.note(f"lights of the type {kind} are left out")
            return None
        self.note_the_rest()
        light = UsdLux.LightAPI(prim)
        color = plain(self.value("color", (1, 1, 1)))
        if self.value("enableColorTemperature", False):
            color = [c * t for c, t in zip(color, UsdLux.BlackbodyTemperatureAsRgb(self.value("colorTemperature", 6500)))]
        # Of what types have their own default for, the schema's is asked.
        default = light.GetIntensityAttr().Get(self.time) if light and not self.old("intensity") else 1
        strength = default if isinstance(default, float) else self.value("intensity", 1)
        strength *= 2 ** min(self.value("exposure", 0), 200)
        self.color = [max(0.0, c * strength) for c in plain(color)]
        return make(place)

    # ---- attributes ----------------------------------------------------------------------------------------------------------

    def old(self, name):
        """Whether it is written as before 2021, without 'inputs:'."""
        attribute = self.prim.GetAttribute(name)
        return attribute and attribute.HasAuthoredValue() and not self.prim.GetAttribute("inputs:" + name).HasAuthoredValue()

    def value(self, name, otherwise):
        attribute = self.prim.GetAttribute(name if self.old(name) else "inputs:" + name)
        found = attribute.Get(self.time) if attribute else None
        return of_kind(found, otherwise, f"'{name}' of {self.prim.GetPath()}", self.glb.note)

    def note_the_rest(self):
        for name in ("diffuse", "specular"):
            if self.value(name, 1) != 1:
                self.glb.note(f"'{name}' of lights, which strengthens one kind of reflection, is left out")
        if not self.value("shadow:enable", True) or tuple(self.value("shadow:color", (0, 0, 0))) != (0, 0, 0):
            self.glb.note("lights cast shadows, and black ones, as light does")
        light = UsdLux.LightAPI(self.prim)
        if light:
            if light.GetFiltersRel().HasAuthoredTargets():
                self.glb.note("filters of lights are left out")
            for collection in (light.GetLightLinkCollectionAPI(), light.GetShadowLinkCollectionAPI()):
                if collection and (collection.GetExcludesRel().HasAuthoredTargets() or collection.GetIncludeRootAttr().Get() is False):
                    self.glb.note("lights light everything, whatever they are linked to")

    def radiance(self, texture=None):
        found = {"value": self.color}
        if texture:
            found["texture"] = texture
        return {"color": found}

    def texture(self):
        asset = self.value("texture:file", None)
        if not asset or not asset.path:
            return None
        return self.materials.image(asset)

    def emission(self, texture=None):
        """What leaves a surface or a point, shaped as ShapingAPI says about -z."""
        names = ("shaping:cone:angle", "shaping:cone:softness", "shaping:focus", "shaping:focusTint")
        shaped = self.prim.HasAPI(UsdLux.ShapingAPI) or any(
            self.prim.GetAttribute(prefix + n).HasAuthoredValue() for n in names for prefix in ("", "inputs:"))
        measured = self.profile(texture) if max(self.color) > 0 else None
        if measured:
            return measured
        members = {"radiance": self.radiance(texture)}
        angle = min(max(self.value("shaping:cone:angle", 90), 0), 180) if shaped else 180
        soft = min(max(self.value("shaping:cone:softness", 0), 0), 1)
        focus = max(self.value("shaping:focus", 0), 0)
        tint = tuple(self.value("shaping:focusTint", (0, 0, 0)))
        flat = self.prim.GetTypeName() in ("RectLight", "DiskLight")
        if focus > 0 and shaped and tint != (1, 1, 1):
            if tint == (0, 0, 0) and (angle >= 90 or flat and angle == 90):
                if not flat and angle > 90:
                    self.glb.note("what 'shaping:focus' lets go backwards is left out")
                return {"class": "CosineLobeEmission", "members": dict(members, exponent=focus, about="axis", axis=[0, 0, -1])}
            self.glb.note("'shaping:focus' with a tint or a narrow cone is left out")
        if not shaped or angle >= 180 or (flat and angle >= 90 and soft == 0):
            return {"class": "DiffuseEmission", "members": members}
        if soft > 0:
            members["edge"] = "smooth_angle"
        members.update(axis=[0, 0, -1], inner_angle={"angle": math.radians(angle * (1 - soft))},
                       outer_angle={"angle": math.radians(max(angle, 0.01))})
        return {"class": "ForeignSpotEmission" if soft > 0 else "SpotEmission", "members": members}

    def profile(self, texture):
        """The IesEmission of 'shaping:ies:file', or None. The file's candelas multiply the luminance towards each direction."""
        asset = self.value("shaping:ies:file", None)
        if not asset or not asset.path:
            return None
        path = asset.resolvedPath
        if not path or Ar.IsPackageRelativePath(path):
            self.glb.note(f"the IES file '{asset.path}' is " + ("not read within a package" if path else "not there") + ": it is left out")
            return None
        self.materials.files.require(path, asset.path)
        if texture:
            self.glb.note("the texture of a light with an IES file is left out")
        if self.value("shaping:ies:angleScale", 0) != 0:
            self.glb.note("'shaping:ies:angleScale' is left out")
        flat = self.prim.GetTypeName() in ("RectLight", "DiskLight")
        if (self.value("shaping:cone:angle", 90) < (90 if flat else 180) or self.value("shaping:cone:softness", 0) > 0
                or self.value("shaping:focus", 0) > 0):
            self.glb.note("the cone and the focus of a light with an IES file are left out")
        # As IesEmission divides by the luminance of its colour [cd/m^2], of which 1 is a pixel of 1 by the observer's integral.
        luminance = sum(c * y for c, y in zip(self.color, (0.2126729, 0.7151522, 0.072175))) * 683.002 * 106.856917
        return {"class": "IesEmission", "members": {
            "file": {"path": path}, "color": self.radiance(), "multiplier": luminance, "about": "axis",
            "normalized": bool(self.value("shaping:ies:normalize", False)), "axis": [0, 0, -1], "across": [1, 0, 0]}}

    def normalize(self, area):
        """Divides by the size, in the units of the stage's world."""
        area = float(area)
        if self.value("normalize", False) and area > 0:
            self.color = [c / area for c in self.color]

    # ---- kinds ---------------------------------------------------------------------------------------------------------------

    def part(self, name, members, place, **more):
        return dict({"class": name, "members": members, "lamp": bool(max(self.color) > 0)}, **more), place

    @staticmethod
    def stretch(place, *vectors):
        return [numpy.array(place.TransformDir(Gf.Vec3d(*v))) for v in vectors]

    def rectangle(self, place):
        w, h = (max(self.value(name, 1), 0) for name in ("width", "height"))
        x, y = self.stretch(place, (1, 0, 0), (0, 1, 0))
        self.normalize(w * h * numpy.linalg.norm(numpy.cross(x, y)))
        if w * h == 0:
            return self.nothing()
        image = self.texture()
        # It faces -z; the image's upper left corner lies at (+x, +y).
        members = {"corner": [w / 2, -h / 2, 0], "edge_u": [-w, 0, 0], "edge_v": [0, h, 0],
                   "emission": self.emission({"image": image, "wrap": ["clamp", "clamp"]} if image is not None else None)}
        return self.part("Rectangle", members, place)

    def disc(self, place):
        r = max(self.value("radius", 0.5), 0)
        x, y = self.stretch(place, (1, 0, 0), (0, 1, 0))
        self.normalize(math.pi * r * r * numpy.linalg.norm(numpy.cross(x, y)))
        if r == 0:
            return self.nothing()
        turned = Gf.Matrix4d(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1)  # half a turn about y: +z of Disc to -z
        emission = self.emission()
        if "axis" in emission["members"]:
            emission["members"]["axis"] = [0, 0, 1]
        if "across" in emission["members"]:
            emission["members"]["across"] = [-1, 0, 0]
        return self.part("Disc", {"radius": r, "emission": emission}, turned * place)

    def cylinder(self, place):
        r, length = max(self.value("radius", 0.5), 0), max(self.value("length", 1), 0)
        if self.value("treatAsLine", False):
            self.glb.note("lights that are treated as lines have their radius")
        around = numpy.arange(64) * (2 * math.pi / 64)
        x, y, z = self.stretch(place, (1, 0, 0), (0, 1, 0), (0, 0, 1))
        sides = [numpy.linalg.norm(numpy.cross(x, math.cos(a) * z - math.sin(a) * y)) for a in around]
        self.normalize(2 * math.pi * r * length * float(numpy.mean(sides)))
        if r * length == 0:
            return self.nothing()
        turned = Gf.Matrix4d(0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0, 1)  # its z along x
        emission = self.emission()
        if "axis" in emission["members"]:
            emission["members"]["axis"] = [0, -1, 0]  # -z of the light
        if "across" in emission["members"]:
            emission["members"]["across"] = [0, 0, 1]
        return self.part("Cylinder", {"radius": r, "height": length, "caps": False, "emission": emission}, turned * place)

    def sphere(self, place):
        r = max(self.value("radius", 0.5), 0)
        x, y, z = self.stretch(place, (1, 0, 0), (0, 1, 0), (0, 0, 1))
        # The area of an ellipsoid: the mean over a sphere's directions n of the stretched |e_u x e_v|, with u and v across n.
        heights, weights = numpy.polynomial.legendre.leggauss(32)
        angles = numpy.arange(64) * (2 * math.pi / 64)
        c, a = numpy.meshgrid(heights, angles, indexing="ij")
        n = numpy.stack((numpy.sqrt(1 - c * c) * numpy.cos(a), numpy.sqrt(1 - c * c) * numpy.sin(a), c), axis=-1)
        cofactors = numpy.stack((numpy.cross(y, z), numpy.cross(z, x), numpy.cross(x, y)))
        mean = float((numpy.linalg.norm(n @ cofactors, axis=-1).mean(axis=1) * weights).sum() / 2)
        if self.value("treatAsPoint", False) or r == 0:
            # Its intensity towards any side is its radiance times the area of its disc [m^2]; of a point without a size that is
            # there only when it is normalized.
            if self.value("normalize", False):
                self.color = [k / 4 * self.metres ** 2 for k in self.color]
            else:
                self.color = [k * math.pi * float(mean) * (r * self.metres) ** 2 for k in self.color]
                if r == 0:
                    return self.nothing()
            return self.part("Point", {"emission": self.emission()}, place, rigid=True)
        self.normalize(4 * math.pi * r * r * mean)
        return self.part("Sphere", {"radius": r, "emission": self.emission()}, place)

    def note_profile(self):
        asset = self.value("shaping:ies:file", None)
        if asset and asset.path:
            self.glb.note("IES files of lights at infinity are left out")

    def distant(self, place):
        self.note_profile()
        half = min(max(math.radians(self.value("angle", 0.53)) / 2, 0), math.pi)
        size = 1 if half == 0 else math.pi * (math.sin(half) ** 2 if half <= math.pi / 2 else 2 - math.sin(half) ** 2)
        self.normalize(size)
        if half == 0:
            members = {"direction": [0, 0, -1], "emission": {"class": "DiffuseEmission", "members": {"radiance": self.radiance()}}}
            return self.part("Distant", members, place, rigid=True)
        angle = {"angle": half}
        emission = {"class": "SpotEmission", "members": {"radiance": self.radiance(), "axis": [0, 0, -1], "inner_angle": angle,
                                                         "outer_angle": angle}}
        return self.part("Environment", {"emission": emission}, place, rigid=True)

    def dome(self, place):
        self.note_profile()
        if self.prim.GetTypeName() == "DomeLight_1":
            axis = str(self.prim.GetAttribute("poleAxis").Get() or "scene")
            if axis == "Z" or (axis == "scene" and UsdGeom.GetStageUpAxis(self.stage) == "Z"):
                place = TURN_UP * place
        if self.prim.GetRelationship("portals").HasAuthoredTargets():
            self.glb.note("portals of domes are left out: they only guide rays")
        layout = self.value("texture:format", "automatic")
        image = self.texture()
        if image is not None and layout not in ("automatic", "latlong"):
            self.glb.note(f"textures of domes of the format {layout[:40]} are left out")
            image = None
        # An image in longitude and latitude lies here as there: its middle towards +z, its left half towards +x.
        if image is not None and len(set(self.color)) == 1:
            emission = {"file": {"image": image}, "scale": self.color[0]}
        else:
            emission = {"radiance": self.radiance({"image": image, "wrap": ["repeat", "repeat"]} if image is not None else None)}
        return self.part("Environment", {"emission": {"class": "EnvironmentEmission", "members": emission}}, place, rigid=True)

    def nothing(self):
        self.glb.note("lights without a size, which give no light, are left out")
        return None
