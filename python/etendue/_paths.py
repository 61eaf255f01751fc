"""Paths of single samples."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

Doubles = npt.NDArray[np.float64]
Floats = npt.NDArray[np.float32]


@dataclass(frozen=True)
class PathVertices:
    """The n vertices of a subpath. Spectra have the path's wavelengths: shape (n, wavelengths)."""

    kind: tuple[str, ...]  #: "camera", "surface", "escaped", …
    object: tuple[str, ...]  #: the name of the object, or its class
    position: Doubles  #: in world space, shape (n, 3) [m]
    normal: Doubles  #: shape (n, 3)
    lobe: tuple[str, ...]  #: the lobe that was sampled; empty: the path ended
    pdf: Floats  #: of the sampled direction [1/sr], shape (n,); a probability for specular lobes
    throughput: Floats  #: of the path up to the vertex, before scattering
    emitted: Floats  #: weighted contribution of the emitter hit at the vertex [W/(m² sr nm)]
    direct: Floats  #: weighted contribution of next event estimation from the vertex [W/(m² sr nm)]
    note: tuple[str, ...]  #: on roulette, dispersion, media, …

    def __len__(self) -> int:
        return len(self.kind)


@dataclass(frozen=True)
class PathContributions:
    """The n contributions of strategies."""

    strategy: tuple[str, ...]  #: "emitter hit", "next event estimation", or the numbers of vertices from luminaire and camera
    length: npt.NDArray[np.int32]  #: segments from the lens to the luminaire, shape (n,)
    weight: Floats  #: of multiple importance sampling, shape (n,)
    value: Floats  #: weighted, shape (n, wavelengths) [W/(m² sr nm)]
    film: Doubles  #: the film point it is added to, shape (n, 2) [pixels]
    splat: tuple[bool, ...]  #: added to that film point as a splat, and not part of the sample's own radiance

    def __len__(self) -> int:
        return len(self.strategy)


@dataclass(frozen=True)
class PathRecord:
    """One sample, with its path. str(record) is a text of everything."""

    film: tuple[float, float]  #: the film point (x, y) [pixels]
    vertices: PathVertices  #: from the camera
    light_vertices: PathVertices  #: from a luminaire, if the renderer traces light subpaths
    contributions: PathContributions
    wavelengths: Floats  #: [nm]
    result: Floats  #: the sample's radiance at the wavelengths [W/(m² sr nm)]
    text: str = field(repr=False)

    def __str__(self) -> str:
        return self.text


def path_from(record: dict[str, Any]) -> PathRecord:
    vertices = PathVertices(**record.pop("vertices"))
    light_vertices = PathVertices(**record.pop("light_vertices"))
    contributions = PathContributions(**record.pop("contributions"))
    return PathRecord(vertices=vertices, light_vertices=light_vertices, contributions=contributions, **record)
