"""Tables: lists of dataclasses that show themselves as text and HTML, and become a data frame of pandas where that is there."""

from __future__ import annotations

import dataclasses
import html
import typing
from typing import Any, Generic, Iterable, Iterator, Mapping, SupportsIndex, TypeVar, Union, overload

Row = TypeVar("Row")
_LONGEST_CELL = 60  # characters


class Table(list[Row], Generic[Row]):
    """A list of rows, which are frozen dataclasses of one class."""

    def columns(self) -> dict[str, list[Any]]:
        """The table column by column. Fields of rows within rows are named with dots: "bias.found". Inner tables are left out."""
        flat = [dict(_flat(row)) for row in self]
        names = {name: None for row in flat for name in row}  # in the order of their first occurrence
        return {name: [row.get(name) for row in flat] for name in names}

    def to_pandas(self) -> Any:
        """The table as a pandas.DataFrame, with the columns of `columns`. Raises ImportError where pandas is not installed."""
        return optional_module("pandas", "to_pandas").DataFrame(self.columns())

    @overload
    def __getitem__(self, place: SupportsIndex) -> Row: ...
    @overload
    def __getitem__(self, place: slice) -> Table[Row]: ...
    def __getitem__(self, place: Union[SupportsIndex, slice]) -> Any:
        return Table(super().__getitem__(place)) if isinstance(place, slice) else super().__getitem__(place)

    def __str__(self) -> str:
        columns = [[name, *map(_cell, values)] for name, values in self.columns().items()]
        widths = [max(map(len, column)) for column in columns]
        lines = zip(*columns)
        return "\n".join("  ".join(c.rjust(w) if _is_number(c) else c.ljust(w) for c, w in zip(line, widths)).rstrip() for line in lines)

    def __repr__(self) -> str:
        return str(self)

    def _repr_html_(self) -> str:
        columns = self.columns()
        head = "".join(f"<th>{html.escape(name)}</th>" for name in columns)
        rows = ("".join(f"<td>{html.escape(_cell(v))}</td>" for v in row) for row in zip(*columns.values()))
        return f"<table><tr>{head}</tr>" + "".join(f"<tr>{row}</tr>" for row in rows) + "</table>"


def _flat(row: Any, prefix: str = "") -> Iterator[tuple[str, Any]]:
    for field in dataclasses.fields(row):
        value = getattr(row, field.name)
        if isinstance(value, Table):
            continue
        if dataclasses.is_dataclass(value):
            yield from _flat(value, f"{prefix}{field.name}.")
        else:
            yield prefix + field.name, value


def _cell(value: Any) -> str:
    if value is None:
        return "-"
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, (tuple, list)):
        return "[" + ", ".join(map(_cell, value)) + "]"
    text = " ".join(str(value).split())
    return text if len(text) <= _LONGEST_CELL else text[: _LONGEST_CELL - 1] + "…"


def _is_number(text: str) -> bool:
    return text[:1].isdigit() or text[:2].lstrip("-")[:1].isdigit()


def from_json(cls: type[Row], json: Mapping[str, Any]) -> Row:
    """A dataclass from a JSON object with exactly its fields; fields that have defaults may be absent. Throws TypeError otherwise."""
    hints = typing.get_type_hints(cls)
    return cls(**{name: _value(hints[name], value) if name in hints else value for name, value in json.items()})


def table_from_json(cls: type[Row], rows: Iterable[Mapping[str, Any]]) -> Table[Row]:
    """A table from a list of JSON objects."""
    return Table(from_json(cls, row) for row in rows)


def _value(hint: Any, value: Any) -> Any:
    if value is None:
        return None
    origin, arguments = typing.get_origin(hint), typing.get_args(hint)
    if origin is typing.Union:
        return _value(next(a for a in arguments if a is not type(None)), value)
    if origin is Table:
        return table_from_json(arguments[0], value)
    if origin is tuple:
        kinds: Iterable[Any] = [arguments[0]] * len(value) if arguments[-1] is Ellipsis else arguments
        return tuple(_value(kind, v) for kind, v in zip(kinds, value))
    if origin is dict:
        return dict(value)
    if dataclasses.is_dataclass(hint):
        return from_json(hint, value)  # type: ignore[arg-type]
    return float(value) if hint is float else value


def optional_module(name: str, purpose: str) -> Any:
    """A module that need not be installed. Raises ImportError with a hint."""
    import importlib

    try:
        return importlib.import_module(name)
    except ImportError as e:
        raise ImportError(f"{purpose} needs the package {name.partition('.')[0]}: pip install {name.partition('.')[0]}") from e
