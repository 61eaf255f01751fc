"""The type stubs, generated from the registry: they name every class and member, and a type checker finds what is wrong."""

import ast
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


LINES = [
    ("etendue.Sphere(radius='30 cm', centre=(0, 0, 1))", True),
    ("etendue.Sphere(radus=1)", False),
    ("etendue.Sphere().radus", False),
    ("etendue.Sphere().radus = 1", False),
    ("etendue.Sphere(sides='bothe')", False),
    ("etendue.Sphere(shader=etendue.Sphere())", False),
    ("etendue.Lambertian(color=0.5)", True),
    ("etendue.Lambertian(color=etendue.rgb(0.1, 0.2, 0.3)).color", True),
    ("etendue.Spere()", False),
    ("x: float = etendue.Sphere().radius", True),
    ("x: int = etendue.Sphere().radius", False),
    ("etendue.PerspectiveCamera(from_=(0, -4, 1))", True),
    ("etendue.compare('box.etd', ['PathTracer'], samples=4)[0].bias.found", True),
    ("etendue.compare('box.etd', ['PathTracer'], samples=4)[0].bias.fund", False),
]
EXAMPLES = sorted((pathlib.Path(__file__).resolve().parents[2] / "python/examples").glob("*.py"))


@pytest.fixture(scope="module")
def problems(tmp_path_factory):
    """What mypy finds, a list of lines for each file; one run, because most of its time is for the stubs."""
    folder = tmp_path_factory.mktemp("checked")
    (folder / "etendue").mkdir()
    for file in pathlib.Path(etendue.__file__).parent.iterdir():
        if file.suffix == ".py" or file.name == "py.typed":
            (folder / "etendue" / file.name).symlink_to(file.resolve())
    _stubs.write(folder / "etendue")
    for number, (line, _) in enumerate(LINES):
        (folder / f"line_{number}.py").write_text(f"import etendue\n\n{line}\n")
    for example in EXAMPLES:
        text = "# mypy: allow-untyped-defs, allow-untyped-calls\n" + example.read_text()
        (folder / f"example_{example.name}").write_text(text)
    files = ["etendue", *sorted(p.name for p in folder.glob("*.py"))]
    options = ["--strict", "--cache-dir", str(folder / "cache")]
    run = subprocess.run(
        [sys.executable, "-m", "mypy", *options, *files], cwd=folder, capture_output=True, text=True, timeout=500
    )
    assert run.returncode in (0, 1), run.stdout + run.stderr
    found = {}
    for line in run.stdout.splitlines()[:-1]:
        found.setdefault(line.partition(":")[0], []).append(line)
    return found


@pytest.mark.parametrize("number", range(len(LINES)))
def test_a_type_checker_knows(number, problems):
    line, right = LINES[number]
    assert (f"line_{number}.py" not in problems) == right, (line, problems.get(f"line_{number}.py"))


def test_the_package_is_typed(problems):
    assert not [line for file, lines in problems.items() if file.startswith("etendue/") for line in lines]


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda e: e.name)
def test_examples_are_typed(example, problems):
    assert not problems.get(f"example_{example.name}")
