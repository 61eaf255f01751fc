"""The licences of what a package brings along, from the packages of Debian that it is built with."""

import json
import pathlib
import re
import subprocess

import openimageio

DOCUMENTS = pathlib.Path("/usr/share/doc")
OWN_NOTICES = pathlib.Path(__file__).resolve().parent / "notices"

# Libraries of headers alone, which are a part of our own files.
HEADERS = ["libcli11-dev", "nlohmann-json3-dev", "libboost1.74-dev", "libimath-dev"]
# What PyPI's OpenImageIO was linked with (its attribute "build:dependencies"), by Debian's packages of the same projects.
WITHIN_OPENIMAGEIO = [
    "libdeflate0", "libexpat1", "libfreetype6", "libgif7", "libimath-3-1-29", "libjpeg62-turbo", "libjxl0.7", "libminizip1",
    "libopencolorio2.1", "libopenexr-3-1-30", "libopenjp2-7", "libpng16-16", "libpystring0", "libtiff6", "libwebp7", "libyaml-cpp0.7",
    "libzstd1", "libfmt9",
]  # fmt: skip


def package_of(file: pathlib.Path) -> tuple[str, str]:
    """Name and version of the Debian package that a file is of."""
    # dpkg keeps some files by their paths from before /usr was merged.
    for path in (file, pathlib.Path(*file.parts[2:]) if file.parts[1] == "usr" else file):
        path = pathlib.Path("/") / path
        answer = subprocess.run(["dpkg-query", "-S", path], capture_output=True, text=True)
        if answer.returncode == 0:
            name = answer.stdout.split(":")[0]
            return name, version_of(name)
    raise SystemExit(f"etendue: {file} is of no Debian package: its licence cannot be told")


def version_of(package: str) -> str:
    answer = subprocess.run(["dpkg-query", "-W", "-f", "${source:Upstream-Version}\n", package], capture_output=True, text=True)
    return answer.stdout.split("\n")[0]


def licence_of(package: str) -> str:
    file = DOCUMENTS / package / "copyright"
    if not file.exists():
        raise SystemExit(f"etendue: {file} is missing: packages.txt has to name what needs {package}")
    return file.read_text(encoding="utf-8", errors="replace")


def collected(bundled: dict[str, str], tools: pathlib.Path, openimageio_folder: pathlib.Path) -> dict[str, str]:
    """Texts by name: of the Debian packages `bundled`, of headers, of OpenImageIO and of what is in it, of nanobind."""
    texts = {f"{package}.txt": licence_of(package) for package in sorted({*bundled, *HEADERS})}
    texts |= {f"OpenImageIO/{package}.txt": licence_of(package) for package in WITHIN_OPENIMAGEIO}
    for file in sorted((openimageio_folder / "licences").iterdir()):
        texts[f"OpenImageIO/{file.name}"] = file.read_text(encoding="utf-8")
    for file in sorted(OWN_NOTICES.iterdir()):
        texts[f"OpenImageIO/{file.name}"] = file.read_text(encoding="utf-8")
    for file in tools.glob("nanobind-*.dist-info/licenses/LICENSE"):
        texts["nanobind.txt"] = file.read_text(encoding="utf-8")
    header = tools / "nanobind" / "ext" / "robin_map" / "include" / "tsl" / "robin_map.h"
    texts["robin_map.txt"] = header.read_text(encoding="utf-8").partition("*/")[0] + "*/\n"
    if "nanobind.txt" not in texts:
        raise SystemExit(f"etendue: the licence of nanobind is not in {tools}")
    return texts


def write_versions(bundled: dict[str, str], prefix: pathlib.Path) -> None:
    """The versions of the libraries that a package brings, for etendue.build_info()."""
    plain = {re.sub(r"[0-9.+-]+(v5)?$", "", package.removeprefix("lib")): version for package, version in bundled.items()}
    versions = dict(sorted({**plain, "openimageio": openimageio.VERSION}.items()))
    (prefix / "share" / "etendue" / "bundled.json").write_text(json.dumps({"bundled": versions}, indent=2) + "\n")
