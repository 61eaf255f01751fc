"""Parts written in Python that keep the contracts of their interfaces, for the tests, and broken twins of each."""

from __future__ import annotations

import math
from typing import Any, Optional

import numpy as np

import etendue
from etendue import Lobe, ScatterSample, member


class Waves(etendue.ObjectMap):
    """Waves of grey over surface coordinates."""

    count: float = member(3, range=(0, 100), text="waves per unit of u")
    contrast: float = member(0.5, range=(0, 1), text="how much the waves differ from 1/2")

    def scalar(self, point: Any) -> float:
        x = self.count * point.uv[0] * 2 * math.pi
        return 0.5 + 0.5 * self.contrast * math.sin(math.fmod(x, 2 * math.pi))


class UnboundedWaves(etendue.ObjectMap):
    """Waves whose colour is not their scalar."""

    def scalar(self, point: Any) -> float:
        return 0.2

    def color(self, point: Any, wavelengths: tuple, use: str) -> float:
        return 0.9


class Soft(etendue.ToneMap):
    """The luminance Y becomes Y / (1 + Y)."""

    scale: float = member(1, range=(0.01, 100), text="a factor of the picture before")

    def map(self, xyz: np.ndarray) -> np.ndarray:
        xyz = xyz * self.scale
        with np.errstate(all="ignore"):
            return xyz / (1 + np.maximum(xyz[..., 1:2], 0))


class Tinted(etendue.ToneMap):
    """Greys that become blue."""

    def map(self, xyz: np.ndarray) -> np.ndarray:
        with np.errstate(all="ignore"):
            return xyz * [1, 1, 1.1] / (1 + np.maximum(xyz[..., 1:2], 0))


class ArrayTracer(etendue.Renderer):
    """Path tracing with next event estimation, many paths at once."""

    max_depth: int = member(5, range=(1, 64), text="segments of the longest paths")

    def radiance(self, context: Any, rays: Any, samples: Any) -> np.ndarray:
        light = np.zeros((len(rays), 8), np.float32)
        throughput = np.ones((len(rays), 8), np.float32)
        specular = np.ones((len(rays), 1), bool)
        for length in range(1, self.max_depth + 1):
            surfaces = context.intersect(rays)
            light += np.where(specular, throughput * surfaces.emitted(), 0)
            if length == self.max_depth:
                break
            light += throughput * surfaces.direct(samples)
            rays, weight, now = surfaces.scatter(samples)
            specular = now[:, None]
            throughput *= weight
            if not rays.alive.any():
                break
        return light


class DarkTracer(ArrayTracer):
    """The same with a fifth of the light missing."""

    def radiance(self, context: Any, rays: Any, samples: Any) -> np.ndarray:
        return 0.8 * super().radiance(context, rays, samples)


class Matte(etendue.Shader):
    """A diffuse surface (Lambert 1760)."""

    color: etendue.ObjectMap = member(0.5, unit="1", meaning="reflectance", text="the fraction of light that is scattered")
    lobes = Lobe.diffuse_reflection

    def evaluate(self, point: Any, wavelengths: tuple, out: tuple, incident: tuple, lobes: int) -> Any:
        if out[2] * incident[2] <= 0:
            return 0
        return [c / math.pi for c in point.color(self.color, wavelengths)]

    def pdf(self, point: Any, wavelengths: tuple, out: tuple, incident: tuple, lobes: int) -> float:
        return abs(incident[2]) / math.pi if out[2] * incident[2] > 0 else 0

    def sample(
        self, point: Any, wavelengths: tuple, out: tuple, choice: float, u: tuple, lobes: int
    ) -> Optional[ScatterSample]:
        r, phi = math.sqrt(u[0]), 2 * math.pi * u[1]
        z = math.copysign(math.sqrt(1 - u[0]), out[2])
        pdf = abs(z) / math.pi
        value = [c * pdf for c in point.color(self.color, wavelengths)]
        return ScatterSample((r * math.cos(phi), r * math.sin(phi), z), value, pdf, Lobe.diffuse_reflection)

    def albedo(self, point: Any, wavelengths: tuple, out: tuple, lobes: int) -> Any:
        return point.color(self.color, wavelengths)


class WrongMatte(Matte):
    """The same with a pdf that is a fifth too large."""

    def pdf(self, point: Any, wavelengths: tuple, out: tuple, incident: tuple, lobes: int) -> float:
        return 1.2 * super().pdf(point, wavelengths, out, incident, lobes)


class Beam(etendue.EmissionShader):
    """Light in proportion to a power of the cosine with the normal."""

    strength: float = member(2, range=(0, 1000), unit="W m^-2 sr^-1 nm^-1", text="radiance along the normal")
    exponent: float = member(1, range=(0, 20), text="of the cosine")

    def radiance(self, point: Any, direction: tuple, wavelengths: tuple) -> float:
        n = point.normal
        cosine = abs(n[0] * direction[0] + n[1] * direction[1] + n[2] * direction[2]) if any(n) else 1.0
        return self.strength * cosine**self.exponent


class WrongBeam(Beam):
    """The same with a pdf that is a fifth too large."""

    def sample(self, point: Any, u: tuple) -> tuple:
        z = 1 - 2 * u[0]
        r, phi = math.sqrt(max(0.0, 1 - z * z)), 2 * math.pi * u[1]
        return (r * math.cos(phi), r * math.sin(phi), z), 1.2 / (4 * math.pi)

    def pdf(self, point: Any, direction: tuple) -> float:
        return 1.2 / (4 * math.pi)


class Pinhole(etendue.Camera):
    """A pinhole that looks along z, with a flat film."""

    fov: float = member(50, unit="deg", range=(1, 150), text="angle across the shorter side of the picture")
    position: etendue.Point3 = member((0, 0, 0), unit="m", text="where the camera is")
    has_lens = False

    def set_film(self, width: int, height: int) -> None:
        self._width, self._height = width, height
        self._scale = 2 * math.tan(math.radians(self.fov) / 2) / min(width, height)  # of a pixel at distance 1
        self._area = width * height * self._scale**2
        self._from = self.position

    def ray(self, film: tuple, lens: tuple, time: float) -> tuple:
        x, y = (self._width / 2 - film[0]) * self._scale, (self._height / 2 - film[1]) * self._scale
        long = math.sqrt(x * x + y * y + 1)
        return self._from, (x / long, y / long, 1 / long), self._scale

    def film_point(self, origin: tuple, direction: tuple) -> Optional[tuple]:
        if direction[2] <= 0:
            return None
        x = self._width / 2 - direction[0] / direction[2] / self._scale
        y = self._height / 2 - direction[1] / direction[2] / self._scale
        return (x, y) if 0 <= x < self._width and 0 <= y < self._height else None

    def sample_lens(self, point: tuple, time: float, u: tuple) -> Optional[tuple]:
        v = [p - o for p, o in zip(point, self._from)]
        far = math.sqrt(v[0] ** 2 + v[1] ** 2 + v[2] ** 2)
        if far == 0 or (film := self.film_point(self._from, direction := tuple(x / far for x in v))) is None:
            return None
        return self._from, far * far / direction[2], self.importance(self._from, direction), film

    def importance(self, origin: tuple, direction: tuple) -> float:
        if self.film_point(origin, direction) is None:
            return 0
        return 1 / (self._area * direction[2] ** 4)

    def pdf(self, origin: tuple, direction: tuple) -> tuple:
        if self.film_point(origin, direction) is None:
            return 0, 0
        return 1, 1 / (self._area * direction[2] ** 3)


class WrongPinhole(Pinhole):
    """The same with an importance that is a fifth too large."""

    def importance(self, origin: tuple, direction: tuple) -> float:
        return 1.2 * super().importance(origin, direction)


class Tent(etendue.Filter):
    """A pyramid."""

    width: float = member(1, unit="1", range=(0.5, 4), text="half its width, in pixels")

    def radius(self) -> float:
        return self.width

    def weight(self, x: float, y: float) -> float:
        return max(0.0, 1 - abs(x) / self.width) * max(0.0, 1 - abs(y) / self.width)


class OddTent(Tent):
    """A filter that is not symmetric."""

    def weight(self, x: float, y: float) -> float:
        return super().weight(x, y) * (1.5 if x > 0 else 1)


class Rayleigh(etendue.PhaseFunction):
    """Isotropic scattering."""

    def value(self, h: float) -> float:
        return 1 / (4 * math.pi)

    def sample(self, u: float) -> float:
        return 2 * u


class WrongRayleigh(Rayleigh):
    """The same with a value that is a fifth too large."""

    def value(self, h: float) -> float:
        return 1.2 / (4 * math.pi)
