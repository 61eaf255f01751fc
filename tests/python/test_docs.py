"""The pages of the reference, which `./etendue docs` makes a site of: every class, member and function is in them."""

import pathlib
import re
import sys

import pytest

import etendue
from etendue._classes import described, python_name

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    sys.path.insert(0, str(ROOT / "python/docs"))
    try:
        import api
    finally:
        sys.path.pop(0)
    folder = tmp_path_factory.mktemp("site") / "api"
    api.write(folder, ROOT / "docs/manual")
    return {page.stem: page.read_text(encoding="utf-8") for page in folder.glob("*.md")}


def section(text, title):
    return re.search(rf"(?ms)^## {title}$(.*?)(?=^## |\Z)", text)[1]


def test_every_class_and_member(pages):
    for interface in (cls for cls in etendue.classes() if not described(cls).get("parent")):
        for cls in etendue.classes(interface):
            rows = section(pages[interface.__name__], cls.__name__)
            for member in described(cls)["members"]:
                assert f"| `{python_name(member['name'])}` |" in rows, (cls.__name__, member["name"])


def test_every_function_and_class_of_the_package(pages):
    every = "\n".join(pages.values())
    for name in ("render", "Render", "Image", "load", "save", "verify", "compare", "conform", "member", "copy", "Wavelengths", "Error"):
        assert f"\n## {name}\n" in every, name
    assert "    reference_time: Optional[float] = None,\n" in pages["laboratory"]
    assert "- `samples`: per pixel of each renderer" in pages["laboratory"]
    assert "`band`: `Optional[tuple[float, float]]`" in pages["laboratory"]


def test_every_function_of_the_language(pages):
    for name, usage, _ in etendue._core.functions():
        assert f"| `{name}` | `{usage}`" in pages["language"]


def test_links_lead_to_pages(pages):
    for name, text in pages.items():
        for target in re.findall(r"\]\(([^)#:]+\.md)\)", text):
            if target.startswith("../docs/"):
                assert (ROOT / target.removeprefix("../")).is_file(), (name, target)
            else:
                assert target.removesuffix(".md") in pages, (name, target)
