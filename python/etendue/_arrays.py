"""Arrays that questions are given: any type, stride and layout is converted once, and shapes that do not fit are errors."""

from __future__ import annotations

from typing import Any, Optional, Sequence, Union

import numpy as np
import numpy.typing as npt

from ._errors import Error

Array = npt.NDArray[Any]
Numbers = Union[npt.ArrayLike, Sequence[Any]]


def array(values: Any, what: str, dtype: npt.DTypeLike) -> Array:
    """An array of numbers of a type, in C order; without a copy if it is one already."""
    try:
        found = np.asarray(values)
        if found.dtype.kind not in "biuf":
            if found.size or found.dtype.kind != "O":
                raise TypeError(f"an array of {found.dtype}")
        return np.ascontiguousarray(found, dtype)
    except (TypeError, ValueError) as e:
        raise Error(f"{what}: expects an array of numbers ({e})") from None


def rows(values: Any, width: int, what: str, dtype: npt.DTypeLike = np.float32) -> Array:
    """An array of shape (N, width), or (1, width) for a single row of shape (width,)."""
    found = array(values, what, dtype)
    if found.ndim == 1 and found.shape[0] == width:
        found = found[None]
    elif found.size == 0 and found.ndim == 1:
        found = found.reshape(0, width)
    if found.ndim != 2 or found.shape[1] != width:
        raise Error(f"{what}: expects shape (N, {width}) or ({width},), not {np.shape(values)}")
    return found


def scalars(values: Any, what: str, dtype: npt.DTypeLike = np.float32) -> Array:
    """An array of shape (N,), or (1,) for a single number."""
    found = array(values, what, dtype)
    if found.ndim == 0 or np.ndim(values) == 0:
        return found.reshape(1)
    if found.ndim != 1:
        raise Error(f"{what}: expects shape (N,) or a number, not {found.shape}")
    return found


def integers(values: Any, width: Optional[int], what: str, dtype: npt.DTypeLike) -> Array:
    """Whole numbers of a type, checked to fit into it; shape (N, width), or (N,) with width None."""
    given = np.asarray(values)
    if given.size and given.dtype.kind not in "iu":
        raise Error(f"{what}: expects whole numbers, not {given.dtype}")
    limits = np.iinfo(np.dtype(dtype))
    if given.size and (given.min() < limits.min or given.max() > limits.max):
        raise Error(f"{what}: expects numbers from {limits.min} to {limits.max}")
    return scalars(given, what, dtype) if width is None else rows(given, width, what, dtype)


def count_of(**given: Any) -> int:
    """The number of items of a question: each array has a row for each of them, or one for all. Raises Error otherwise."""
    count = 1
    first = ""
    for what, values in given.items():
        n = len(values)
        if n == 1:
            continue
        if first and n != count:
            raise Error(f"there are {count} {first} but {n} {what}: give as many of each, or one for all")
        count, first = n, what
    return count


def places(where: Any, count: int) -> Array:
    """The places that an index of NumPy takes from the first axis: a mask, a slice or whole numbers."""
    found = np.arange(count, dtype=np.int64)[where]
    return np.ascontiguousarray(np.atleast_1d(found))
