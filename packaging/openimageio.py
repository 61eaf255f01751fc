"""An OpenImageIO that a package can bring: the one of PyPI, which has the libraries it needs inside. Debian's needs 250 others.

PyPI's wheel has the libraries, the source archive beside it the headers. Both are checked by their digests.
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import zipfile

VERSION = "3.2.2.0"
NAMESPACE = "v3_2"
DIGESTS = [
    "1133b6a6c04270398c419804e0d293b2bb3ce2d7607a17724cc45f385036b05b",
    "d66c829016b4f092c443b7f7896f06d0ab6af02a103d635d1b0b841c14bfd7c1",
]
WHEEL_OF = ["--only-binary", ":all:", "--python-version", "3.11", "--platform", "manylinux_2_28_x86_64"]


def download(folder: pathlib.Path) -> tuple[pathlib.Path, pathlib.Path]:
    """The wheel and the source archive."""
    requirement = folder / "requirement.txt"
    requirement.write_text(f"openimageio=={VERSION} " + " ".join(f"--hash=sha256:{digest}" for digest in DIGESTS) + "\n")
    pip = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--require-hashes", "-r", requirement, "-d", folder]
    subprocess.run([*pip, *WHEEL_OF], check=True)
    subprocess.run([*pip, "--no-binary", "openimageio"], check=True)
    return next(folder.glob("*.whl")), next(folder.glob("*.tar.gz"))


def version_header(template: str) -> str:
    """oiioversion.h, which the source's own build makes of a template."""
    major, minor, patch, tweak = VERSION.split(".")
    values = {
        "PROJECT_VERSION_MAJOR": major,
        "PROJECT_VERSION_MINOR": minor,
        "PROJECT_VERSION_PATCH": patch,
        "PROJECT_VERSION_TWEAK": tweak,
        "PROJECT_VERSION_RELEASE_TYPE": "",
        "OIIO_USE_COMPILED_FMT_VALUE": "1",  # the fmt of our own build
        "PROJ_NAMESPACE": "OpenImageIO",
        "PROJ_VERSION_NAMESPACE": NAMESPACE,
        "Imath_VERSION_MAJOR": "3",
        "Imath_VERSION_MINOR": "2",
        "CMAKE_CXX_STANDARD": "17",
    }
    text = re.sub(r"@(\w+)@", lambda match: values[match[1]], template)
    return text.replace("#cmakedefine01 OIIO_TBB", "#define OIIO_TBB 0")


def lay_out(prefix: pathlib.Path) -> None:
    """Makes PREFIX/lib, PREFIX/include and PREFIX/licences, unless they are there."""
    stamp = prefix / ".version"
    if stamp.exists() and stamp.read_text() == VERSION:
        return
    shutil.rmtree(prefix, ignore_errors=True)
    headers = prefix / "include" / "OpenImageIO"
    (prefix / "lib").mkdir(parents=True)
    (prefix / "licences").mkdir()
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        wheel, source = download(folder)
        with zipfile.ZipFile(wheel) as archive:
            for name in archive.namelist():
                base = name.rpartition("/")[2]
                if name.startswith("OpenImageIO/lib/lib"):
                    (prefix / "lib" / base).write_bytes(archive.read(name))
                elif "/licenses/" in name and base:
                    (prefix / "licences" / base).write_bytes(archive.read(name))
        with tarfile.open(source) as archive:
            archive.extractall(folder)  # its digest was checked
        shutil.copytree(next(folder.glob("openimageio-*/src/include/OpenImageIO")), headers)
    (headers / "oiioversion.h").write_text(version_header((headers / "oiioversion.h.in").read_text()))
    (headers / "detail" / "fmt").symlink_to("/usr/include/fmt")
    stamp.write_text(VERSION)


if __name__ == "__main__":
    lay_out(pathlib.Path(sys.argv[1]))
