"""Wavelengths, spectra and colours."""

from __future__ import annotations

from typing import Any, Literal, Union

import numpy as np

from . import _core
from ._arrays import Array, array, count_of, places, rows
from ._errors import Error

ColorUse = Literal["reflectance", "radiance", "coefficient"]


class Wavelengths:
    """The wavelengths of paths, a few for each: the first is the hero wavelength, which alone decides directions at surfaces that
    disperse light.

    nm: shape (N, K) [nm], with K up to as many as a path of the program carries (8).
    pdf: shape (N, K), the pdf with which each was sampled [1/nm].
    single: shape (N,), whether the secondary wavelengths were dropped.
    """

    __slots__ = ("nm", "pdf", "single")

    def __init__(self, nm: Any, pdf: Any = None, single: Any = False) -> None:
        """nm: shape (N, K) or (K,). pdf: the same shape, or one number; by default that of wavelengths uniform over 360 to 830 nm."""
        found = array(nm, "nm", np.float32)
        if found.ndim == 1:
            found = found[None]
        if found.ndim != 2 or found.shape[1] == 0:
            raise Error(f"nm: expects shape (N, K) or (K,), not {np.shape(nm)}")
        if found.size and not (found.min() >= _core.wavelength_low and found.max() <= _core.wavelength_high):
            raise Error(f"nm: expects wavelengths from {_core.wavelength_low:g} to {_core.wavelength_high:g} nm")
        usual = 1 / (_core.wavelength_high - _core.wavelength_low)
        try:
            given = np.broadcast_to(array(usual if pdf is None else pdf, "pdf", np.float32), found.shape)
            dropped = np.broadcast_to(np.asarray(single, bool), found.shape[:1])
        except ValueError:
            raise Error(f"pdf and single: expect shapes {found.shape} and {found.shape[:1]}") from None
        self.nm: Array = found
        self.pdf: Array = np.ascontiguousarray(given)
        self.single: Array = np.array(dropped)

    def __len__(self) -> int:
        return len(self.nm)

    def __getitem__(self, where: Any) -> "Wavelengths":
        """Those of some paths: by a mask, a slice or places."""
        at = places(where, len(self))
        return Wavelengths(self.nm[at], self.pdf[at], self.single[at])

    def __repr__(self) -> str:
        return f"Wavelengths({self.nm!r})"

    def drop_secondary(self, which: Any = True) -> Array:
        """Lets paths go on with their hero wavelengths only, as they must after a direction that only holds for the hero.

        which: a mask of shape (N,). Returns the factors for the throughput, shape (N, K): K for the hero and 0 for the others where
        the secondary wavelengths are dropped now, else 1. So a mean over the wavelengths stays unbiased.
        """
        try:
            dropped = np.broadcast_to(np.asarray(which, bool), (len(self),)) & ~self.single
        except ValueError:
            raise Error(f"which: expects shape ({len(self)},), not {np.shape(which)}") from None
        factor = np.ones(self.nm.shape, np.float32)
        factor[dropped] = 0
        factor[dropped, 0] = self.nm.shape[1]
        self.single = self.single | dropped
        return factor

    def to_xyz(self, values: Any) -> Array:
        """The estimate of the colour X, Y, Z of spectra from their values at the wavelengths, shape (N, K): shape (N, 3).

        X is the mean over the wavelengths of value times xbar over pdf, over the integral of ybar; a flat spectrum of 1 has Y = 1
        in the mean.
        """
        given = array(values, "values", np.float32)
        if given.ndim == 1:
            given = given[None]
        if given.ndim != 2 or given.shape[1] != self.nm.shape[1]:
            raise Error(f"values: expects shape (N, {self.nm.shape[1]}), not {np.shape(values)}")
        count = count_of(values=given, wavelengths=self)
        if self.nm.shape[1] == _core.spectrum_size:
            return _core.wavelengths_xyz(count, given, self._core())  # type: ignore[no-any-return]
        colors = _core.observer(self.nm.reshape(-1)).reshape(*self.nm.shape, 3) / self.pdf[..., None]
        return (given[..., None] * colors).mean(axis=1) / _core.observer_y_integral()  # type: ignore[no-any-return]

    def _core(self) -> tuple[Array, Array, Array]:
        return (self.nm, self.pdf, self.single if len(self.nm) else np.zeros(1, bool))


def wavelengths_of(given: Any) -> Wavelengths:
    """What a question is given as wavelengths: Wavelengths, or nanometres of shape (K,) for all items, (N, K) for each."""
    return given if isinstance(given, Wavelengths) else Wavelengths(given)


def few_wavelengths(given: Any) -> Wavelengths:
    """The same for questions about a path, which carries only a few."""
    found = wavelengths_of(given)
    if found.nm.shape[1] > _core.spectrum_size:
        raise Error(f"wavelengths: a path carries at most {_core.spectrum_size}, not {found.nm.shape[1]}")
    return found


def evaluate(spectrum: Any, wavelengths: Any, use: ColorUse = "reflectance", *, imaginary: bool = False) -> Array:
    """The values of a spectrum at wavelengths [nm] of any shape; NaN outside of 360 to 830 nm.

    spectrum: a colour or spectrum, etendue.blackbody("3000 K"), or a text of the language, "rgb(1, 0.5, 0)".
    use: what an RGB colour is used as: a reflectance, a radiance, or a coefficient. Measured spectra do not depend on it.
    imaginary: the imaginary part of a complex refractive index; 0 for real spectra.
    """
    if isinstance(wavelengths, Wavelengths):
        wavelengths = wavelengths.nm
    at = array(wavelengths, "wavelengths", np.float32)
    shape = np.shape(wavelengths)
    return _core.spectrum_evaluate(spectrum, at.reshape(-1), use, imaginary).reshape(shape)  # type: ignore[no-any-return]


def to_xyz(spectrum: Any, use: ColorUse = "reflectance", *, illuminant: Any = None) -> Array:
    """The colour X, Y, Z of a whole spectrum, shape (3,): the sum in steps of 1 nm; a flat spectrum of 1 has Y = 1.

    illuminant: a spectrum; then the colour is that of its light reflected by the spectrum, relative to a perfect white.
    """
    return _core.spectrum_xyz(spectrum, use, illuminant)  # type: ignore[no-any-return]


def observer(wavelengths: Any) -> Array:
    """The CIE 1931 colour-matching functions xbar, ybar, zbar at wavelengths [nm] of any shape: shape (..., 3); 0 outside."""
    at = array(wavelengths, "wavelengths", np.float32)
    return _core.observer(at.reshape(-1)).reshape(*np.shape(wavelengths), 3)  # type: ignore[no-any-return]


def rgb_spectra(rgb: Any, wavelengths: Any, use: ColorUse = "reflectance", *, color_space: str = "srgb") -> Array:
    """The spectra of many linear RGB colours, shape (N, 3) or (3,), at wavelengths: shape (N, K)."""
    colors = rows(rgb, 3, "rgb")
    at = wavelengths_of(wavelengths)
    return _core.rgb_spectra(count_of(rgb=colors, wavelengths=at), colors, at._core(), use, color_space)  # type: ignore[no-any-return]


def xyz_to_rgb(xyz: Any, color_space: str = "srgb", *, encode: Union[bool, str] = False) -> Array:
    """Linear R, G, B of colours X, Y, Z, shape (..., 3). encode: True, or the name of a transfer function: values are clipped to
    [0, 1] and encoded as in a file, by True with that of sRGB."""
    given = np.asarray(xyz, np.float64)
    if given.shape[-1:] != (3,):
        raise Error(f"xyz: expects shape (..., 3), not {given.shape}")
    rgb = given @ _core.rgb_matrix(color_space, True).T
    if encode is False:
        return rgb  # type: ignore[no-any-return]
    name = "srgb" if encode is True else encode
    clipped = np.ascontiguousarray(np.clip(rgb, 0, 1))
    return _core.transfer(name, clipped.reshape(-1), True).reshape(rgb.shape)  # type: ignore[no-any-return]


def rgb_to_xyz(rgb: Any, color_space: str = "srgb") -> Array:
    """X, Y, Z of linear R, G, B, shape (..., 3)."""
    given = np.asarray(rgb, np.float64)
    if given.shape[-1:] != (3,):
        raise Error(f"rgb: expects shape (..., 3), not {given.shape}")
    return given @ _core.rgb_matrix(color_space, False).T  # type: ignore[no-any-return]
