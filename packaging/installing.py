"""Builds the library for each architecture and installs all builds into one prefix (cmake/InstallByArchitecture.cmake says what is
where). Of this prefix both the wheels and the Debian package are made."""

import contextlib
import fcntl
import os
import pathlib
import shutil
import subprocess
import sys
from typing import Iterator

import openimageio
import python_headers

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / "build"
FOLDER = BUILD / "packages"
TARGETS = ["etendue_program", "etendue_commands", "etendue_formats", "etendue_osl", "etendue_assimp", "etendue_draco", "etendue_bundled_openimageio"]


def architectures() -> list[str]:
    lines = (ROOT / "packaging" / "architectures.txt").read_text().splitlines()
    return [line.partition(":")[0] for line in lines if not line.startswith("#")]


def version() -> str:
    text = (ROOT / "CMakeLists.txt").read_text()
    return text.partition("project(etendue VERSION ")[2].split()[0]


def say(text: str) -> None:
    print(f"etendue: {text}", file=sys.stderr, flush=True)


def run(*command: object) -> None:
    words = [str(word) for word in command]
    if subprocess.run(words).returncode != 0:
        raise SystemExit(f"etendue: failed: {' '.join(words)}")


@contextlib.contextmanager
def locked() -> Iterator[None]:
    """The lock of the launcher: two do not build at once."""
    with open(BUILD / ".lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def configure(source: pathlib.Path, build: pathlib.Path, *options: object) -> None:
    ccache = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
    run("cmake", "-S", source, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", *ccache, *options)


def build_targets(build: pathlib.Path, *targets: str) -> None:
    run("cmake", "--build", build, "--parallel", os.cpu_count(), "--target", *targets)


def install(build: pathlib.Path, prefix: pathlib.Path) -> None:
    run("cmake", "--install", build, "--component", "by_architecture", "--prefix", prefix, "--strip")


def install_page(prefix: pathlib.Path) -> None:
    """The studio's page, which the launcher has built."""
    (prefix / "share" / "etendue" / "studio").mkdir(parents=True, exist_ok=True)
    shutil.copy(BUILD / "studio" / "index.html", prefix / "share" / "etendue" / "studio")


def install_native(prefix: pathlib.Path, building: bool) -> None:
    """What the launcher's own build has: this processor's architecture, this machine's Python."""
    with locked():
        if building:
            # With the Python that runs this, as the launcher configures it.
            python = ["-DETENDUE_PYTHON=ON", f"-DPython_EXECUTABLE={sys.executable}"]
            configure(ROOT, BUILD, f"-DETENDUE_BUNDLED_OPENIMAGEIO={FOLDER / 'openimageio'}", *python)
            build_targets(BUILD, *TARGETS, "etendue_python")
        install(BUILD, prefix)


def install_architecture(architecture: str, pythons: list[str], prefix: pathlib.Path, building: bool) -> None:
    say(f"building for {architecture}")
    build = FOLDER / architecture
    options = [f"-DETENDUE_ARCHITECTURE={architecture}"]
    configure(ROOT, build, *options, f"-DETENDUE_BUNDLED_OPENIMAGEIO={FOLDER / 'openimageio'}", "-DETENDUE_TESTS=OFF")
    if building:
        build_targets(build, *TARGETS)
    install(build, prefix)
    for python in pythons:
        say(f"building the extension module for {architecture} and Python {python}")
        # Debian 12 has 3.11 itself.
        include = "" if python == "3.11" else python_headers.headers(python, FOLDER / "python-headers")
        extension = build / f"python-{python}"
        tools = f"-DETENDUE_PYTHON_TOOLS={BUILD / 'python-tools'}"
        found = [] if include else ["-DPython_EXECUTABLE=/usr/bin/python3.11"]
        configure(ROOT / "python", extension, *options, *found, f"-Detendue_ROOT={prefix}", f"-DETENDUE_PYTHON_HEADERS={include}", tools)
        if building:
            build_targets(extension, "etendue_python")
        install(extension, prefix)


def installed(native: bool, building: bool, pythons: list[str]) -> pathlib.Path:
    """The prefix with all builds."""
    prefix = FOLDER / ("installed-native" if native else "installed")
    shutil.rmtree(prefix, ignore_errors=True)
    openimageio.lay_out(FOLDER / "openimageio")
    if native:
        install_native(prefix, building)
    else:
        for architecture in architectures():
            install_architecture(architecture, pythons, prefix, building)
    install_page(prefix)
    return prefix
