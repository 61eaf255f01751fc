"""Pictures: their pixels as arrays, display, files, comparison, light groups."""

from __future__ import annotations

import os
import re
import struct
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NoReturn, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _core
from ._classes import Part, class_named

Path = Union[str, "os.PathLike[str]"]
Doubles = npt.NDArray[np.float64]
Bytes = npt.NDArray[np.uint8]


# The channel of a band, as spectral films and the layout of Fichet, Pacanowski & Wilkie 2021 name it, in nanometres.
_BAND = re.compile(r"S0\.(\d+,?\d*)nm")


class Image:
    """A picture: linear values in named channels, which do not change.

    A render's picture has the channels X, Y, Z (CIE 1931, Y = 1 for a flat spectrum of 1 W/(m² sr nm)), and the layers that its
    image buffer asks for as further channels, named "layer.part" as in OpenEXR. Pictures come from `render`, from
    `Render.snapshot`, from files (`read_image`) and from arrays (`Image.from_array`). `numpy.asarray(image)` is `image.pixels`,
    so arithmetic is NumPy's; `image.with_pixels(array)` makes a picture of its result.
    """

    __slots__ = ("_picture", "_pixels", "_tone_map", "__weakref__")

    def __init__(self, picture: _core.Picture, tone_map: Optional[Part] = None) -> None:
        if not isinstance(picture, _core.Picture):
            _fail("a picture is made by Image.from_array(array), read_image(file) or render(job)")
        self._picture = picture
        self._pixels: Doubles = picture.pixels
        self._tone_map = tone_map

    # ---- making ---------------------------------------------------------------------------------------------------------------

    @staticmethod
    def from_array(
        array: npt.ArrayLike,
        *,
        channels: Optional[Sequence[str]] = None,
        color_space: Optional[str] = None,
        transfer: Optional[str] = None,
        metadata: Optional[Mapping[str, str]] = None,
        tone_map: Optional[Part] = None,
        allow_not_finite: bool = False,
    ) -> Image:
        """A picture of a copy of an array.

        array: shape (height, width) for grey, or (height, width, channels), rows from top to bottom; floating point numbers, or
            unsigned integers of 8 or 16 bits, which need a `transfer`.
        channels: the names; by default R, G, B, or X, Y, Z if color_space is "xyz". Layers are named "layer.part": "depth.Z".
        color_space: of R, G, B: "srgb", "rec2020", "acescg", …; by default "srgb".
        transfer: how R, G, B are encoded: "linear" (the default for floating point numbers), "srgb", …; integers are first divided
            by 255 or 65535.
        tone_map: how the picture is shown; None: the values as they are, in sRGB, cut off at 0 and 1.
        allow_not_finite: accept colours that are infinite or not a number.

        Raises Error for other shapes and types of numbers, for colours that are not finite, and for unknown names.
        """
        return Image(_picture_from(array, channels, color_space, transfer, metadata or {}, allow_not_finite), tone_map)

    def with_pixels(self, array: npt.ArrayLike) -> Image:
        """A picture with other values: channels, metadata and tone map are those of this one.

        array: shape (height, width, channels); height and width may be others. Values that are not finite are accepted.
        """
        values = _numbers(array)
        if values.ndim != 3 or values.shape[2] != len(self.channels) or 0 in values.shape:
            _fail(f"expects an array of shape (height, width, {len(self.channels)}), not {values.shape}")
        numbers = np.ascontiguousarray(values, np.float64)
        return Image(_core.picture_from(numbers, self.channels, self.metadata), self._tone_map)

    # ---- values ---------------------------------------------------------------------------------------------------------------

    @property
    def pixels(self) -> Doubles:
        """All values, linear: a read-only array of shape (height, width, channels), float64. It shares the picture's memory, and
        stays valid for as long as it lives."""
        return self._pixels

    @property
    def width(self) -> int:
        """[pixels]"""
        return int(self._picture.width)

    @property
    def height(self) -> int:
        """[pixels]"""
        return int(self._picture.height)

    @property
    def shape(self) -> tuple[int, int, int]:
        """(height, width, number of channels)"""
        return (self.height, self.width, len(self.channels))

    @property
    def channels(self) -> list[str]:
        """The names of the channels: "X", "Y", "Z" or "R", "G", "B", and "layer.part"."""
        return list(self._picture.channels)

    @property
    def metadata(self) -> dict[str, str]:
        """A copy of the texts that are written into files: "color_space", "seed", "samples", "renderer", …"""
        return dict(self._picture.metadata)

    @property
    def tone_map(self) -> Optional[Part]:
        """The tone map by which the picture is shown: the job's, of a rendered picture. None: the values as they are."""
        return self._tone_map

    @property
    def layers(self) -> list[str]:
        """The names of the layers: "albedo", "depth", "light.key", …"""
        return list(dict.fromkeys(name.rpartition(".")[0] for name in self.channels if "." in name))

    def layer(self, name: str) -> Doubles:
        """The values of a layer or channel: shape (height, width, n) for n channels, (height, width) for one.

        "albedo" is linear sRGB, "normal" unit vectors and "position" points [m] in world space, "depth" a distance [m],
        "motion.next" and "motion.previous" ways [pixels], "object" a number, "variance" the variance of Y, "samples" a count,
        and "length_2" and "light.key" are X, Y, Z. The array is a read-only view where the
        channels lie side by side, as in all pictures that are rendered.
        """
        channels = self.channels
        if name in channels:
            places = [channels.index(name)]
        else:
            places = [i for i, channel in enumerate(channels) if channel.rpartition(".")[0] == name and "." in channel]
        if not places:
            _fail(f"the picture has no layer or channel '{name}'; it has {', '.join(self.layers + channels)}")
        return self._taken(places)

    def __getitem__(self, name: str) -> Doubles:
        """image["depth"], image["Y"]: the same as `layer`."""
        if not isinstance(name, str):
            _fail("a picture is indexed by the name of a layer or channel; its numbers are image.pixels[y, x, channel]")
        return self.layer(name)

    def __contains__(self, name: object) -> bool:
        return name in self.layers or name in self.channels

    def _taken(self, places: list[int]) -> Doubles:
        if len(places) == 1:
            return self._pixels[:, :, places[0]]
        if places == list(range(places[0], places[0] + len(places))):
            return self._pixels[:, :, places[0] : places[-1] + 1]
        return self._pixels[:, :, places]

    @property
    def wavelengths(self) -> Doubles:
        """The wavelengths [nm] in the middle of the bands of a spectral picture, increasing; empty: it has none."""
        return np.array([wavelength for wavelength, _ in self._bands()], dtype=np.float64)

    @property
    def band_edges(self) -> Doubles:
        """The edges [nm] of the bands of a spectral picture, one more than there are bands; empty: not known."""
        edges = np.array([float(edge) for edge in self.metadata.get("band_edges", "").split()], dtype=np.float64)
        return edges if len(edges) == len(self._bands()) + 1 else edges[:0]

    @property
    def spectrum(self) -> Doubles:
        """The mean spectral radiance [W/(m² sr nm)] in each band: shape (height, width, bands), in the order of `wavelengths`.

        Raises Error if the picture has no bands: ImageBuffer is then to be replaced by SpectralFilm.
        """
        bands = self._bands()
        if not bands:
            _fail("the picture has no spectrum: its image is no SpectralFilm")
        return self._taken([place for _, place in bands])

    @property
    def stokes(self) -> Doubles:
        """The Stokes vectors: shape (height, width, 4, 3), S0 to S3 in the three colours of the picture, which is S0.

        Raises Error if the picture has none: render it by PolarizedPathTracer, with the layer "stokes" of the image.
        """
        colors, places = self.channels[:3], [0, 1, 2]
        for part in ("S1", "S2", "S3"):
            for color in colors:
                if f"{part}.{color}" not in self.channels:
                    _fail('the picture has no Stokes vectors: the layer "stokes" of its image is needed')
                places.append(self.channels.index(f"{part}.{color}"))
        return self._taken(places).reshape(self.height, self.width, 4, 3)

    def _bands(self) -> list[tuple[float, int]]:
        """The wavelength [nm] and the channel of each band, by wavelength."""
        found = ((_BAND.fullmatch(name), place) for place, name in enumerate(self.channels))
        return sorted((float(match[1].replace(",", ".")), place) for match, place in found if match)

    def xyz(self) -> Doubles:
        """The colours as CIE 1931 X, Y, Z: shape (height, width, 3); a view if the picture has these channels."""
        return self._colors("xyz")

    def rgb(self, space: str = "srgb") -> Doubles:
        """The colours as linear R, G, B of a colour space: shape (height, width, 3). They may be negative or exceed 1.

        space: "srgb", "display_p3", "rec2020", "adobe_rgb", "aces2065-1", "acescg". Raises Error for other names.
        """
        return self._colors(space)

    def _colors(self, space: str) -> Doubles:
        name = _core.color_space_named(space)
        image = Image(_core.converted(self._picture, name))
        channels = image.channels
        return image._taken([channels.index(c) for c in ("XYZ" if name == "xyz" else "RGB")])

    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> Any:
        if copy or (dtype is not None and np.dtype(dtype) != np.float64):
            return np.array(self._pixels, dtype=dtype)
        return self._pixels

    # ---- display --------------------------------------------------------------------------------------------------------------

    def to_uint8(self, tone_map: Optional[Part] = None) -> Bytes:
        """The picture for a display, as the program writes it to a PNG: shape (height, width, 3), encoded, from 0 to 255.

        tone_map: instead of the picture's own; NoToneMap() shows the values as they are.
        """
        return _shown(self, tone_map)

    def to_bytes(self, tone_map: Optional[Part] = None) -> bytes:
        """The same as the bytes of a PNG file of 8 bits."""
        return png(self.to_uint8(tone_map))

    def _repr_png_(self) -> bytes:
        return self.to_bytes()

    def save(self, file: Path, *, tone_map: Optional[Part] = None, **members: Any) -> None:
        """Writes the picture by the output for the file's ending: .png and .tga as it is shown, .exr, .hdr and .npy linear.

        tone_map: instead of the picture's own; for a linear format by default none.
        members: of the output: save("a.png", bits=16), save("a.npy", layers=True).
        The file is written whole or not at all. Raises Error for unknown endings, and if it cannot be written.
        """
        path = os.fspath(file)
        ending = os.path.splitext(path)[1].lower()
        formats = {known: (name, display) for known, name, display in _core.output_formats()}
        if ending not in formats:
            _fail(f"cannot write '{path}': no output has this ending; known are {', '.join(formats)}")
        name, display = formats[ending]
        shown = tone_map if tone_map is not None or not display else self._tone_map
        _core.write_picture(self._picture, class_named(name)(**members), shown, path)

    def describe(self) -> str:
        """Size, metadata and the range of each channel, as lines of text."""
        return str(_core.describe_picture(self._picture))

    def __repr__(self) -> str:
        colors = " ".join(c for c in self.channels if "." not in c)
        layers = f", layers {', '.join(self.layers)}" if self.layers else ""
        samples = self.metadata.get("samples")
        count = f", {samples} sample{'s' if samples != '1' else ''} per pixel" if samples else ""
        return f"<etendue.Image {self.width} x {self.height}, {colors}{layers}{count}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return (_read_image, (np.array(self._pixels), self.channels, self.metadata, self._tone_map))


def _read_image(pixels: Doubles, channels: list[str], metadata: dict[str, str], tone_map: Optional[Part]) -> Image:
    return Image(_core.picture_from(np.ascontiguousarray(pixels), channels, metadata), tone_map)


def _fail(message: str) -> NoReturn:
    _core.fail(message)
    raise AssertionError(message)


# ---- arrays ---------------------------------------------------------------------------------------------------------------------


def _numbers(array: npt.ArrayLike) -> npt.NDArray[Any]:
    values = np.asarray(array)
    if values.dtype.kind not in "fu":
        _fail(f"a picture cannot be an array of {values.dtype}: expects floating point numbers, or uint8 or uint16")
    if values.dtype.kind == "u" and values.dtype.itemsize > 2:
        _fail(f"a picture cannot be an array of {values.dtype}: integers are of 8 or 16 bits")
    return values


def _picture_from(
    array: npt.ArrayLike,
    names: Optional[Sequence[str]],
    color_space: Optional[str],
    transfer: Optional[str],
    metadata: Mapping[str, str],
    allow_not_finite: bool,
) -> _core.Picture:
    values = _numbers(array)
    if values.ndim not in (2, 3) or 0 in values.shape:
        _fail(f"a picture cannot be an array of shape {values.shape}: expects (height, width) or (height, width, channels)")
    if values.dtype.kind == "u":
        if transfer is None:
            _fail(
                f"an array of {values.dtype} has no stated encoding: give transfer='srgb' for values of a display, or 'linear'"
            )
        values = values / np.iinfo(values.dtype).max
    values = values.astype(np.float64)
    if values.ndim == 2:
        values = values[:, :, np.newaxis]
    if values.shape[2] == 1 and names is None:
        values = np.repeat(values, 3, axis=2)
    if names is None and values.shape[2] != 3:
        _fail(f"give the names of the {values.shape[2]} channels, as in channels=['R', 'G', 'B', 'A']")
    channels = list(names) if names is not None else list("XYZ" if color_space == "xyz" else "RGB")
    space = _checked_names(channels, values.shape[2], color_space)
    colors = [channels.index(c) for c in ("XYZ" if space == "xyz" else "RGB")]
    if transfer is not None and transfer != "linear":
        if transfer not in _core.transfers():
            _fail(f"there is no transfer '{transfer}'; known are {', '.join(_core.transfers())}")
        for place in colors:
            plane = np.ascontiguousarray(values[:, :, place])
            values[:, :, place] = _core.decode_transfer(transfer, plane.ravel()).reshape(plane.shape)
    if not allow_not_finite:
        _require_finite(values, channels, colors)
    texts = {**metadata, "color_space": space}
    if space != "xyz":
        texts["transfer"] = "linear"
    for key, text in texts.items():
        if not isinstance(key, str) or not isinstance(text, str):
            _fail(f"metadata are texts, not {key!r}: {text!r}")
    picture: _core.Picture = _core.picture_from(np.ascontiguousarray(values), channels, texts)
    return picture


def _checked_names(channels: list[str], count: int, color_space: Optional[str]) -> str:
    """The name of the colour space of these channels."""
    if len(channels) != count:
        _fail(f"{len(channels)} names for {count} channels: {', '.join(map(str, channels))}")
    if not all(isinstance(c, str) and c for c in channels):
        _fail(f"the names of channels are texts, not {channels!r}")
    if len(set(channels)) < len(channels):
        _fail(f"each channel needs a name of its own: {', '.join(channels)}")
    is_xyz = set("XYZ") <= set(channels)
    if not is_xyz and not set("RGB") <= set(channels):
        _fail(f"a picture needs channels X, Y, Z or R, G, B; it has {', '.join(channels)}")
    space = str(_core.color_space_named(color_space if color_space is not None else "xyz" if is_xyz else "srgb"))
    if (space == "xyz") != is_xyz:
        _fail(f"channels {', '.join(channels)} cannot be in the colour space '{space}'")
    return space


def _require_finite(values: Doubles, channels: list[str], colors: list[int]) -> None:
    bad = ~np.isfinite(values[:, :, colors])
    if bad.any():
        y, x, c = (int(i) for i in np.argwhere(bad)[0])
        count = int(bad.any(axis=2).sum())
        _fail(
            f"{channels[colors[c]]} of pixel {x},{y} is {values[y, x, colors[c]]}"
            + (f", and {count} pixels in all have colours that are not finite" if count > 1 else "")
            + "; allow_not_finite=True accepts them"
        )


# ---- display --------------------------------------------------------------------------------------------------------------------


def _shown(image: Image, tone_map: Optional[Part]) -> Bytes:
    shown = tone_map if tone_map is not None else image.tone_map
    result: Bytes = _core.eight_bits(_core.displayed(image._picture, shown))
    return result


def png(pixels: Bytes) -> bytes:
    """The bytes of a PNG file in sRGB; pixels: shape (height, width, 3), 8 bits."""
    height, width = pixels.shape[:2]
    rows = pixels.reshape(height, 3 * width)
    left = np.zeros_like(rows)
    left[:, 3:] = rows[:, :-3]
    above = np.zeros_like(rows)
    above[1:] = rows[:-1]
    # Of each row the one of the filters None, Sub and Up whose differences are smallest (PNG specification, section 12.8).
    filtered = np.stack([rows, rows - left, rows - above])
    best = np.abs(filtered.view(np.int8).astype(np.int16)).sum(axis=2).argmin(axis=0)
    lines = np.concatenate([best.astype(np.uint8)[:, np.newaxis], filtered[best, np.arange(height)]], axis=1)

    def chunk(kind: bytes, content: bytes) -> bytes:
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", header)
        + chunk(b"sRGB", b"\0")
        + chunk(b"IDAT", zlib.compress(lines.tobytes(), 6))
        + chunk(b"IEND", b"")
    )


# ---- files ----------------------------------------------------------------------------------------------------------------------


def read_image(file: Path) -> Image:
    """Reads a picture: any format of the image library (.exr, .png, .jpg, .hdr, .tif, …), and NumPy's arrays (.npy).

    Values are linear: integer formats without a stated encoding are decoded from sRGB. The metadata "color_space" is that of the
    file, else "xyz" for arrays and "srgb" for others. Raises Error with the file and the reason.
    """
    path = os.fspath(file)
    picture = _core.read_picture(path)
    ending = os.path.splitext(path)[1].lower()
    linear = any(ending == known and not display for known, _, display in _core.output_formats())
    # A file of a display's format was tone mapped when it was written.
    return Image(picture, class_named("Job")().tone_map if linear else None)


# ---- comparison -----------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class ChannelComparison:
    """The difference of a channel between two pictures."""

    name: str
    mean_a: float
    mean_b: float
    ratio: float  #: of the means, a over b; 1 when both are zero
    root_mean_square_error: float
    maximum_difference: float


@dataclass(frozen=True)
class Comparison:
    """The difference of a picture a from a reference b, over the n values of all pixels and colours that are finite in both."""

    root_mean_square_error: float  #: sqrt(sum (a - b)² / n)
    relative_mean_square_error: float  #: sum((a - b)² / (b² + e)) / n with e = 1e-2 mean(b)²
    symmetric_error: float  #: sum(2 |a - b| / (|a| + |b|)) / n, from 0 to 2
    maximum_difference: float  #: largest |a - b|
    maximum_x: int  #: pixel of the largest difference
    maximum_y: int
    maximum_channel: str
    not_finite: int  #: number of omitted values; the errors are NaN if no values remain
    channels: tuple[ChannelComparison, ...]


@dataclass(frozen=True)
class TileRatios:
    """Mean luminances of the same tiles in two pictures: arrays of shape (rows of tiles, columns of tiles)."""

    ratio: Doubles  #: a over b; 1 when both are zero
    mean_a: Doubles
    mean_b: Doubles


def _as_image(given: Union[Image, Path]) -> Image:
    if isinstance(given, Image):
        return given
    if isinstance(given, (str, os.PathLike)):
        return read_image(given)
    _fail(f"expects a picture or the name of a file, not {type(given).__name__}; Image.from_array makes pictures of arrays")


def compare_images(a: Union[Image, Path], b: Union[Image, Path], color_space: str = "xyz") -> Comparison:
    """Compares the colours of two pictures or files, after converting both to a colour space; b is the reference.

    Raises Error if their sizes differ.
    """
    result = _core.compare(_as_image(a)._picture, _as_image(b)._picture, _core.color_space_named(color_space))
    channels = tuple(ChannelComparison(**c) for c in result.pop("channels"))
    return Comparison(**result, channels=channels)


def tile_ratios(a: Union[Image, Path], b: Union[Image, Path], size: int = 16) -> TileRatios:
    """The ratios of the mean luminances of all tiles of size x size pixels (smaller at the right and lower edge).

    Raises Error if the pictures' sizes differ.
    """
    return TileRatios(*_core.tile_ratios(_as_image(a)._picture, _as_image(b)._picture, size))


# ---- light groups ---------------------------------------------------------------------------------------------------------------


def light_groups(image: Image) -> dict[str, Doubles]:
    """The light of each group as X, Y, Z, shape (height, width, 3); their sum is the picture. Empty: it has no groups.

    Groups are layers of the image buffer: ImageBuffer(layers=["light.key", "light.window + sky"]).
    """
    prefix = "light."
    return {name[len(prefix) :]: image.layer(name) for name in image.layers if name.startswith(prefix)}


def relight(image: Image, factors: Mapping[str, Union[float, Sequence[float]]]) -> Image:
    """The picture with the light of its groups multiplied by factors: relight(image, {"key": 0.5, "window": (1, 0.8, 0.6)}).

    A factor is a number, or three for R, G, B of linear sRGB; groups without factors stay unchanged. Layers of the noise, and of
    the light by path length, would not match and are left out. Raises Error if the picture has no such group.
    """
    triples: dict[str, list[float]] = {}
    known = light_groups(image)
    for name, factor in factors.items():
        if known and name not in known:
            _fail(f"the picture has no light group '{name}'; it has {', '.join(known)}")
        values = np.atleast_1d(np.asarray(factor, np.float64))
        if values.shape not in ((1,), (3,)) or not np.isfinite(values).all():
            _fail(f"the factor of '{name}' is a number, or three for R, G, B, not {factor!r}")
        triples[name] = [float(v) for v in np.broadcast_to(values, 3)]
    return Image(_core.relight(image._picture, triples), image.tone_map)
