"""Pages of the Python package, in Markdown: functions and classes from their signatures and docstrings, classes of the registry from
their descriptions."""

from __future__ import annotations

import importlib
import inspect
import pathlib
import re
from typing import Any, Callable, Iterable

import etendue
from etendue._classes import described, python_name, type_text

#: Private modules whose public names are a page each, and the page's title.
PAGES = {
    "_files": "Scenes from files and texts",
    "_render": "Renders",
    "_images": "Pictures",
    "_widgets": "Pictures in notebooks and pages",
    "_paths": "Paths of samples",
    "_points": "Rays, points and samples as arrays",
    "_wavelengths": "Wavelengths and spectra",
    "_laboratory": "The laboratory",
    "_tables": "Tables",
    "_declare": "Parts written in Python",
    "_errors": "Errors and warnings",
}


LONGEST_LINE = 100


def public_names() -> dict[str, Any]:
    """What users of the package see, except for the classes of the registry and the functions of the language."""
    return {n: v for n, v in vars(etendue).items() if not n.startswith("_") and getattr(v, "__module__", "").startswith("etendue")}


def cell(text: object) -> str:
    return " ".join(str(text).split()).replace("|", "\\|").replace("<", "&lt;")


def docstring(text: str) -> str:
    """A docstring as Markdown: indented blocks are code, and lines "name: words" become a list."""
    blocks = []
    for block in re.split(r"\n\s*\n", inspect.cleandoc(text)):
        lines = block.splitlines()
        if all(line.startswith("    ") for line in lines):
            blocks.append("```python\n" + "\n".join(line[4:] for line in lines) + "\n```")
            continue
        shown: list[str] = []
        for line in lines:
            entry = re.match(r"([a-z_]\w*(?:, [a-z_]\w*)*): (.*)", line)
            if entry:
                shown += ["" if shown and not shown[-1].startswith("- ") else None, f"- `{entry[1]}`: {plain(entry[2])}"]  # type: ignore[list-item]
            elif shown and line.startswith("    "):
                shown[-1] += " " + plain(line.strip())
            else:
                shown += ["" if shown and shown[-1].startswith("- ") else None, plain(line)]  # type: ignore[list-item]
        blocks.append("\n".join(s for s in shown if s is not None))
    return "\n\n".join(blocks)


def plain(text: str) -> str:
    """Text in which `code` stays code and nothing else is markup."""
    return "".join(
        part if i % 2 else re.sub(r"([*_<\[\]])", r"\\\1", part) for i, part in enumerate(re.split(r"(`[^`]*`)", text))
    )


def signature(name: str, function: Callable[..., Any]) -> str:
    try:
        parameters = inspect.signature(function)
    except (TypeError, ValueError):
        return name
    text = name + unquoted(str(parameters))
    if len(text) <= LONGEST_LINE:
        return text
    shown, kinds = [], inspect.Parameter
    for parameter in parameters.parameters.values():
        if parameter.kind is kinds.KEYWORD_ONLY and "    *," not in shown:
            shown.append("    *,")
        shown.append(f"    {unquoted(str(parameter))},")
    result = parameters.return_annotation
    return f"{name}(\n" + "\n".join(shown) + "\n)" + ("" if result is parameters.empty else f" -> {result}")


def unquoted(text: str) -> str:
    """Annotations without quotation marks, which they have because they are read late."""
    return re.sub(r"(: |-> )'([^']*)'", r"\1\2", text)


def function_text(name: str, function: Any, level: str) -> Iterable[str]:
    yield f"{level} {name}"
    yield f"```python\n{signature(name, function)}\n```"
    yield docstring(inspect.getdoc(function) or "")


def class_text(name: str, cls: type) -> Iterable[str]:
    yield f"## {name}"
    yield docstring(cls.__doc__ or "") if not str(cls.__doc__).startswith(f"{name}(") else ""
    fields = list(getattr(cls, "__dataclass_fields__", None) or getattr(cls, "_fields", ()))
    if fields:
        yield "\n".join(f"- `{n}`: `{unquoted(str(cls.__annotations__.get(n, '')))}`" for n in fields)
    for member, value in vars(cls).items():
        if member.startswith("_") or member in fields:
            continue
        raw = value.__func__ if isinstance(value, (staticmethod, classmethod)) else value
        if isinstance(raw, property):
            yield f"### {name}.{member}"
            yield docstring(raw.__doc__ or "")
        elif inspect.isfunction(raw):
            yield from function_text(f"{name}.{member}", raw, "###")


def module_page(module: str, title: str) -> str:
    """The functions that users have, and all classes: also those of the rows and samples that functions give."""
    parts = [f"# {title}"]
    names = vars(importlib.import_module(f"etendue.{module}"))
    functions_first = sorted(names.items(), key=lambda item: isinstance(item[1], type))
    for name, value in functions_first:
        if name.startswith("_") or getattr(value, "__module__", "") != f"etendue.{module}":
            continue
        if isinstance(value, type):
            parts += class_text(name, value)
        elif callable(value) and hasattr(etendue, name):
            parts += function_text(name, value, "##")
    return "\n\n".join(parts) + "\n"


def member_row(member: dict[str, Any]) -> str:
    default = "required" if member.get("required") else f"`{cell(default_text(member.get('default')))}`"
    return f"| `{python_name(member['name'])}` | {cell(type_text(member))} | {default} | {cell(member['text'])} |"


def default_text(default: Any) -> str:
    if isinstance(default, dict):
        return default["class"] + "(" + ", ".join(f"{k}={v}" for k, v in default.items() if k != "class") + ")"
    text = str(default) if default != "" else '""'
    return text if len(text) <= 60 else text[:57] + "…"


def registry_class_text(cls: type, manual: pathlib.Path) -> Iterable[str]:
    description = described(cls)
    name = description["name"]
    yield f"## {name}"
    yield plain(description["summary"]) + (f" [Manual](../docs/manual/{name}.md)." if (manual / f"{name}.md").is_file() else "")
    if description["members"]:
        yield "\n".join(["| member | type | default | |", "|---|---|---|---|", *map(member_row, description["members"])])


def interface_page(interface: type, manual: pathlib.Path) -> str:
    from etendue._questions import QUESTIONS

    name = interface.__name__
    parts = [f"# {name}: classes", plain(described(interface)["summary"])]
    if owner := QUESTIONS.get(name):
        parts.append("Questions that all of them answer, on arrays:")
        for question, function in vars(owner).items():
            if not question.startswith("_") and inspect.isfunction(function):
                parts += function_text(question, function, "###")
    for cls in etendue.classes(interface):
        parts += registry_class_text(cls, manual)
    return "\n\n".join(parts) + "\n"


def language_page() -> str:
    rows = [f"| `{name}` | `{cell(usage)}` | {makes} |" for name, usage, makes in etendue._core.functions()]
    text = "# Functions of the language\n\nEach is a function of the package; [the language](../docs/language.md) says what they do.\n\n"
    return text + "\n".join(["| function | usage | makes |", "|---|---|---|", *rows]) + "\n"


def write(folder: pathlib.Path, manual: pathlib.Path) -> None:
    """Writes all pages into a folder; `manual` has the pages of classes that these refer to."""
    folder.mkdir(parents=True, exist_ok=True)
    names = public_names()
    listed = []
    for module, title in PAGES.items():
        (folder / f"{module.lstrip('_')}.md").write_text(module_page(module, title), encoding="utf-8")
        listed.append(f"- [{title}]({module.lstrip('_')}.md)")
    own = {n: v for n, v in names.items() if getattr(v, "__module__", "") in ("etendue", "etendue._classes", "etendue._questions")}
    parts = ["# The package"]
    for name, value in own.items():
        if isinstance(value, type) and hasattr(value, "_description"):
            continue
        parts += class_text(name, value) if isinstance(value, type) else function_text(name, value, "##") if callable(value) else []
    (folder / "package.md").write_text("\n\n".join(parts) + "\n", encoding="utf-8")
    (folder / "language.md").write_text(language_page(), encoding="utf-8")
    interfaces = [cls for cls in etendue.classes() if not described(cls).get("parent")]
    for cls in interfaces:
        (folder / f"{cls.__name__}.md").write_text(interface_page(cls, manual), encoding="utf-8")
    text = "# Python reference\n\n[The guide](../docs/python.md) tells how these are used.\n\n## Functions and classes\n\n"
    text += "- [The package](package.md)\n" + "\n".join(listed) + "\n- [Functions of the language](language.md)\n"
    text += "\n## Classes of the registry, by their interfaces\n\n"
    text += "\n".join(f"- [{cls.__name__}]({cls.__name__}.md): {plain(described(cls)['summary'])}" for cls in interfaces) + "\n"
    (folder / "index.md").write_text(text, encoding="utf-8")
