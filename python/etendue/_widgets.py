"""Pictures in notebooks and pages: self-contained HTML without a server."""

from __future__ import annotations

import base64
import html
import itertools
import math
import os
import uuid
from collections.abc import Sequence
from typing import Any, Optional, Union

import numpy as np

from . import _core
from ._classes import Part
from ._images import Bytes, Doubles, Image, Path, _as_image, _fail, compare_images, png, tile_ratios

_numbers = itertools.count()

# Colours are inherited from the page, so that text is readable on light and dark backgrounds.
_STYLE = """
#NAME{display:inline-block;width:WIDTHpx;max-width:100%;font:13px/1.5 system-ui,sans-serif;color:inherit}
#NAME *{box-sizing:border-box}
#NAME .view{position:relative;line-height:0;border-radius:4px;overflow:hidden}
#NAME .view img{display:block;width:100%;max-width:none;height:auto;margin:0;RENDERING}
#NAME .view .over{position:absolute;inset:0;height:100%}
#NAME .row{display:flex;align-items:center;gap:.7em;margin-top:.4em}
#NAME .row input{flex:1;min-width:4em;margin:0;accent-color:#3b82f6}
#NAME .row output{min-width:5.5em;text-align:right;font-variant-numeric:tabular-nums}
#NAME .label{position:absolute;bottom:8px;padding:0 .6em;border-radius:1em;line-height:1.7;color:#fff;background:#000a}
#NAME table{border-collapse:collapse;margin-top:.5em;color:inherit;background:none}
#NAME td{padding:0 1em 0 0;text-align:left;border:none;background:none;color:inherit;font:inherit}
#NAME td:first-child{white-space:nowrap}
#NAME td+td{font-variant-numeric:tabular-nums}
#NAME .note{opacity:.75}
"""


class Widget:
    """Something that a notebook shows: self-contained HTML."""

    def __init__(self, body: str, style: str, width: int, pixels: int, title: str) -> None:
        """width: of the widget [CSS pixels]; pixels: of the picture."""
        name = f"etendue-{uuid.uuid4().hex[:8]}-{next(_numbers)}"
        rendering = "image-rendering:pixelated" if width > pixels else ""
        sheet = (_STYLE + style).replace("NAME", name).replace("WIDTH", str(width)).replace("RENDERING", rendering)
        self._html = f'<div id="{name}"><style>{sheet}</style>{body}</div>'
        self._title = title

    def _repr_html_(self) -> str:
        return self._html

    def save(self, file: Path) -> None:
        """Writes a page, which needs no other file. Raises OSError if it cannot be written."""
        with open(os.fspath(file), "w", encoding="utf-8") as page:
            page.write(
                f'<!DOCTYPE html>\n<html lang="en"><meta charset="utf-8"><meta name="color-scheme" content="light dark">'
                f'<title>{html.escape(self._title)}</title><body style="margin:2em">{self._html}</body></html>\n'
            )

    def __repr__(self) -> str:
        return f"<etendue.Widget, {self._title}>"


def _source(pixels: Bytes) -> str:
    return "data:image/png;base64," + base64.b64encode(png(pixels)).decode()


def _img(pixels: Bytes, attributes: str = "") -> str:
    height, width = pixels.shape[:2]
    return f'<img width="{width}" height="{height}" alt="" src="{_source(pixels)}" {attributes}>'


def _width_of(image: Image) -> int:
    """Small pictures are enlarged by a whole number, to at least 320 CSS pixels."""
    return image.width * math.ceil(320 / image.width) if image.width < 320 else min(image.width, 1024)


def live_html(image: Image, text: str) -> str:
    """The picture of a running render, with a line of text."""
    return Widget(
        f'<div class="view">{_img(image.to_uint8())}</div><div class="note">{html.escape(text)}</div>',
        "",
        _width_of(image),
        image.width,
        "a render",
    )._repr_html_()


# ---- one picture ----------------------------------------------------------------------------------------------------------------


def _exposed(image: Image, tone_map: Optional[Part], stops: float) -> Bytes:
    """The picture for a display, with a brighter exposure."""
    shown: Any = tone_map if tone_map is not None else image.tone_map
    if stops == 0:
        return image.to_uint8(shown)
    if shown is not None and _core.has_member(shown, "stops"):
        shown = _core.copy(shown)
        shown.stops = shown.stops + stops
        return image.to_uint8(shown)
    return image.with_pixels(image.pixels * 2.0**stops).to_uint8(shown)


def show(
    image: Union[Image, Path], *, tone_map: Optional[Part] = None, exposure: bool = True, title: Optional[str] = None
) -> Widget:
    """A picture with a slider for the exposure, from 4 stops below the picture's own to 4 above.

    image: a picture, or a file. tone_map: instead of the picture's own. exposure: False leaves the slider out: a ninth of the size.
    """
    image = _as_image(image)
    range_of_stops = range(-4, 5) if exposure else range(0, 1)
    layers = []
    # Each picture fades in above the one that is a stop darker.
    for stops in range_of_stops:
        first = stops == range_of_stops[0]
        fade = "" if first else f'class="over" style="opacity:clamp(0,calc(var(--stops) - {stops - 1}),1)"'
        layers.append(_img(_exposed(image, tone_map, stops), fade))
    body = f'<div class="view" style="--stops:0">{"".join(layers)}</div>'
    if exposure:
        body += (
            '<label class="row">exposure<input type="range" min="-4" max="4" step="0.1" value="0" oninput="'
            "this.parentNode.previousElementSibling.style.setProperty('--stops',this.value);"
            "this.nextElementSibling.value=(this.value&gt;0?'+':'')+(+this.value).toFixed(1).replace('-','−')+' stops'\">"
            "<output>0.0 stops</output></label>"
        )
    if title:
        body += f'<div class="note">{html.escape(title)}</div>'
    return Widget(body, "", _width_of(image), image.width, title or repr(image).strip("<>"))


# ---- several pictures -----------------------------------------------------------------------------------------------------------


def _common_tone_map(image: Image) -> Optional[Part]:
    """The tone map of a picture with the exposure that it has there, so that other pictures can be compared with it."""
    shown: Any = image.tone_map
    if shown is None or not _core.has_member(shown, "stops"):
        return image.tone_map
    factor = _core.exposure_factor(image._picture, shown)
    if factor is None:
        return image.tone_map
    fixed: Any = _core.copy(shown)
    fixed.exposure = "fixed"
    fixed.stops = math.log2(factor)
    result: Part = fixed
    return result


def side_by_side(
    *images: Union[Image, Path], labels: Optional[Sequence[str]] = None, tone_map: Optional[Part] = None
) -> Widget:
    """Pictures of one size with a divider that can be dragged; of more than two, the left and the right one can be chosen.

    labels: texts for the pictures, by default a, b, c, …, or the names of files. tone_map: for all pictures; by default that of the
        first one, with its exposure, so that differences of brightness are seen. Raises Error if the sizes differ.
    """
    if len(images) < 2:
        _fail("expects at least two pictures")
    pictures = [_as_image(i) for i in images]
    first = pictures[0]
    for other in pictures[1:]:
        if (other.width, other.height) != (first.width, first.height):
            _fail(f"the pictures differ in size: {first.width} x {first.height} and {other.width} x {other.height} pixels")
    names = list(labels) if labels is not None else [_name_of(i, n) for n, i in enumerate(images)]
    if len(names) != len(pictures):
        _fail(f"{len(names)} labels for {len(pictures)} pictures")
    shown = tone_map if tone_map is not None else _common_tone_map(first)
    encoded = [p.to_uint8(shown) for p in pictures]
    texts = [html.escape(n) for n in names]
    second = _img(encoded[1], 'class="over right"')
    body = (
        f'<div class="view" style="--at:50%">{_img(encoded[0])}{second}'
        f'<div class="line"></div><span class="label" style="left:8px">{texts[0]}</span>'
        f'<span class="label" style="right:8px">{texts[1]}</span>'
        '<input type="range" min="0" max="100" step="0.1" value="50" aria-label="divider" class="drag" '
        "oninput=\"this.parentNode.style.setProperty('--at',this.value+'%')\"></div>"
    )
    if len(pictures) > 2:
        body += _choices(encoded, texts)
    style = (
        "#NAME .right{clip-path:inset(0 0 0 var(--at))}"
        "#NAME .line{position:absolute;top:0;bottom:0;left:var(--at);width:2px;margin-left:-1px;background:#fff;"
        "box-shadow:0 0 3px #000}"
        "#NAME .line::after{content:'';position:absolute;top:50%;left:50%;width:26px;height:26px;margin:-13px;"
        "border-radius:50%;border:2px solid #fff;background:#0006;box-shadow:0 0 3px #000}"
        "#NAME .drag{position:absolute;inset:0;width:100%;height:100%;margin:0;opacity:0;cursor:ew-resize}"
        "#NAME select{font:inherit}"
    )
    return Widget(body, style, _width_of(first), first.width, ", ".join(names))


def _name_of(given: Union[Image, Path], number: int) -> str:
    if isinstance(given, Image):
        return chr(ord("a") + number) if number < 26 else str(number + 1)
    return os.path.basename(os.fspath(given))


def _choices(encoded: list[Bytes], texts: list[str]) -> str:
    """Two lists from which the left and the right picture are chosen."""
    lists = ""
    for side, (image, label, chosen) in enumerate([("img:not(.over)", 0, 0), ("img.over", 1, 1)]):
        options = "".join(f"<option{' selected' if n == chosen else ''}>{t}</option>" for n, t in enumerate(texts))
        script = (
            "var w=this.closest('[id]'),v=w.querySelector('.view');"
            f"v.querySelector('{image}').src=w.querySelectorAll('.all img')[this.selectedIndex].src;"
            f"v.querySelectorAll('.label')[{label}].textContent=this.value"
        )
        lists += f'<label>{("left", "right")[side]} <select onchange="{script}">{options}</select></label>'
    stored = "".join(_img(p) for p in encoded)
    return f'<div class="row" style="justify-content:space-between">{lists}</div><div class="all" hidden>{stored}</div>'


# ---- differences ----------------------------------------------------------------------------------------------------------------

# Black where pictures are equal, blue where the first is darker, orange where it is brighter: sRGB at -1, -1/2, 0, 1/2, 1.
_DIVERGING = np.array([[0.66, 0.92, 1.0], [0.16, 0.47, 0.86], [0.07, 0.07, 0.08], [0.82, 0.34, 0.10], [1.0, 0.87, 0.50]])
_NOT_FINITE = np.array([1.0, 0.0, 1.0])


def _diverging(values: Doubles) -> Doubles:
    """Colours, shape (…, 3), of values from -1 to 1; others are cut off."""
    at = np.linspace(-1, 1, len(_DIVERGING))
    return np.stack([np.interp(values, at, _DIVERGING[:, c]) for c in range(3)], axis=-1)


def _rounded_up(value: float) -> float:
    """To 1, 2 or 5 times a power of ten."""
    if not value > 0 or not math.isfinite(value):
        return 1.0
    power = 10.0 ** math.floor(math.log10(value))
    return next(step * power for step in (1, 2, 5, 10) if step * power >= value * (1 - 1e-9))


def difference(
    a: Union[Image, Path],
    b: Union[Image, Path],
    *,
    relative: bool = True,
    tile: int = 1,
    limit: Optional[float] = None,
    labels: tuple[str, str] = ("a", "b"),
) -> Widget:
    """The difference of the luminances of a picture a from a reference b, in false colours with a legend and the errors.

    relative: divided by b + 1 % of its mean, so that dark pixels count as bright ones do; False: a - b itself.
    tile: side of the squares whose means are compared [pixels]; larger ones show less noise.
    limit: the value at the ends of the scale; by default a round number that 98 % of the pixels do not exceed.
    Raises Error if the sizes differ.
    """
    a, b = _as_image(a), _as_image(b)
    if limit is not None and not limit > 0:
        _fail(f"limit is the end of the scale, more than 0, not {limit}")
    errors = compare_images(a, b)
    tiles = tile_ratios(a, b, tile)
    ya, yb = tiles.mean_a, tiles.mean_b
    if tile == 1:
        ya, yb = a.xyz()[:, :, 1], b.xyz()[:, :, 1]
    finite = np.isfinite(ya) & np.isfinite(yb)
    with np.errstate(all="ignore"):
        values = ya - yb
        if relative:
            mean = float(yb[finite].mean()) if finite.any() else 0.0
            values = np.where(values == 0, 0.0, values / (np.abs(yb) + 1e-2 * abs(mean)))
    finite &= np.isfinite(values)
    size = np.abs(values[finite])
    end = limit if limit is not None else _rounded_up(float(np.quantile(size, 0.98)) if size.size else 1.0)
    colors = np.where(finite[..., np.newaxis], _diverging(np.where(finite, values, 0) / end), _NOT_FINITE)
    pixels: Bytes = np.repeat(np.repeat((255 * colors + 0.5).astype(np.uint8), tile, axis=0), tile, axis=1)
    pixels = np.ascontiguousarray(pixels[: a.height, : a.width])
    names = (html.escape(labels[0]), html.escape(labels[1]))
    beyond = float((size > end).mean()) if size.size else 0.0
    body = f'<div class="view">{_img(pixels)}</div>' + _legend(end, relative, names) + _error_table(errors, beyond, finite)
    style = (
        "#NAME .scale{height:12px;margin-top:.7em;border-radius:3px;border:1px solid #8888}"
        "#NAME .ticks{display:flex;justify-content:space-between;font-variant-numeric:tabular-nums}"
    )
    return Widget(body, style, _width_of(a), a.width, f"difference of {labels[0]} from {labels[1]}")


def _legend(end: float, relative: bool, names: tuple[str, str]) -> str:
    stops = ",".join(f"rgb({','.join(str(round(255 * c)) for c in color)})" for color in _DIVERGING)
    ticks = [f"{100 * v * end:+.3g} %" if relative else f"{v * end:+.3g}" for v in (-1, -0.5, 0, 0.5, 1)]
    ticks[2] = "0"
    texts = "".join(f"<span>{t.replace('-', '−')}</span>" for t in ticks)
    what = f"{'relative ' if relative else ''}difference of luminance, {names[0]} − {names[1]}"
    return (
        f'<div class="scale" style="background:linear-gradient(90deg,{stops})"></div><div class="ticks">{texts}</div>'
        f'<div class="note">{what}</div>'
    )


def _error_table(errors: Any, beyond: float, finite: Any) -> str:
    rows = [
        ("root mean square error", f"{errors.root_mean_square_error:.4g}"),
        ("relative mean square error", f"{errors.relative_mean_square_error:.4g}"),
        ("symmetric error", f"{100 * errors.symmetric_error:.3g} %"),
        (
            "largest difference",
            f"{errors.maximum_difference:.4g} in {html.escape(errors.maximum_channel)} of pixel "
            f"{errors.maximum_x},{errors.maximum_y}",
        ),
        ("beyond the scale", f"{100 * beyond:.2g} % of the pixels"),
    ]
    if not errors.maximum_channel:
        rows[3] = ("largest difference", "none: all values are equal")
    bad = int((~finite).sum())
    if bad:
        rows.append(('not finite <span style="color:#f0f">■</span>', str(bad)))
    return "<table>" + "".join(f"<tr><td>{name}</td><td>{value}</td></tr>" for name, value in rows) + "</table>"
