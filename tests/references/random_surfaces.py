"""Random spectra, textures and surfaces of Mitsuba 3's XML, for random_scenes.py."""

import math
import random
import xml.etree.ElementTree as ET

from small_scenes import png


def text(what):
    if isinstance(what, (tuple, list)):
        return ", ".join(map(text, what))
    return f"{what:.6g}" if isinstance(what, float) else str(what)


def element(tag, *inner, **attributes):
    e = ET.Element(tag, {key.rstrip("_"): text(what) for key, what in attributes.items()})
    e.extend([i for i in inner if i is not None])
    return e


def value(tag, name, what):
    return element(tag, name=name, value=what)


def number(name, what):
    return value("float", name, what)


def word(name, what):
    return value("string", name, what)


def truth(name, what):
    return value("boolean", name, "true" if what else "false")


class SurfaceMaker:
    """What a shape looks like. What the scene is like decides what may be used."""

    def __init__(self, seed):
        self.r = random.Random(seed)
        self.files = {}  # that the scene names
        self.sort = "even"
        self.integrator = "path"
        self.attributes = ""  # of the mesh that is being made

    def chance(self, p):
        return self.r.random() < p

    def between(self, low, high):
        return round(self.r.uniform(low, high), 3)

    def one(self, *makers):
        return self.r.choice(makers)()

    def maybe(self, p, maker, *arguments):
        return maker(*arguments) if self.chance(p) else None

    def file(self, ending, content):
        name = f"file{len(self.files)}{ending}"
        self.files[name] = content if isinstance(content, bytes) else content.encode()
        return word("filename", name)

    # Spectra.

    def rgb(self, name, low=0.15, high=0.8):
        """Not saturated: which spectrum a colour becomes is a choice, and many bounces would show it."""
        middle = self.r.uniform(low, high)
        return value("rgb", name, [round(min(max(middle * self.r.uniform(0.75, 1.3), low), high), 3) for _ in range(3)])

    def spectrum(self, name, low=0.1, high=0.8, red_green_blue=True):
        def values(count):
            return [self.between(low, high) for _ in range(count)]

        def table():
            return value("spectrum", name, ", ".join(f"{nm}:{v}" for nm, v in zip((360, 450, 540, 630, 740, 830), values(6))))

        def irregular():
            places = sorted(self.r.sample(range(400, 780), 4))
            return element("spectrum", word("wavelengths", [360, *places, 830]), word("values", values(6)), type="irregular", name=name)

        def regular():
            return element("spectrum", number("wavelength_min", 360), number("wavelength_max", 830),
                           word("values", values(self.r.randint(2, 6))), type="regular", name=name)

        return self.one(table, irregular, regular, lambda: self.rgb(name, max(low, 0.05), high) if red_green_blue else table(),
                        lambda: value("spectrum", name, self.between(low, high)),
                        lambda: element("spectrum", number("value", self.between(low, high)), type="uniform", name=name))

    def light(self, name, strength):
        def blackbody():  # as hot as gives this strength at 550 nm, in W / (m2 sr nm)
            at_infinity = 3.7418e-16 / 550e-9**5 / math.pi * 1e-9
            kelvin = 0.014388 / (550e-9 * math.log1p(at_infinity / strength))
            return element("spectrum", number("temperature", round(kelvin)), type="blackbody", name=name)

        return self.one(blackbody, lambda: self.rgb(name, 0.5 * strength, 1.5 * strength),
                        lambda: self.spectrum(name, 0.5 * strength, strength),
                        lambda: element("spectrum", number("scale", strength), type="d65", name=name))

    # Textures.

    def image(self, low, high, grey=False, blue=None):
        width, height = self.r.choice([2, 3, 5, 8]), self.r.choice([2, 3, 5, 7])

        def pixel():
            first = self.r.randint(low, high)
            return (first,) * 3 if grey else (first, self.r.randint(low, high), self.r.randint(*(blue or (low, high))))

        return self.file(".png", png([[pixel() for _ in range(width)] for _ in range(height)]))

    def to_uv(self):
        steps = [element("scale", x=self.between(0.3, 3) * self.r.choice([1, 1, -1]), y=self.between(0.3, 3)),
                 element("rotate", z=1, angle=self.between(-180, 180)),
                 element("translate", x=self.between(-1, 1), y=self.between(-1, 1))]
        return self.maybe(0.6, lambda: element("transform", *self.r.sample(steps, self.r.randint(1, 3)), name="to_uv"))

    def bitmap(self, name, low=40, high=230, raw=False, grey=False, nearest=True, blue=None):
        wrap = self.maybe(0.5, lambda: word("wrap_mode", self.r.choice(["repeat", "mirror", "clamp"])))
        return element("texture", self.image(low, high, grey, blue), self.to_uv(), truth("raw", True) if raw else None, wrap,
                       self.maybe(0.4, lambda: word("filter_type", self.r.choice(["nearest", "bilinear"]) if nearest else "bilinear")),
                       type="bitmap", name=name)

    def checkerboard(self, name, low, high, maker):
        return element("texture", maker("color0", low, high), maker("color1", low, high), self.to_uv(), type="checkerboard", name=name)

    def colour(self, name, low=0.1, high=0.8, mean=False):
        """Where the mean is asked for, as by plastic, Mitsuba has no attribute of a mesh."""
        if self.attributes and not mean and self.chance(0.6):
            return element("texture", word("name", self.attributes), type="mesh_attribute", name=name)
        if self.chance(0.5):
            return self.spectrum(name, low, high)
        return self.one(lambda: self.bitmap(name), lambda: self.checkerboard(name, low, high, self.spectrum))

    def flat(self, name, low, high):
        return number(name, self.between(low, high))

    def scalar(self, name, low, high, textured=0.3):
        if not self.chance(textured):
            return self.flat(name, low, high)
        return self.one(lambda: self.bitmap(name, round(255 * low), round(255 * high), True, self.chance(0.7)),
                        lambda: self.checkerboard(name, low, high, self.flat))

    def share(self, name):
        """A weight or an opacity; of 0 and 1 alone where Mitsuba's samples need it."""
        if self.sort != "even":
            return self.scalar(name, 0.1, 0.9, 0.5)
        bits = png([[(255 * self.r.randint(0, 1),) * 3 for _ in range(5)] for _ in range(4)])
        return self.one(lambda: self.checkerboard(name, 0, 1, lambda n, *_: number(n, 1.0 if n == "color1" else 0.0)),
                        lambda: element("texture", self.file(".png", bits), truth("raw", True), word("filter_type", "nearest"), self.to_uv(),
                                        type="bitmap", name=name))

    # Surfaces. What is not two-sided is black behind.

    def bsdf(self, kind, *inner):
        return element("bsdf", *inner, type=kind)

    def alphas(self, low=0.2, high=0.6):
        kind = self.maybe(0.8, lambda: word("distribution", self.r.choice(["ggx", "beckmann"])))
        if self.chance(0.5):
            return [kind, self.scalar("alpha_u", low, high), self.scalar("alpha_v", low, high)]
        return [kind, self.scalar("alpha", low, high)]

    def indices(self):
        return [number("int_ior", self.between(1.2, 2)), self.maybe(0.3, self.flat, "ext_ior", 1, 1.2)]

    def metal(self):
        # As red, green and blue Mitsuba's spectral variants take no more than 1.
        material = [self.spectrum("eta", 0.2, 2, False), self.spectrum("k", 1.5, 4, False)] if self.chance(0.8) else [word("material", "none")]
        return [*material, self.maybe(0.3, self.colour, "specular_reflectance", 0.3, 0.9)]

    def plastic(self):
        return [self.colour("diffuse_reflectance", mean=True), truth("nonlinear", self.chance(0.5)), *self.indices(),
                self.maybe(0.3, self.colour, "specular_reflectance", 0.3, 0.9, True)]

    def rough_plastic(self):
        return self.bsdf("roughplastic", *self.plastic(), self.flat("alpha", 0.2, 0.5),
                         word("distribution", self.r.choice(["ggx", "beckmann"])))

    def principled(self):
        parts = [self.maybe(0.35, self.scalar, name, 0.1, 0.9)
                 for name in ("metallic", "anisotropic", "sheen", "flatness", "clearcoat", "clearcoat_gloss")]
        return self.bsdf("principled", self.colour("base_color"), self.scalar("roughness", 0.35, 0.8), *parts,
                         self.one(lambda: self.flat("eta", 1.2, 1.8), lambda: self.flat("specular", 0.2, 0.9)))

    def tilted(self, twice):
        inner = self.opaque(2, False)
        if twice:
            inner = self.bsdf("twosided", inner)
        if self.chance(0.5):
            return self.bsdf("bumpmap", self.bitmap("height", 100, 140, True, self.chance(0.5), False), self.flat("scale", 0.05, 0.6), inner,
                             truth("use_shadowing_function", self.chance(0.5)))
        return self.bsdf("normalmap", self.bitmap("normalmap", 60, 195, True, blue=(190, 255)), inner, truth("use_shadowing_function", self.chance(0.5)))

    def opaque(self, depth=0, smooth=True):
        makers = [lambda: self.bsdf("diffuse", self.colour("reflectance")), self.rough_plastic, self.principled,
                  lambda: self.bsdf("roughconductor", *self.metal(), *self.alphas())]
        if smooth:
            makers += [lambda: self.bsdf("plastic", *self.plastic()), lambda: self.bsdf("conductor", *self.metal())]
        if depth < 2:
            makers += [lambda: self.bsdf("blendbsdf", self.share("weight"), self.opaque(depth + 1, False), self.opaque(depth + 1, False)),
                       lambda: self.tilted(False)]
        return self.one(*makers)

    def glass(self):
        tints = [self.maybe(0.3, self.colour, "specular_reflectance", 0.5, 0.9), self.maybe(0.3, self.colour, "specular_transmittance", 0.5, 0.9)]
        makers = [lambda: self.bsdf("dielectric", *self.indices(), *tints),
                  lambda: self.bsdf("roughdielectric", *self.indices(), *self.alphas(), *tints),
                  lambda: self.bsdf("principledthin", self.colour("base_color"), self.flat("roughness", 0.35, 0.8), self.flat("spec_trans", 0, 0.5),
                                    self.flat("diff_trans", 0, 2), self.flat("eta", 1.2, 1.7)),
                  lambda: self.bsdf("principled", self.colour("base_color"), self.flat("roughness", 0.35, 0.8), self.flat("spec_trans", 0.2, 1),
                                    self.flat("eta", 1.2, 1.7))]
        return self.one(*makers)

    def twosided(self, smooth=True):
        return self.bsdf("twosided", self.opaque(0, smooth), self.maybe(0.4, self.opaque, 0, smooth))

    def blend(self):
        parts = [self.twosided(False), self.twosided(False), self.bsdf("roughdielectric", *self.indices(), *self.alphas())]
        return self.bsdf("blendbsdf", self.share("weight"), *self.r.sample(parts, 2))

    def sheet(self):
        """A mask where Mitsuba finds light through it, else a mixture, of what needs no inside."""
        if self.sort != "points" or self.integrator == "volpath":
            return self.bsdf("mask", self.share("opacity"), self.surface(False, False))
        return self.bsdf("blendbsdf", self.share("weight"), self.twosided(False), self.twosided(False))

    def surface(self, closed, masked=True):
        """What is not closed has no inside here, which is told: nothing that refracts."""
        kind = self.r.random() * (1 if closed else 0.62)
        if kind < 0.42:
            return self.twosided()
        if kind < 0.55:
            return self.opaque()
        if kind < 0.62:
            return self.tilted(True) if closed or masked is False or self.chance(0.5) else self.sheet()
        if kind < 0.8:
            return self.glass()
        # Light of points finds no way through a mask in `path`.
        if kind < 0.92 and masked and (self.sort != "points" or self.integrator == "volpath"):
            return self.bsdf("mask", self.share("opacity"), self.surface(closed, False))
        return self.blend()
