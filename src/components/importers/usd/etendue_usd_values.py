"""Values of attributes as what they are needed for, whatever type a file gives them: a list's first, a text's file, a number for
each of several. What is read as something else is told."""
import numpy
from pxr import Sdf, UsdGeom


def array(values, kind, width=None):
    """Numbers of an attribute, which may have none."""
    try:
        found = numpy.array(values if values is not None else [], dtype=kind)
        return found if width is None else found.reshape(-1, width)
    except (TypeError, ValueError):
        raise TypeError(f"a list of {'vectors' if width else 'numbers'} is of another type: {type(values).__name__}") from None


def metres_per_unit(stage):
    """[m]. UsdGeom's own function refuses files that state it as a float."""
    return float(stage.GetMetadata("metersPerUnit")) if stage.HasAuthoredMetadata("metersPerUnit") else UsdGeom.GetStageMetersPerUnit(stage)


def single(value, what, note):
    """The first of a list."""
    if type(value).__name__.endswith("Array") or isinstance(value, (list, tuple)):
        note(f"{what} is a list: its first is taken")
        return value[0] if len(value) else None
    return value


def numbers_of(value):
    """All numbers in a value, or None."""
    try:
        found = numpy.array(value, dtype="f8").reshape(-1)
    except (TypeError, ValueError):
        return None
    return [x if abs(x) < float("inf") else 0.0 for x in found.tolist()] or None


def is_list(value):
    return type(value).__name__.endswith("Array")


def vector(value, otherwise, what, note):
    """As many numbers as `otherwise` has."""
    if value is None:
        return plain_numbers(otherwise)
    if is_list(value):
        value = single(value, what, note)
    count, found = len(otherwise), numbers_of(value)
    if found is None:
        note(f"{what} is no number: it is left out")
        return plain_numbers(otherwise)
    if len(found) == 1 and count > 1:
        note(f"{what} is one number: it is taken for each of {count}")
        return found * count
    if len(found) < count:
        note(f"{what} has {len(found)} numbers instead of {count}")
        return found + plain_numbers(otherwise)[len(found):]
    if len(found) > count and not (count == 3 and len(found) == 4):
        note(f"{what} has {len(found)} numbers instead of {count}: the first are taken")
    return found[:count]


def number(value, otherwise, what, note):
    return vector(value, (otherwise,), what, note)[0]  # of a boolean 1 or 0


def plain_numbers(values):
    return [float(x) for x in values]


def word(value, otherwise, what, note):
    if value is None:
        return otherwise
    value = single(value, what, note)
    if not isinstance(value, str):
        note(f"{what} is no word: it is left out")
        return otherwise
    return str(value)


def asset(value, what, note):
    """A file, as Sdf.AssetPath; None: there is none."""
    value = single(value, what, note)
    if value is None:
        return None
    if isinstance(value, str):
        note(f"{what} is a text and no file: it is taken as its name")
        return Sdf.AssetPath(value)
    if not isinstance(value, Sdf.AssetPath):
        note(f"{what} is no file: it is left out")
        return None
    return value


def of_kind(value, otherwise, what, note):
    """A value of the kind of the one that stands for it where there is none; None stands for a file."""
    if otherwise is None:
        return asset(value, what, note)
    if isinstance(otherwise, str):
        return word(value, otherwise, what, note)
    if isinstance(otherwise, tuple):
        return tuple(vector(value, otherwise, what, note))
    found = number(value, otherwise, what, note)
    return bool(found) if isinstance(otherwise, bool) else found
