"""Questions on arrays: what the parts of a scene answer for many items at once, on all cores.

The classes here are no bases: the class of an interface gets the functions of the one named in QUESTIONS (_classes.class_named).

A question is answered by a prepared copy of its part, which is made when the part is first asked, and anew after an edit of the part
or of anything in it. The copy costs the memory of the part once more; `prepare` makes it at a time that you choose.

Directions are unit vectors that point away from surfaces. Those that are given may have any length; with one that is zero or NaN the
answer is that of no light: 0, or no hit. `outgoing` is the direction that a path comes from and light leaves to, `incoming` the one
that the path goes on in and light comes from. `wavelengths` are Wavelengths, or nanometres: shape (K,) for all items, or (N, K).
"""

from __future__ import annotations

from typing import Any, Iterable, Literal, Optional, Union

import numpy as np

from . import _core
from ._arrays import Array, count_of, integers, rows, scalars
from ._errors import Error
from ._points import (
    ALL_LOBES,
    AngleSamples,
    CameraRays,
    DirectionSamples,
    FilmPoints,
    LensSamples,
    LightChoices,
    LightSamples,
    Lobes,
    Rays,
    ScatterSamples,
    SurfacePoints,
    VolumeCoefficients,
    places_in_space,
    points_of,
    rays_of,
)
from ._wavelengths import ColorUse, Wavelengths, few_wavelengths, wavelengths_of

Transport = Literal["radiance", "importance"]
Film = tuple[int, int]


def prepare(part: Any) -> None:
    """Prepares a part for questions now, instead of at the first one: reads its files, builds acceleration structures and tables.

    Of a job the scene is prepared. Raises Error for what cannot be rendered.
    """
    _core.prepare_snapshot(part.scene if _core.class_name(part) == "Job" else part)


def _importance(transport: str) -> bool:
    if transport not in ("radiance", "importance"):
        raise Error(f"transport is 'radiance' or 'importance', not {transport!r}")
    return transport == "importance"


def _lobes(lobes: Any) -> int:
    bits = int(lobes)
    if not 0 <= bits <= int(ALL_LOBES):
        raise Error(f"lobes: expects a sum of Lobes, not {lobes!r}")
    return bits


def _scatter_evaluate(
    shader: Any, scene: Any, points: Any, outgoing: Any, incoming: Any, wavelengths: Any, transport: str, lobes: Any, values: bool
) -> tuple[Any, Array]:
    at, out, into, w = points_of(points), rows(outgoing, 3, "outgoing"), rows(incoming, 3, "incoming"), wavelengths_of(wavelengths)
    count = count_of(points=at, outgoing=out, incoming=into, wavelengths=w)
    return _core.scatter_evaluate(  # type: ignore[no-any-return]
        shader, scene, at._core, count, out, into, w._core(), _importance(transport), _lobes(lobes), values
    )


def _scatter_sample(
    shader: Any, scene: Any, points: Any, outgoing: Any, wavelengths: Any, u: Any, transport: str, lobes: Any
) -> ScatterSamples:
    at, out, w, numbers = points_of(points), rows(outgoing, 3, "outgoing"), few_wavelengths(wavelengths), rows(u, 3, "u")
    count = count_of(points=at, outgoing=out, wavelengths=w, u=numbers)
    return ScatterSamples(
        *_core.scatter_sample(shader, scene, at._core, count, out, w._core(), numbers, _importance(transport), _lobes(lobes))
    )


def _scatter_albedo(shader: Any, scene: Any, points: Any, outgoing: Any, wavelengths: Any, lobes: Any) -> Array:
    at, out, w = points_of(points), rows(outgoing, 3, "outgoing"), wavelengths_of(wavelengths)
    count = count_of(points=at, outgoing=out, wavelengths=w)
    return _core.scatter_albedo(shader, scene, at._core, count, out, w._core(), _lobes(lobes))  # type: ignore[no-any-return]


def _scatter_lobes(shader: Any, scene: Any, points: Any, outgoing: Any, wavelengths: Any) -> Array:
    at, out, w = points_of(points), rows(outgoing, 3, "outgoing"), wavelengths_of(wavelengths)
    count = count_of(points=at, outgoing=out, wavelengths=w)
    return _core.scatter_lobes(shader, scene, at._core, count, out, w._core())  # type: ignore[no-any-return]


class ShaderQuestions:
    """`points` are SurfacePoints of any scene or made by hand, or uv of shape (N, 2) on a plane: a shader needs no scene."""

    def evaluate(
        self: Any,
        points: Any,
        outgoing: Any,
        incoming: Any,
        wavelengths: Any,
        *,
        transport: Transport = "radiance",
        lobes: Any = ALL_LOBES,
    ) -> Array:
        """f |cos| [1/sr] for pairs of directions: shape (N, K). 0 for specular lobes, which are delta distributions.

        points: N or one. outgoing, incoming: shape (N, 3) or (3,). transport: of which quantity. lobes: which kinds of scattering.
        """
        return _scatter_evaluate(self, None, points, outgoing, incoming, wavelengths, transport, lobes, True)[0]  # type: ignore[no-any-return]

    def pdf(
        self: Any,
        points: Any,
        outgoing: Any,
        incoming: Any,
        wavelengths: Any,
        *,
        transport: Transport = "radiance",
        lobes: Any = ALL_LOBES,
    ) -> Array:
        """The pdf [1/sr] with which `sample` finds `incoming`, without specular lobes: shape (N,). Arguments as of `evaluate`."""
        return _scatter_evaluate(self, None, points, outgoing, incoming, wavelengths, transport, lobes, False)[1]

    def sample(
        self: Any,
        points: Any,
        outgoing: Any,
        wavelengths: Any,
        u: Any,
        *,
        transport: Transport = "radiance",
        lobes: Any = ALL_LOBES,
    ) -> ScatterSamples:
        """Samples directions. u: shape (N, 3), uniform in [0, 1): the choice of the lobe, and two for the direction in it.

        At most 8 wavelengths, the first of which is the hero.
        """
        return _scatter_sample(self, None, points, outgoing, wavelengths, u, transport, lobes)

    def albedo(self: Any, points: Any, outgoing: Any, wavelengths: Any, *, lobes: Any = ALL_LOBES) -> Array:
        """The fraction of uniform incident light that is scattered towards `outgoing`: shape (N, K)."""
        return _scatter_albedo(self, None, points, outgoing, wavelengths, lobes)

    def lobes_at(self: Any, points: Any, outgoing: Any, wavelengths: Any) -> Array:
        """The kinds of scattering at the points, sums of bits of Lobes: shape (N,)."""
        return _scatter_lobes(self, None, points, outgoing, wavelengths)

    def interior_index(self: Any, wavelengths: Any) -> Array:
        """The refractive index inside the object: shape (N, K); 1 if the shader does not refract."""
        w = wavelengths_of(wavelengths)
        return _core.interior_index(self, w._core(), len(w))  # type: ignore[no-any-return]


class SceneQuestions:
    """`points` are those that `nearest` found in this scene. After an edit of the scene they must be found again."""

    def nearest(
        self: Any, origins: Any, directions: Any = None, maximum: Any = np.inf, time: Any = 0, *, media: bool = True
    ) -> SurfacePoints:
        """The nearest surface that each ray meets.

        origins: Rays; or shape (N, 3) [m], with directions: shape (N, 3), maximum: (N,) [m], time: (N,) [s]; each may have one row.
        media: whether objects that rays are inside of are tracked, which shaders need for refractive indices, and boundaries are
            passed that lie inside an object of higher priority.
        """
        rays = rays_of(origins, directions, maximum, time)
        return SurfacePoints._of(_core.scene_nearest(self, len(rays), rays._core(), media))

    def occluded(self: Any, origins: Any, directions: Any = None, maximum: Any = np.inf, time: Any = 0) -> Array:
        """Whether each ray meets any surface: shape (N,) of bool. Arguments as of `nearest`."""
        rays = rays_of(origins, directions, maximum, time)
        return _core.scene_occluded(self, len(rays), rays._core())  # type: ignore[no-any-return]

    def visible(self: Any, a: Any, b: Any) -> Array:
        """Whether no surface lies between points: shape (N,) of bool; False for points that coincide, or where there is none.

        a, b: SurfacePoints, or positions of shape (N, 3) that lie on no surface.
        """
        p, q = places_in_space(a), places_in_space(b)
        return _core.scene_visible(self, count_of(a=p, b=q), p._core, q._core)  # type: ignore[no-any-return]

    def transmittance(self: Any, a: Any, b: Any, wavelengths: Any, *, seed: int = 1) -> Array:
        """The transmittance of media and of surfaces with null scattering between points: shape (N, K); 0 if they are not visible.

        An unbiased estimate in heterogeneous media, with random numbers chosen by the seed; else exact.
        """
        from ._classes import class_named

        p, q, w = places_in_space(a), places_in_space(b), wavelengths_of(wavelengths)
        numbers = class_named("IndependentSampler")()
        count = count_of(a=p, b=q, wavelengths=w)
        return _core.scene_transmittance(self, count, p._core, q._core, w._core(), numbers, seed)  # type: ignore[no-any-return]

    def scatter_evaluate(
        self: Any,
        points: SurfacePoints,
        outgoing: Any,
        incoming: Any,
        wavelengths: Any,
        *,
        transport: Transport = "radiance",
        lobes: Any = ALL_LOBES,
    ) -> Array:
        """Shader.evaluate with the shader of each point's own object: shape (N, K) [1/sr]."""
        return _scatter_evaluate(None, self, points, outgoing, incoming, wavelengths, transport, lobes, True)[0]  # type: ignore[no-any-return]

    def scatter_pdf(
        self: Any,
        points: SurfacePoints,
        outgoing: Any,
        incoming: Any,
        wavelengths: Any,
        *,
        transport: Transport = "radiance",
        lobes: Any = ALL_LOBES,
    ) -> Array:
        """Shader.pdf with the shader of each point's own object: shape (N,) [1/sr]."""
        return _scatter_evaluate(None, self, points, outgoing, incoming, wavelengths, transport, lobes, False)[1]

    def scatter_sample(
        self: Any,
        points: SurfacePoints,
        outgoing: Any,
        wavelengths: Any,
        u: Any,
        *,
        transport: Transport = "radiance",
        lobes: Any = ALL_LOBES,
    ) -> ScatterSamples:
        """Shader.sample with the shader of each point's own object."""
        return _scatter_sample(None, self, points, outgoing, wavelengths, u, transport, lobes)

    def scatter_albedo(self: Any, points: SurfacePoints, outgoing: Any, wavelengths: Any, *, lobes: Any = ALL_LOBES) -> Array:
        """Shader.albedo with the shader of each point's own object: shape (N, K)."""
        return _scatter_albedo(None, self, points, outgoing, wavelengths, lobes)

    def scatter_lobes(self: Any, points: SurfacePoints, outgoing: Any, wavelengths: Any) -> Array:
        """Shader.lobes_at with the shader of each point's own object: shape (N,)."""
        return _scatter_lobes(None, self, points, outgoing, wavelengths)

    def emitted(self: Any, points: SurfacePoints, wavelengths: Any, directions: Any = None) -> Array:
        """The radiance that points emit, shape (N, K) [W m^-2 sr^-1 nm^-1].

        directions: shape (N, 3). Without them: towards the origin of the ray that found each point; a ray that hit nothing then
        sees the luminaires at infinity.
        """
        w = wavelengths_of(wavelengths)
        d = None if directions is None else rows(directions, 3, "directions")
        count = count_of(points=points, wavelengths=w, **({} if d is None else {"directions": d}))
        return _core.scene_emitted(self, points._core, count, d, w._core())  # type: ignore[no-any-return]

    def sample_light(self: Any, points: Any, u: Any, wavelengths: Any, *, light_sampler: Any = None) -> LightSamples:
        """Next event estimation: samples a luminaire, and on it a point that may be visible from each point.

        points: SurfacePoints, which may also be made by hand. u: shape (N, 3), uniform in [0, 1): the choice of the luminaire, and two
        for the point. light_sampler: by default the one that renderers have.
        The light that arrives is radiance / pdf where not Scene.occluded(sample.shadow), to be multiplied by f |cos|.
        """
        at, numbers, w = points_of(points), rows(u, 3, "u"), wavelengths_of(wavelengths)
        count = count_of(points=at, u=numbers, wavelengths=w)
        direction, distance, radiance, pdf, luminaire, delta, *shadow = _core.scene_sample_light(
            self, at._core, count, numbers, w._core(), light_sampler
        )
        return LightSamples(direction, distance, radiance, pdf, luminaire, delta, Rays(*shadow))

    def light_pdf(self: Any, points: SurfacePoints, found: SurfacePoints, *, light_sampler: Any = None) -> Array:
        """The pdf [1/sr] with which `sample_light` at `points` samples what rays that left them found: shape (N,), 0 for points on
        no luminaire. For weights of multiple importance sampling."""
        count = count_of(points=points, found=found)
        return _core.scene_light_pdf(self, points._core, found._core, count, light_sampler)  # type: ignore[no-any-return]

    def luminaires(self: Any) -> tuple[Any, ...]:
        """The objects that emit, in the order of the program's list; one in a nested scene as often as that is placed."""
        return _core.scene_luminaires(self)  # type: ignore[no-any-return]


class ObjectQuestions:
    def emitted_power(self: Any, wavelengths: Any) -> Array:
        """The power that the object emits from its whole area at wavelengths, shape (N, K) [W/nm]."""
        w = wavelengths_of(wavelengths)
        return _core.emission_power(self, w._core(), len(w))  # type: ignore[no-any-return]


class EmissionQuestions:
    """An emission with an amount of light for its whole object, such as a power, answers as if the amount were not given: it needs the
    object (Scene.emitted, SceneObject.emitted_power)."""

    def evaluate(self: Any, points: Any, directions: Any, wavelengths: Any) -> Array:
        """The emitted radiance, shape (N, K) [W m^-2 sr^-1 nm^-1], in directions of shape (N, 3)."""
        at, d, w = points_of(points), rows(directions, 3, "directions"), wavelengths_of(wavelengths)
        return _core.emission_radiance(self, at._core, count_of(points=at, directions=d, wavelengths=w), d, w._core())  # type: ignore[no-any-return]

    def sample(self: Any, points: Any, u: Any) -> DirectionSamples:
        """Samples directions of emission. u: shape (N, 2), uniform in [0, 1)."""
        at, numbers = points_of(points), rows(u, 2, "u")
        return DirectionSamples(*_core.emission_sample(self, at._core, count_of(points=at, u=numbers), numbers))

    def pdf(self: Any, points: Any, directions: Any) -> Array:
        """The pdf of `sample`, shape (N,) [1/sr]."""
        at, d = points_of(points), rows(directions, 3, "directions")
        return _core.emission_pdf(self, at._core, count_of(points=at, directions=d), d)  # type: ignore[no-any-return]

    def sample_incident(self: Any, u: Any) -> DirectionSamples:
        """Of light at infinity: samples directions towards it. u: shape (N, 2). pdf 0: the emission has no such distribution."""
        numbers = rows(u, 2, "u")
        return DirectionSamples(*_core.emission_sample_incident(self, len(numbers), numbers))

    def incident_pdf(self: Any, directions: Any) -> Array:
        """The pdf of `sample_incident`, shape (N,) [1/sr]."""
        d = rows(directions, 3, "directions")
        return _core.emission_incident_pdf(self, len(d), d)  # type: ignore[no-any-return]


class VolumeQuestions:
    """Points are in the space of the object that the medium fills."""

    def coefficients(self: Any, points: Any, wavelengths: Any, *, time: Any = 0) -> VolumeCoefficients:
        """Absorption, scattering and emission at points of shape (N, 3)."""
        at, w, t = rows(points, 3, "points"), wavelengths_of(wavelengths), scalars(time, "time")
        count = count_of(points=at, wavelengths=w, time=t)
        return VolumeCoefficients(*_core.volume_coefficients(self, count, at, t, w._core()))

    def majorant(self: Any, wavelengths: Any) -> Array:
        """An upper bound of the extinction over the whole medium, shape (N, K) [1/m]."""
        w = wavelengths_of(wavelengths)
        return _core.volume_majorant(self, w._core(), len(w))  # type: ignore[no-any-return]

    def transmittance(
        self: Any, origins: Any, directions: Any, distances: Any, wavelengths: Any, *, time: Any = 0, seed: int = 1
    ) -> Array:
        """The transmittance over distances (N,) [m] along rays, shape (N, K), of a medium without bounds.

        Exact if the medium is homogeneous; else an unbiased estimate by ratio tracking, with random numbers chosen by the seed. NaN
        for a ray without direction, and over infinite distances in heterogeneous media.
        """
        o, d, far = rows(origins, 3, "origins"), rows(directions, 3, "directions"), scalars(distances, "distances")
        t, w = scalars(time, "time"), wavelengths_of(wavelengths)
        count = count_of(origins=o, directions=d, distances=far, time=t, wavelengths=w)
        return _core.volume_transmittance(self, count, o, d, far, t, w._core(), seed)  # type: ignore[no-any-return]

    def evaluate_phase(self: Any, points: Any, outgoing: Any, incoming: Any) -> Array:
        """The phase function [1/sr] for light that comes from `incoming` and leaves to `outgoing`: shape (N,)."""
        at, out, into = rows(points, 3, "points"), rows(outgoing, 3, "outgoing"), rows(incoming, 3, "incoming")
        return _core.volume_phase(self, count_of(points=at, outgoing=out, incoming=into), at, out, into)  # type: ignore[no-any-return]

    def sample_phase(self: Any, points: Any, outgoing: Any, u: Any) -> DirectionSamples:
        """Samples directions in proportion to the phase function. u: shape (N, 2), uniform in [0, 1)."""
        at, out, numbers = rows(points, 3, "points"), rows(outgoing, 3, "outgoing"), rows(u, 2, "u")
        count = count_of(points=at, outgoing=out, u=numbers)
        return DirectionSamples(*_core.volume_sample_phase(self, count, at, out, numbers))


class PhaseQuestions:
    def evaluate(self: Any, cosine: Any) -> Array:
        """The pdf [1/sr] of a direction, by the cosine of the scattering angle, shape (N,): 1 is forward. NaN outside of -1 to 1.

        Give float64: a narrow peak is not resolved by floats near 1.
        """
        c = scalars(cosine, "cosine", np.float64)
        return _core.phase_value(self, len(c), c)  # type: ignore[no-any-return]

    def sample(self: Any, u: Any) -> AngleSamples:
        """Samples cosines of scattering angles. u: shape (N,), uniform in [0, 1)."""
        numbers = scalars(u, "u")
        return AngleSamples(*_core.phase_sample(self, len(numbers), numbers))


def _film(film: Any) -> Film:
    try:
        width, height = (int(n) for n in film)
    except (TypeError, ValueError):
        raise Error(f"film: expects (width, height) of the image in pixels, not {film!r}") from None
    if not (1 <= width <= 1 << 20 and 1 <= height <= 1 << 20):
        raise Error(f"film: an image has no size of {width} x {height} pixels")
    return width, height


def _lens_numbers(lens: Any) -> Array:
    return np.full((1, 2), 0.5, np.float32) if lens is None else rows(lens, 2, "lens")


def _shutter_open(camera: Any, time: Any) -> Array:
    return scalars(camera.shutter_open if time is None else time, "time")


class CameraQuestions:
    """film: the size (width, height) of the whole image in pixels; a job knows it: job.rays(film_points)."""

    def rays(self: Any, film_points: Any, film: Film, *, lens: Any = None, time: Any = None) -> Rays:
        """The rays through points of the film, without vignetting.

        film_points: shape (N, 2) [pixels], x to the right, y down from the upper left corner.
        lens: shape (N, 2), uniform in [0, 1), the points on the lens; by default (0.5, 0.5). time: shape (N,) [s]; by default when
        the shutter opens: see shutter_times.
        """
        at, numbers, t = rows(film_points, 2, "film_points"), _lens_numbers(lens), _shutter_open(self, time)
        count = count_of(film_points=at, lens=numbers, time=t)
        return Rays(*_core.camera_rays(self, *_film(film), count, at, numbers, t, None)[:7])

    def sample_rays(
        self: Any, film_points: Any, film: Film, wavelengths: Wavelengths, *, lens: Any = None, time: Any = None
    ) -> CameraRays:
        """The same with the effects of real lenses: light may be blocked, attenuated or dispersed. At most 8 wavelengths.

        Where `dispersed`, the weight is already multiplied; the wavelengths are to be told: wavelengths.drop_secondary(dispersed).
        """
        at, numbers, t = rows(film_points, 2, "film_points"), _lens_numbers(lens), _shutter_open(self, time)
        w = few_wavelengths(wavelengths)
        count = count_of(film_points=at, lens=numbers, time=t, wavelengths=w)
        *ray, weight, single = _core.camera_rays(self, *_film(film), count, at, numbers, t, w._core())
        return CameraRays(Rays(*ray), weight, single & ~w.single)

    def film_points(self: Any, rays: Rays, film: Film) -> FilmPoints:
        """Where light along rays arrives on the film. The rays begin on the lens and lead outward, as those of `rays`."""
        if not isinstance(rays, Rays):
            raise Error(f"rays: expects Rays, not {type(rays).__name__}")
        return FilmPoints(*_core.camera_film_points(self, *_film(film), len(rays), rays._core()))

    def sample_lens(
        self: Any, points: Any, film: Film, u: Any = None, wavelengths: Any = None, *, time: Any = None
    ) -> LensSamples:
        """Samples points on the lens as seen from points of the scene, for light paths that are connected to the camera.

        points: SurfacePoints, or positions of shape (N, 3). u: shape (N, 2), uniform in [0, 1); by default (0.5, 0.5).
        wavelengths: of the lens's transmittance.
        """
        at = rows(points.position if isinstance(points, SurfacePoints) else points, 3, "points", np.float64)
        numbers, t = _lens_numbers(u), _shutter_open(self, time)
        w = None if wavelengths is None else wavelengths_of(wavelengths)
        count = count_of(points=at, u=numbers, time=t, **({} if w is None else {"wavelengths": w}))
        given = None if w is None else w._core()
        return LensSamples(*_core.camera_sample_lens(self, *_film(film), count, at, numbers, t, given))

    def shutter_times(self: Any, u: Any) -> Array:
        """Times [s] at which the shutter is open, in proportion to its efficiency. u: shape (N,), uniform in [0, 1)."""
        numbers = scalars(u, "u")
        return _core.camera_shutter_times(self, len(numbers), numbers)  # type: ignore[no-any-return]


class JobQuestions:
    def film_size(self: Any) -> Film:
        """The width and height of the whole image in pixels."""
        return self.image.width, self.image.height

    def rays(self: Any, film_points: Any, *, lens: Any = None, time: Any = None) -> Rays:
        """Camera.rays with the size of the job's image."""
        return self.camera.rays(film_points, JobQuestions.film_size(self), lens=lens, time=time)  # type: ignore[no-any-return]

    def sample_rays(self: Any, film_points: Any, wavelengths: Wavelengths, *, lens: Any = None, time: Any = None) -> CameraRays:
        """Camera.sample_rays with the size of the job's image."""
        size = JobQuestions.film_size(self)
        return self.camera.sample_rays(film_points, size, wavelengths, lens=lens, time=time)  # type: ignore[no-any-return]


def _keys(pixels: Any, samples: Any) -> tuple[Array, Array]:
    return integers(pixels, 2, "pixels", np.int32), integers(samples, None, "samples", np.uint32)


class SamplerQuestions:
    def numbers(self: Any, pixels: Any, samples: Any, dimensions: Union[int, Iterable[int]], *, seed: int = 1) -> Array:
        """The primary samples in [0, 1) of paths: shape (N, D).

        pixels: shape (N, 2). samples: shape (N,), the number of the sample in its pixel. dimensions: D, for 0 to D - 1, or a list.
        """
        at, of = _keys(pixels, samples)
        wanted = integers(
            np.arange(dimensions) if isinstance(dimensions, (int, np.integer)) else list(dimensions), None, "dimensions", np.uint32
        )
        return _core.sampler_numbers(self, count_of(pixels=at, samples=of), at, of, wanted, seed)  # type: ignore[no-any-return]

    def pairs(self: Any, pixels: Any, samples: Any, dimension: int, *, seed: int = 1) -> Array:
        """Pairs that are well distributed in the unit square over the samples of a pixel: shape (N, 2). Uses two dimensions."""
        at, of = _keys(pixels, samples)
        return _core.sampler_pairs(self, count_of(pixels=at, samples=of), at, of, dimension, seed)  # type: ignore[no-any-return]


class WavelengthSamplerQuestions:
    def sample(self: Any, u: Any, *, pixels: Any = (0, 0), samples: Any = 0, seed: int = 1) -> Wavelengths:
        """Samples the wavelengths of paths. u: shape (N,), uniform in [0, 1).

        pixels, samples, seed: of samplers that go through wavelengths in rotation, as GridWavelengths.
        """
        numbers, (at, of) = scalars(u, "u"), _keys(pixels, samples)
        count = count_of(u=numbers, pixels=at, samples=of)
        return Wavelengths(*_core.sample_wavelengths(self, count, numbers, at, of, seed))


class LightSamplerQuestions:
    def choose(self: Any, scene: Any, points: SurfacePoints, u: Any) -> LightChoices:
        """Chooses a luminaire of a scene for each point. u: shape (N,), uniform in [0, 1)."""
        at, numbers = points_of(points), scalars(u, "u")
        return LightChoices(*_core.light_sampler_choose(self, scene, at._core, count_of(points=at, u=numbers), numbers))


class MapQuestions:
    """`points` are SurfacePoints, or uv of shape (N, 2)."""

    def color(self: Any, points: Any, wavelengths: Any, use: ColorUse = "reflectance") -> Array:
        """The colour at points: shape (N, K). use: what an RGB colour is used as."""
        at, w = points_of(points), wavelengths_of(wavelengths)
        return _core.map_color(self, at._core, count_of(points=at, wavelengths=w), w._core(), use)  # type: ignore[no-any-return]

    def scalar(self: Any, points: Any) -> Array:
        """The number at points, such as a roughness: shape (N,)."""
        return _core.map_scalar(self, points_of(points)._core)  # type: ignore[no-any-return]


#: The functions that the class of an interface gets.
QUESTIONS: dict[str, type] = {
    "Camera": CameraQuestions,
    "EmissionShader": EmissionQuestions,
    "Job": JobQuestions,
    "LightSampler": LightSamplerQuestions,
    "ObjectMap": MapQuestions,
    "PhaseFunction": PhaseQuestions,
    "Sampler": SamplerQuestions,
    "Scene": SceneQuestions,
    "SceneObject": ObjectQuestions,
    "Shader": ShaderQuestions,
    "VolumeShader": VolumeQuestions,
    "WavelengthSampler": WavelengthSamplerQuestions,
}


def questions_of(name: str) -> dict[str, Any]:
    """The functions for a class of the registry, by their names; empty: none."""
    owner: Optional[type] = QUESTIONS.get(name)
    return {} if owner is None else {k: v for k, v in vars(owner).items() if not k.startswith("_")}
