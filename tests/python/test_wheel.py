"""A wheel of the build (`./etendue wheel --native`): what is in it, and that it works where nothing of the build is."""

import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import zipfile

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = ROOT / "build"
PROGRAM = pathlib.Path(os.environ.get("ETENDUE_PROGRAM", BUILD / "etendue")).resolve()

sys.path.insert(0, str(ROOT / "packaging"))

pytestmark = pytest.mark.skipif(
    PROGRAM.parent != BUILD.resolve() or not (BUILD / "bundled").is_dir() or not (BUILD / "studio" / "index.html").exists(),
    reason="what a wheel is made of was not built by the launcher",
)


@pytest.fixture(scope="module")
def wheel():
    subprocess.run([sys.executable, "-B", ROOT / "packaging" / "wheel.py", "--native", "--no-build"], check=True, stdout=subprocess.DEVNULL)
    return max((BUILD / "dist").glob("etendue-*-linux_x86_64.whl"), key=lambda path: path.stat().st_mtime)


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory):
    """The folder that pip has installed the wheel into."""
    folder = tmp_path_factory.mktemp("installed")
    pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-index", "--no-deps", "--root-user-action", "ignore"]
    subprocess.run([*pip, "--target", folder, wheel], check=True)
    return folder


@pytest.fixture
def run(installed, tmp_path):
    """Runs a command in an empty folder, with the installed package and numpy alone."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("ETENDUE", "PYTHON", "LD_"))}
    environment["PYTHONPATH"] = os.pathsep.join([str(installed), *(f for f in sys.path if f.endswith("python-tools"))])

    def run(*command):
        words = [str(word) for word in command]
        return subprocess.run(words, check=True, env=environment, cwd=tmp_path, capture_output=True, text=True).stdout

    return run


def test_all_that_is_needed_is_in_it(wheel):
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
    for wanted in [
        r"etendue/__init__\.py",
        r"etendue/py\.typed",
        r"etendue/_prefix/native/_core\.[^/]*\.so",
        r"etendue/_prefix/native/(etendue|libetendue_app\.so|libetendue_formats\.so|libetendue_openimageio\.so|libetendue_osl\.so)",
        r"etendue/_prefix/native/libetendue\.so\.[0-9.]+",
        r"etendue/_prefix/libexec/etendue/(etendue_assimp|etendue_draco|etendue_usd\.py|etendue_materialx\.py)",
        r"etendue/_prefix/share/etendue/studio/index\.html",
        r"etendue/_prefix/include/etendue/core/spectrum\.h",
        r"etendue/_prefix/lib/cmake/etendue/etendueConfig\.cmake",
        r"etendue-[0-9.]+\.data/scripts/etendue",
        r"etendue-[0-9.]+\.dist-info/licenses/(LICENSE|libembree3-3\.txt|libtbb12\.txt|nanobind\.txt|OpenImageIO/LICENSE\.md)",
    ]:
        found = [name for name in names if re.fullmatch(wanted, name)]
        alternatives = re.search(r"\(([^()]*)\)", wanted)
        assert len(found) == (alternatives[1].count("|") + 1 if alternatives else 1), wanted
    assert not [name for name in names if "__pycache__" in name or "osl_machine" in name]
    assert wheel.stat().st_size < 60e6


def test_its_list_of_files_is_right(wheel):
    with zipfile.ZipFile(wheel) as archive:
        record = next(name for name in archive.namelist() if name.endswith(".dist-info/RECORD"))
        listed = dict(line.split(",", 1) for line in archive.read(record).decode().splitlines())
        assert sorted(listed) == sorted(archive.namelist())
        for name, rest in listed.items():
            digest = base64.urlsafe_b64encode(hashlib.sha256(archive.read(name)).digest()).rstrip(b"=").decode()
            assert name == record or rest == f"sha256={digest},{archive.getinfo(name).file_size}"


def test_libraries_are_found_in_it_and_nowhere_else(installed):
    import bundling

    files = [file for file in installed.rglob("*") if bundling.is_elf(file)]
    assert len(files) > 15
    for file in files:
        text = subprocess.run(["readelf", "-d", file], check=True, capture_output=True, text=True).stdout
        folders = re.findall(r"\((?:RUNPATH|RPATH)\).*\[(.*)\]", text)
        assert all(part.startswith("$ORIGIN") for path in folders for part in path.split(":")), (file, folders)
        places = [pathlib.Path(part.replace("$ORIGIN", str(file.parent))) for path in folders for part in path.split(":")]
        for name in bundling.needed(file):
            assert bundling.EVERYWHERE.match(name) or any((place / name).is_file() for place in places), (file, name)


def test_the_package_is_imported_quickly(run, installed):
    command = "import time; begin = time.process_time(); import etendue; print(time.process_time() - begin)"
    # The least of some runs: the first one reads the libraries from the disk, and any of them may share its core with another
    # program, which costs it processor time as well (0.06 s where nothing else runs).
    assert min(float(run(sys.executable, "-c", command)) for _ in range(5)) < 0.3


def test_the_package_takes_nothing_of_the_build(run, installed):
    said = run(
        sys.executable,
        "-c",
        "import etendue\n"
        "print(etendue.build_info()['architecture'], etendue.__file__)\n"
        "print(open('/proc/self/maps').read())",
    )
    architecture, file = said.splitlines()[0].split()
    assert architecture == "native"
    assert file.startswith(str(installed))
    assert str(BUILD) not in said.replace(str(BUILD / "python-tools"), "")
    libraries = {line.split()[-1] for line in said.splitlines() if re.search(r"lib(tbb|embree|fmt|osd)", line)}
    assert len(libraries) >= 4
    assert all(library.startswith(str(installed)) for library in libraries)


@pytest.mark.parametrize("picture", ["box.png", "box.exr", "box.hdr"])
def test_its_program_renders_the_cornell_box(run, installed, tmp_path, picture):
    scene = ROOT / "scenes" / "cornell_box.etd"
    run(sys.executable, installed / "bin" / "etendue", "render", scene, "--size", "32x32", "--samples", 2, "--quiet", "-o", picture)
    assert (tmp_path / picture).stat().st_size > 500
    assert "32 x 32" in run(sys.executable, "-m", "etendue", "image", "info", picture)


def test_its_program_reads_files_of_others(run, tmp_path):
    facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
    (tmp_path / "one.stl").write_text(f"solid one\n{facet}endsolid one\n")  # by Assimp
    for model in ["one.stl", ROOT / "scenes" / "first_tries" / "chess.glb"]:
        run(sys.executable, "-m", "etendue", "render", model, "--size", "16x16", "--samples", 1, "--quiet", "-o", "model.png")
        assert (tmp_path / "model.png").stat().st_size > 100
