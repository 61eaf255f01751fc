"""Rays, points on surfaces, and samples: structures of arrays, one row for each item.

All coordinates are in world space, as in a description. Positions are doubles, as floats are coarse far from the origin.
"""

from __future__ import annotations

import enum
from collections.abc import Iterator
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import Any, Optional

import numpy as np

from . import _core
from ._arrays import Array, array, count_of, places, rows, scalars
from ._errors import Error

_flags: Any = enum.IntFlag  # the names are known at run time only
#: Kinds of scattering: Lobes.DIFFUSE_REFLECTION, … A sum of them is a set.
Lobes: Any = _flags("Lobes", {name.upper().replace(" ", "_"): bit for name, bit in _core.lobe_bits().items()})


def _lobes_named(*words: str) -> Any:
    return Lobes(sum(lobe for lobe in Lobes if any(word in lobe.name for word in words)))


ALL_LOBES: Any = _lobes_named("")
SPECULAR_LOBES: Any = _lobes_named("SPECULAR", "NULL")
SMOOTH_LOBES: Any = ALL_LOBES & ~SPECULAR_LOBES
TRANSMISSION_LOBES: Any = _lobes_named("TRANSMISSION", "NULL")


def _take(values: Any, where: Array, count: int) -> Any:
    if values is None or len(values) != count:
        return values
    return values[where] if isinstance(values, np.ndarray) else values


class _Columns:
    """A frozen dataclass of arrays, of which some rows can be taken."""

    def __len__(self) -> int:
        return count_of(**{f.name: v for f in fields(self) if isinstance(v := getattr(self, f.name), np.ndarray)})  # type: ignore[arg-type]

    def __getitem__(self, where: Any) -> Any:
        """Some of the rows, by a mask, a slice or places."""
        n = len(self)
        at = places(where, n)
        changed = {f.name: _take(getattr(self, f.name), at, n) for f in fields(self)}  # type: ignore[arg-type]
        return replace(self, **changed)  # type: ignore[type-var]

    def __iter__(self) -> Iterator[Any]:
        raise TypeError(f"{type(self).__name__} is a structure of arrays: its rows are not iterated")


@dataclass(frozen=True, repr=False)
class Rays(_Columns):
    """Rays: the points origin + t direction for t from 0 to maximum. Every array may have one row for all rays.

    origin: shape (N, 3) [m]. direction: shape (N, 3), of any length; a ray whose direction is zero or NaN hits nothing.
    maximum: where rays end [m]; infinite by default. time [s].
    width, spread: the width of the ray's cone at the origin [m], and its growth per distance, which maps are filtered by.
    of_camera: whether it is the first segment of a camera's path, which ignores objects that are invisible to the camera.
    """

    origin: Array
    direction: Array
    maximum: Array = field(default_factory=lambda: np.full(1, np.inf, np.float32))
    time: Array = field(default_factory=lambda: np.zeros(1, np.float32))
    width: Array = field(default_factory=lambda: np.zeros(1, np.float32))
    spread: Array = field(default_factory=lambda: np.zeros(1, np.float32))
    of_camera: Array = field(default_factory=lambda: np.zeros(1, bool))
    _media: Any = None

    def __post_init__(self) -> None:
        put = object.__setattr__
        put(self, "origin", rows(self.origin, 3, "origin", np.float64))
        put(self, "direction", rows(self.direction, 3, "direction"))
        for name in ("maximum", "time", "width", "spread"):
            put(self, name, scalars(getattr(self, name), name))
        put(self, "of_camera", scalars(self.of_camera, "of_camera", bool))
        len(self)  # raises Error if the numbers of rows differ

    def __getitem__(self, where: Any) -> "Rays":
        """Some of the rays, by a mask, a slice or places."""
        n = len(self)
        at = places(where, n)
        media = self._media
        if media is not None and len(media) == n:
            media = _core.media_take(media, at)
        changed = {f.name: _take(getattr(self, f.name), at, n) for f in fields(self) if f.name != "_media"}
        return Rays(**changed, _media=media)

    def __repr__(self) -> str:
        return f"<{len(self)} rays>"

    def at(self, distance: Any) -> Array:
        """The points at distances along the rays, shape (N, 3)."""
        return self.origin + np.reshape(distance, (-1, 1)) * self.direction  # type: ignore[no-any-return]

    def _core(self) -> tuple[Any, ...]:
        return (self.origin, self.direction, self.maximum, self.time, self.width, self.spread, self.of_camera, self._media)


def rays_of(origins: Any, directions: Any, maximum: Any, time: Any) -> Rays:
    """The rays of a question: Rays, or origins and directions."""
    if isinstance(origins, Rays):
        if directions is not None:
            raise Error("directions: the rays have theirs already")
        return origins
    if directions is None:
        raise Error("directions: needed with origins; or give Rays")
    given = {
        "origins": rows(origins, 3, "origins", np.float64),
        "directions": rows(directions, 3, "directions"),
        "maximum": scalars(maximum, "maximum"),
        "time": scalars(time, "time"),
    }
    count_of(**given)  # raises Error if the numbers of rows differ
    return Rays(*given.values())


class SurfacePoints:
    """Points on surfaces, one for each ray that looked for one, or made by hand. Also what shaders read there.

    The arrays are read-only, and have a row for each point. Where `hit` is False there is no point: distance is infinite, `object`
    -1, and vectors are NaN. Such rows may be given to questions: nothing is scattered or emitted there, except that
    `Scene.emitted` gives the light from infinity.

    hit: shape (N,) of bool.            position: shape (N, 3) [m], of float64.
    distance: shape (N,) [m].           normal: shape (N, 3), unit, on the front side; shading_normal: as interpolated.
    uv: shape (N, 2).                   dpdu, dpdv: shape (N, 3), the derivatives of the position.
    object: shape (N,), places in `parts`, the scene's objects; -1: none.
    primitive: shape (N,), the part of the object, such as a triangle of a mesh.
    error: shape (N,) [m], an upper bound of the distance of the position from the true surface.
    object_position, object_normal: shape (N, 3), in the object's own space.
    footprint: shape (N,) [m], the width of the ray's cone. time: shape (N,) [s]. ray_direction: shape (N, 3).
    """

    hit: Array
    position: Array
    distance: Array
    normal: Array
    shading_normal: Array
    uv: Array
    dpdu: Array
    dpdv: Array
    object: Array
    primitive: Array
    error: Array
    object_position: Array
    object_normal: Array
    footprint: Array
    time: Array
    ray_direction: Array

    def __init__(
        self,
        position: Any,
        normal: Any,
        *,
        shading_normal: Any = None,
        uv: Any = (0, 0),
        dpdu: Any = (0, 0, 0),
        dpdv: Any = (0, 0, 0),
        time: Any = 0,
    ) -> None:
        """Points made by hand, which belong to no object. Each array has a row for each point, or one for all of them.

        Where dpdu and dpdv are zero they are any tangents.
        """
        given = {
            "position": rows(position, 3, "position", np.float64),
            "normal": rows(normal, 3, "normal"),
            "shading_normal": rows(normal if shading_normal is None else shading_normal, 3, "shading_normal"),
            "uv": rows(uv, 2, "uv"),
            "dpdu": rows(dpdu, 3, "dpdu"),
            "dpdv": rows(dpdv, 3, "dpdv"),
            "time": scalars(time, "time"),
        }
        self._core = _core.points_make(count_of(**given), *given.values(), (0, 0, 0))

    @classmethod
    def on_plane(cls, uv: Any = (0, 0)) -> "SurfacePoints":
        """Points of the plane z = 0, seen from above, with the surface coordinates uv, shape (N, 2): at x = u, y = v [m]."""
        at = rows(uv, 2, "uv", np.float64)
        position = np.concatenate([at, np.zeros((len(at), 1))], axis=1)
        return cls(position, (0, 0, 1), uv=at, dpdu=(1, 0, 0), dpdv=(0, 1, 0))

    @classmethod
    def _of(cls, core: Any) -> "SurfacePoints":
        made = cls.__new__(cls)
        made._core = core
        return made

    def __len__(self) -> int:
        return len(self._core)

    def __getitem__(self, where: Any) -> "SurfacePoints":
        """Some of the points, by a mask, a slice or places."""
        return SurfacePoints._of(_core.points_take(self._core, places(where, len(self))))

    def __iter__(self) -> Iterator[Any]:
        raise TypeError("SurfacePoints is a structure of arrays: its rows are not iterated")

    def __repr__(self) -> str:
        return f"<{len(self)} points>"

    @cached_property
    def parts(self) -> tuple[Any, ...]:
        """The objects of the scene, at any depth, which `object` counts."""
        return _core.points_parts(self._core)  # type: ignore[no-any-return]

    def leave(self, directions: Any) -> Rays:
        """Rays that leave the points, just beside their surfaces, so that these are not hit again.

        directions: shape (N, 3); or ScatterSamples, with which rays also go through a surface into the object's inside.
        """
        lobe = np.zeros(1, np.uint8)
        if isinstance(directions, ScatterSamples):
            directions, lobe = directions.direction, directions.lobe
        d = rows(directions, 3, "directions")
        return Rays(*_core.points_leave(self._core, count_of(points=self, directions=d), d, lobe))


def _column(name: str) -> Any:
    def read(self: SurfacePoints) -> Array:
        values: Array = _core.points_column(self._core, name)
        values.flags.writeable = False
        return values

    read.__name__ = name
    made = cached_property(read)
    made.__set_name__(SurfacePoints, name)
    return made


for _name in SurfacePoints.__annotations__:
    setattr(SurfacePoints, _name, _column(_name))


@dataclass(frozen=True)
class ScatterSamples(_Columns):
    """Directions sampled by shaders, one for each point.

    direction: shape (N, 3), unit, away from the surface; zero where the light is absorbed.
    weight: shape (N, K), f |cos| / pdf; 0 where the light is absorbed.
    pdf: shape (N,) [1/sr]; of specular lobes a discrete probability. 0: absorbed.
    lobe: shape (N,), the kind of scattering, a bit of Lobes; 0: absorbed.
    eta: shape (N,), the relative refractive index that the direction crosses to; 1 for reflection.
    dispersive: shape (N,), whether the direction holds for the hero wavelength alone: see Wavelengths.drop_secondary.
    subsurface: shape (N,), whether the light enters an object with subsurface scattering, and would leave it elsewhere.
    """

    direction: Array
    weight: Array
    pdf: Array
    lobe: Array
    eta: Array
    dispersive: Array
    subsurface: Array

    @property
    def specular(self) -> Array:
        """shape (N,): whether the direction is that of a delta distribution."""
        return np.asarray((self.lobe & np.uint8(SPECULAR_LOBES)) != 0)

    @property
    def transmitted(self) -> Array:
        """shape (N,): whether the direction goes through the surface."""
        return np.asarray((self.lobe & np.uint8(TRANSMISSION_LOBES)) != 0)


@dataclass(frozen=True)
class LightSamples(_Columns):
    """Points sampled on luminaires, one as seen from each point; not yet whether they are visible.

    direction: shape (N, 3), unit, to the luminaire. distance: shape (N,) [m].
    radiance: shape (N, K), the emitted radiance towards the point [W m^-2 sr^-1 nm^-1].
    pdf: shape (N,) [1/sr], including the probability of the luminaire. 0: no point was found.
    object: shape (N,), the luminaire, a place in the points' `parts`; -1: none.
    delta: shape (N,), whether it is a delta light, which no ray hits.
    shadow: the shadow rays, for Scene.occluded.
    """

    direction: Array
    distance: Array
    radiance: Array
    pdf: Array
    object: Array
    delta: Array
    shadow: Rays

    def __getitem__(self, where: Any) -> "LightSamples":
        at = places(where, len(self))
        values = {f.name: getattr(self, f.name)[at] for f in fields(self)}
        return LightSamples(**values)


@dataclass(frozen=True)
class DirectionSamples(_Columns):
    """direction: shape (N, 3), unit. pdf: shape (N,) [1/sr]; 0: there is none."""

    direction: Array
    pdf: Array


@dataclass(frozen=True)
class LightChoices(_Columns):
    """object: shape (N,), the luminaire that was chosen, a place in the points' `parts`; -1: none. probability: shape (N,)."""

    object: Array
    probability: Array


@dataclass(frozen=True)
class CameraRays(_Columns):
    """The rays of a camera, with their weights.

    rays: the Rays. weight: shape (N, K), the factor for the radiance that arrives along each ray: transmittance and vignetting
    over the pdf. 0: the lens blocks the ray. dispersed: shape (N,), whether the ray holds for the hero wavelength alone.
    """

    rays: Rays
    weight: Array
    dispersed: Array


@dataclass(frozen=True)
class LensSamples(_Columns):
    """Points on the lens, one as seen from each point of the scene. Where light does not reach the film, pdf and importance are 0.

    lens: shape (N, 3) [m]. direction: shape (N, 3), unit, to the lens. distance: shape (N,) [m].
    pdf: shape (N,) [1/sr] at the point; for a pinhole distance^2 / cos. importance: shape (N,) [1/(m^2 sr)].
    film: shape (N, 2) [pixels], where the light arrives; NaN where it does not.
    nearest: shape (N,) [m] from the lens: surfaces nearer than this do not occlude.
    weight: shape (N, K), the transmittance of the lens; None without wavelengths.
    """

    lens: Array
    direction: Array
    distance: Array
    pdf: Array
    importance: Array
    film: Array
    nearest: Array
    weight: Optional[Array] = None


@dataclass(frozen=True)
class FilmPoints(_Columns):
    """Where rays arrive on the film. film: shape (N, 2) [pixels]; NaN: nowhere.

    importance: shape (N,) [1/(m^2 sr)]. pdf_position: shape (N,) [1/m^2] on the lens, 1 for a pinhole; pdf_direction: shape (N,)
    [1/sr]; both for film points that are uniform over the whole film.
    """

    film: Array
    importance: Array
    pdf_position: Array
    pdf_direction: Array


@dataclass(frozen=True)
class VolumeCoefficients(_Columns):
    """absorption, scattering: shape (N, K) [1/m]. emission: shape (N, K) [W m^-3 sr^-1 nm^-1]."""

    absorption: Array
    scattering: Array
    emission: Array

    @property
    def extinction(self) -> Array:
        """shape (N, K) [1/m]: absorption and scattering."""
        return self.absorption + self.scattering


@dataclass(frozen=True)
class AngleSamples(_Columns):
    """cosine: shape (N,), of scattering angles. pdf: shape (N,) [1/sr] of the direction."""

    cosine: Array
    pdf: Array


def points_of(given: Any) -> SurfacePoints:
    """The points of a question: SurfacePoints, or surface coordinates of shape (N, 2) on the plane z = 0."""
    if isinstance(given, SurfacePoints):
        return given
    at = array(given, "points", np.float64)
    if at.shape[-1:] != (2,):
        raise Error(f"points: expects SurfacePoints, or uv of shape (N, 2) or (2,), not {at.shape}")
    return SurfacePoints.on_plane(at)


def places_in_space(given: Any) -> SurfacePoints:
    """Points of space: SurfacePoints, or positions of shape (N, 3) that are on no surface."""
    if isinstance(given, SurfacePoints):
        return given
    at = rows(given, 3, "points", np.float64)
    up, zero = np.array([[0, 0, 1]], np.float32), np.zeros((1, 3), np.float32)
    # Floats are precise near the points.
    origin = tuple(map(float, at[0])) if len(at) and np.isfinite(at[0]).all() else (0.0, 0.0, 0.0)
    core = _core.points_make(len(at), at, up, up, zero[:, :2].copy(), zero, zero, zero[:, 0].copy(), origin)
    return SurfacePoints._of(core)
