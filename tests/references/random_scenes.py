"""Random small scenes of Mitsuba 3, each of a seed: what its importer claims to know, in combinations that nobody thought of.

A scene is of one of three sorts, because Mitsuba's `blendbsdf` and `mask` tell of a sample the density of the part that was taken, and
not of the whole, which makes pictures whose lights are found in two ways wrong by some percent:

- `even`: lights that are found in both ways (area, constant, envmap); blends and masks of 0 and 1 alone;
- `points`: lights that only a connection finds (point, spot, directional, projector);
- `scattered`: `direct` without samples of emitters, so that all light is found by scattering.

Left out is what docs/coming-from-mitsuba.md tells of: `spec_tint` and `sheen_tint`, metals by name (from other sources), thin panes (whose polarizations Mitsuba averages), neighbouring texels of an environment that differ much; and
`directionalarea`, whose light no path finds.
"""

import math
import struct
import xml.etree.ElementTree as ET

from random_surfaces import SurfaceMaker, element, number, truth, value, word


CLOSED = ["sphere", "cube", "obj", "ply"]


def translation(place):
    return element("translate", x=place[0], y=place[1], z=place[2])


def whole(name, what):
    return value("integer", name, what)


def radiance_picture(rows):
    """Rows of (r, g, b) as a picture in Ward's format of shared exponents, not compressed."""
    def pixel(colour):
        mantissa, exponent = math.frexp(max(colour))
        scale = mantissa * 256 / max(colour)
        return bytes([int(c * scale) for c in colour] + [exponent + 128])

    head = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {len(rows)} +X {len(rows[0])}\n"
    return head.encode() + b"".join(pixel(p) for row in rows for p in row)


class SceneMaker(SurfaceMaker):
    def __init__(self, seed):
        super().__init__(seed)
        self.sort = self.r.choice(["even", "even", "points", "scattered"])
        self.media = self.sort != "scattered" and self.chance(0.35)
        self.integrator = "direct" if self.sort == "scattered" else self.r.choice(["volpath", "volpathmis"]) if self.media else self.r.choice(
            ["path", "path", "volpath", "direct"])
        self.around = None  # the medium that the camera stands in

    # Shapes.

    def mesh_data(self):
        """A bumpy ball of few triangles: places, coordinates of textures, triangles."""
        across, down = self.r.choice([5, 8]), self.r.choice([3, 5])
        points, uvs, triangles = [], [], []
        for j in range(down + 1):
            for i in range(across + 1):
                phi, theta = 2 * math.pi * (i % across) / across, math.pi * j / down
                bump = 1 + 0.2 * math.sin(theta) * math.sin(3 * phi + 2 * theta)
                points.append((bump * math.sin(theta) * math.cos(phi), bump * math.cos(theta), bump * math.sin(theta) * math.sin(phi)))
                uvs.append((i / across, 1 - j / down))
        for j in range(down):
            for i in range(across):
                a, b = j * (across + 1) + i, (j + 1) * (across + 1) + i
                triangles += [(a, a + 1, b)] * (j > 0) + [(a + 1, b + 1, b)] * (j < down - 1)
        return points, uvs, triangles

    def obj(self):
        points, uvs, triangles = self.mesh_data()
        normals = self.chance(0.5)
        lines = ["v %.5f %.5f %.5f" % p for p in points] + ["vt %.5f %.5f" % p for p in uvs]
        if normals:
            lines += ["vn %.5f %.5f %.5f" % p for p in points]
        lines += ["f " + " ".join(f"{i + 1}/{i + 1}" + (f"/{i + 1}" if normals else "") for i in t) for t in triangles]
        return element("shape", self.file(".obj", "\n".join(lines) + "\n"), self.maybe(0.4, truth, "face_normals", True), type="obj")

    def ply(self):
        points, uvs, triangles = self.mesh_data()
        normals, of_vertices, of_faces = self.chance(0.5), self.chance(0.5), self.chance(0.5)
        self.attributes = self.r.choice((["vertex_color"] if of_vertices else []) + (["face_color"] if of_faces else []) or [""])

        def names(wanted, which):
            return "".join(f"property float {n}\n" for n in which.split()) if wanted else ""

        def colour(wanted):
            return tuple(self.between(0.2, 0.8) for _ in range(3)) if wanted else ()

        head = (f"ply\nformat ascii 1.0\nelement vertex {len(points)}\n" + names(True, "x y z") + names(normals, "nx ny nz") + names(True, "u v") +
                names(of_vertices, "color_0 color_1 color_2") + f"element face {len(triangles)}\nproperty list uchar int vertex_indices\n" +
                names(of_faces, "color_0 color_1 color_2") + "end_header\n")
        rows = [p + (p if normals else ()) + uv + colour(of_vertices) for p, uv in zip(points, uvs)]
        rows += [(3, *t) + colour(of_faces) for t in triangles]
        body = "".join(" ".join(f"{x:.5g}" for x in row) + "\n" for row in rows)
        return element("shape", self.file(".ply", head + body), self.maybe(0.4, truth, "face_normals", True), type="ply")

    def geometry(self, closed=False):
        kinds = CLOSED if closed else [*CLOSED, "rectangle", "disk", "cylinder"]
        kind = self.r.choice(kinds)
        self.attributes = ""
        if kind in ("obj", "ply"):
            return self.obj() if kind == "obj" else self.ply()
        shape = element("shape", type=kind)
        if kind == "sphere" and self.chance(0.4):
            shape.extend([value("point", "center", [self.between(-0.3, 0.3) for _ in range(3)]), self.flat("radius", 0.6, 1.2)])
        if kind == "cylinder" and self.chance(0.5):
            shape.extend([value("point", "p0", [self.between(-0.5, 0.5), -1.0, 0.1]), value("point", "p1", [0.2, self.between(0.3, 1), -0.1]),
                          self.flat("radius", 0.3, 0.9)])
        return shape

    def placed(self, kind, place, size):
        """A sphere is scaled alike in all directions, and a cylinder across: Mitsuba takes no other."""
        s = [self.between(0.6, 1.2) * size * self.r.choice([1, 1, 1, -1]) for _ in range(3)]
        if kind == "sphere":
            s = [s[0], abs(s[0]), abs(s[0])]
        elif kind == "cylinder":
            s[1] = s[0]
        steps = [element("scale", x=s[0], y=s[1], z=s[2])]
        for _ in range(self.r.randint(0, 2)):
            axis = [self.r.uniform(-1, 1) for _ in range(3)]
            length = math.hypot(*axis)  # at another than 1 it shears, and a sheared square of 0.5 shows Mitsuba's light as 0.507
            steps.append(element("rotate", angle=self.between(-180, 180), **{name: round(a / length, 6) for name, a in zip("xyz", axis)}))
        return element("transform", *steps, translation(place), name="to_world")

    def shape(self, place, size, closed=False):
        shape = self.geometry(closed)
        shape.append(self.placed(shape.get("type"), place, size))
        if self.chance(0.2):
            shape.append(truth("flip_normals", True))
        return shape

    def place(self):
        return [self.between(-1.1, 1.1), self.between(-0.5, 0.9), self.between(-1, 1)]

    def thing(self):
        if self.media and self.chance(0.5):
            return self.body(self.place(), 0.6)
        shape = self.shape(self.place(), self.r.uniform(0.35, 0.7))
        surface = self.surface(shape.get("type") in CLOSED)
        if shape.find("boolean[@name='flip_normals']") is not None and "dielectric" in ET.tostring(surface, "unicode"):
            shape.remove(shape.find("boolean[@name='flip_normals']"))  # it is told that its index stays inside
        shape.append(surface)
        return shape

    def group(self, number_of):
        name = f"group{number_of}"
        members = []
        for _ in range(self.r.randint(1, 2)):
            place = [self.between(-0.5, 0.5) for _ in range(3)]
            members.append(self.body(place, 0.4) if self.media and self.chance(0.4) else self.shape(place, 0.4))
            if members[-1].find("bsdf") is None:
                members[-1].append(self.surface(members[-1].get("type") in CLOSED))
        instances = []
        for _ in range(self.r.randint(1, 2)):
            instances.append(element("shape", element("ref", id=name), self.placed("cube", self.place(), 1), type="instance"))
        return [element("shape", *members, type="shapegroup", id=name), *instances]

    # Media.

    def medium(self, name, density):
        phase = self.maybe(0.6, lambda: self.one(lambda: element("phase", self.flat("g", -0.6, 0.7), type="hg"),
                                                 lambda: element("phase", type="isotropic")))
        scale = self.between(0.5, 2)
        return element("medium", self.spectrum("albedo", 0.4, 0.95), number("sigma_t", density / scale), number("scale", scale), phase,
                       type="homogeneous", name=name)

    def grid(self, name, place):
        sizes = [self.r.randint(2, 4) for _ in range(3)]
        values = [self.between(0.1, 1) for _ in range(sizes[0] * sizes[1] * sizes[2])]
        content = struct.pack(f"<3sB5i6f{len(values)}f", b"VOL", 3, 1, *sizes, 1, 0, 0, 0, 1, 1, 1, *values)
        volume = element("volume", self.file(".vol", content), place, self.maybe(0.4, lambda: word("filter_type", self.r.choice(
            ["nearest", "trilinear"]))), type="gridvolume", name="sigma_t")
        return element("medium", volume, element("volume", self.spectrum("value", 0.4, 0.95), type="constvolume", name="albedo"),
                       number("scale", self.between(1, 4)), type="heterogeneous", name=name)

    def body(self, place, size):
        """A closed shape with a medium, of which now and then another lies within."""
        if self.chance(0.3):
            turn = [element("rotate", y=1, angle=self.between(-90, 90)), translation(place)]
            s = [self.between(0.3, 0.8) for _ in range(3)]
            cube = element("transform", element("scale", x=s[0], y=s[1], z=s[2]), *turn, name="to_world")
            grid = element("transform", translation([-0.5] * 3), element("scale", x=2 * s[0], y=2 * s[1], z=2 * s[2]), *turn, name="to_world")
            shape, medium = element("shape", cube, type="cube"), self.grid("interior", grid)
        else:
            shape, medium = self.shape(place, size, True), self.medium("interior", self.between(0.5, 4))
        flipped = shape.find("boolean[@name='flip_normals']")
        if flipped is not None:
            shape.remove(flipped)
        boundary = self.one(lambda: self.bsdf("null"), lambda: self.bsdf("null"), lambda: self.bsdf("dielectric", *self.indices()),
                            lambda: self.bsdf("roughdielectric", *self.indices(), *self.alphas()))
        shape.extend([boundary, medium])
        if self.around is not None:
            shape.append(element("ref", id=self.around, name="exterior"))
        return shape

    # Lights, of which the brightness of the whole is about 1.

    def looking(self, origin, target):
        return element("lookat", origin=origin, target=target, up=[0, 1, 0])

    def lamp(self):
        place = [self.between(-2, 2), self.between(1.5, 3), self.between(-1, 3)]
        shape = self.shape(place, 0.6)
        if self.chance(0.7):
            radiance = self.light("radiance", 8)
        else:
            radiance = self.bitmap("radiance", 100, 255)
        shape.append(element("emitter", radiance, type="area"))
        return shape

    def environment(self):
        if self.chance(0.5):
            return element("emitter", self.light("radiance", 1), type="constant")
        grey = self.r.uniform(0.4, 1)
        rows = [[tuple(grey * (1 + 0.4 * math.sin(i / 16 * 2 * math.pi + 0.7 * j)) * self.r.uniform(0.93, 1) for _ in range(3))
                 for i in range(16)] for j in range(8)]
        turn = element("transform", element("rotate", angle=self.between(-180, 180), **{self.r.choice("xyz"): 1}), name="to_world")
        return element("emitter", self.file(".hdr", radiance_picture(rows)), self.maybe(0.5, self.flat, "scale", 0.5, 2), turn, type="envmap")

    def point_light(self):
        origin, target = [self.between(-2, 2), self.between(2, 3.5), self.between(1, 4)], [self.between(-0.5, 0.5) for _ in range(3)]
        stands = element("transform", self.looking(origin, target), name="to_world")
        return self.one(
            lambda: element("emitter", self.light("intensity", 15), value("point", "position", origin), type="point"),
            lambda: element("emitter", self.light("intensity", 25), stands, self.flat("cutoff_angle", 20, 50),
                            self.maybe(0.5, self.flat, "beam_width", 5, 15), self.maybe(0.4, self.bitmap, "texture"), type="spot"),
            lambda: element("emitter", self.light("irradiance", 2),
                            value("vector", "direction", [t - o for o, t in zip(origin, target)]), type="directional"),
            lambda: element("emitter", self.bitmap("irradiance"), stands, self.flat("fov", 30, 70), self.flat("scale", 3, 8), type="projector"))

    # The view.

    def film(self):
        size, crop = 32, []
        if self.chance(0.3):
            crop = [whole("crop_width", 32), whole("crop_height", 32), whole("crop_offset_x", self.r.randint(0, 16)),
                    whole("crop_offset_y", self.r.randint(0, 8))]
        kind = self.r.choice(["box", "box", "box", "tent", "gaussian", "mitchell", "catmullrom"])
        return element("film", whole("width", size + 16 * bool(crop)), whole("height", size + 8 * bool(crop)), *crop, element("rfilter", type=kind),
                       type="hdrfilm")

    def sensor(self):
        origin = [self.between(-2, 2), self.between(0.3, 2.5), self.between(4, 5.5)]
        looking = self.looking(origin, [self.between(-0.3, 0.3), 0, 0])
        kind = self.r.choice(["perspective", "perspective", "thinlens", "orthographic"])
        if kind == "orthographic":
            size = self.between(1.2, 2.2)
            inner = [element("transform", element("scale", x=size, y=size), looking, name="to_world")]
        else:
            inner = [element("transform", looking, name="to_world")]
            inner += self.one(lambda: [self.flat("fov", 25, 50), self.maybe(0.5, lambda: word("fov_axis", self.r.choice(
                ["x", "y", "diagonal", "smaller", "larger"])))], lambda: [word("focal_length", f"{self.r.randint(35, 70)}mm")])
            inner += [self.maybe(0.3, self.flat, f"principal_point_offset_{axis}", -0.2, 0.2) for axis in "xy" if kind == "perspective"]
        if kind == "thinlens":
            inner += [self.flat("aperture_radius", 0.02, 0.2), self.flat("focus_distance", 3, 6)]
        if self.chance(0.15) and not self.around:
            inner += [self.flat("near_clip", 3, 5), self.flat("far_clip", 6, 9)]
        if self.around:
            inner.append(element("ref", id=self.around))
        return element("sensor", self.film(), *inner, type=kind)

    def renderer(self):
        if self.integrator == "direct":
            samples = {"scattered": [whole("emitter_samples", 0), whole("bsdf_samples", 1)]}.get(self.sort, self.one(
                lambda: [], lambda: [whole("emitter_samples", 2), whole("bsdf_samples", 1)]))
            return element("integrator", *samples, type="direct")
        return element("integrator", whole("max_depth", self.r.randint(2, 6)), self.maybe(0.4, lambda: whole("rr_depth", self.r.randint(2, 6))),
                       type=self.integrator)

    def scene(self):
        scene = element("scene", version="3.0.0")
        if self.media and self.chance(0.3):
            self.around = "air"
            medium = self.medium("", self.between(0.05, 0.2))
            medium.set("id", "air")
            del medium.attrib["name"]
            scene.append(medium)
            room = element("transform", element("scale", value=self.between(7, 9)), name="to_world")
            scene.append(element("shape", room, self.bsdf("null"), element("ref", id="air", name="interior"), type="cube"))
        scene.extend([self.renderer(), self.sensor()])
        floor = element("transform", element("rotate", x=1, angle=-90), element("scale", value=3), element("translate", y=-1), name="to_world")
        scene.append(element("shape", floor, self.bsdf("twosided", self.opaque(1)), type="rectangle"))
        for i in range(self.r.randint(1, 3)):
            scene.extend(self.group(i) if self.chance(0.25) else [self.thing()])
        if self.sort == "points":
            scene.extend(self.point_light() for _ in range(self.r.randint(1, 2)))
        else:
            lamps = self.r.randint(0, 1) if self.sort == "even" else 0
            scene.extend(self.lamp() for _ in range(lamps))
            if not lamps or self.chance(0.8):  # a lamp may be turned away
                scene.append(self.environment())
        ET.indent(scene)
        return scene
