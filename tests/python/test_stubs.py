"""The type stubs, generated from the registry: they name every class and member, and a type checker finds what is wrong."""

import ast
import importlib.util
import pathlib
import subprocess
import sys

import pytest

import etendue
from etendue import _stubs
from etendue._classes import python_name


def test_every_class_and_member_is_named():
    tree = ast.parse(_stubs.package_stub())
    classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
    bases = {name: [b.id for b in node.bases if isinstance(b, ast.Name)] for name, node in classes.items()}

    def names(name):
        own = {n.name for n in classes[name].body if isinstance(n, ast.FunctionDef)}
        own |= {n.target.id for n in classes[name].body if isinstance(n, ast.AnnAssign)}
        return own.union(*(names(b) for b in bases[name] if b in classes))

    for cls in etendue.classes():
        known = names(cls.__name__)
        for member in cls._description["members"]:
            assert python_name(member["name"]) in known, (cls.__name__, member["name"])


def test_stubs_are_python(tmp_path):
    _stubs.write(tmp_path)
    for file in ("__init__.pyi", "_core.pyi"):
        compile((tmp_path / file).read_text(), file, "exec")


@pytest.mark.skipif(importlib.util.find_spec("mypy") is None, reason="mypy is not installed")
@pytest.mark.parametrize(
    "line, right",
    [
        ("etendue.Sphere(radius='30 cm', centre=(0, 0, 1))", True),
        ("etendue.Sphere(radus=1)", False),
        ("etendue.Sphere().radus", False),
        ("etendue.Sphere(sides='bothe')", False),
        ("etendue.Spere()", False),
        ("x: float = etendue.Sphere().radius", True),
    ],
)
def test_a_type_checker_knows(line, right, tmp_path):
    package = pathlib.Path(etendue.__file__).parent
    (tmp_path / "etendue").mkdir()
    for file in package.iterdir():
        if file.suffix == ".py" or file.name == "py.typed":
            (tmp_path / "etendue" / file.name).symlink_to(file.resolve())
    _stubs.write(tmp_path / "etendue")
    (tmp_path / "sample.py").write_text(f"import etendue\n\n{line}\n")
    found = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(tmp_path / "cache"), "sample.py"],
        cwd=tmp_path, capture_output=True, text=True, timeout=300,
    )
    assert (found.returncode == 0) == right, found.stdout + found.stderr
