"""Copies the libraries that installed files need into the prefix, and tells each file where they are: relative to itself.

Copies are renamed (libtbb-etendue.so.12), as another package in the same Python process may bring a library of the same name and of
another version, and the dynamic loader would take the one for the other.
"""

import os
import pathlib
import re
import shutil
import subprocess

import licences

# What every Linux with glibc has (PEP 600), of the C library's version that the wheel's name says, and zlib.
EVERYWHERE = re.compile(
    r"^(ld-linux-x86-64|libc|libm|libdl|libpthread|librt|libutil|libstdc\+\+|libgcc_s|libz)\.so\.[0-9]+$",
)


def is_elf(file: pathlib.Path) -> bool:
    if file.is_symlink() or not file.is_file():
        return False
    with open(file, "rb") as stream:
        return stream.read(4) == b"\x7fELF"


def needed(file: pathlib.Path) -> list[str]:
    """The names of the libraries that a file is linked with."""
    text = subprocess.run(["readelf", "-d", file], check=True, capture_output=True, text=True).stdout
    return re.findall(r"\(NEEDED\).*\[(.*)\]", text)


def places() -> dict[str, pathlib.Path]:
    """The files of this machine's libraries by their names."""
    text = subprocess.run(["/sbin/ldconfig", "-p"], check=True, capture_output=True, text=True).stdout
    found: dict[str, pathlib.Path] = {}
    for name, path in re.findall(r"^\s*(\S+) \(libc6,x86-64[^)]*\) => (\S+)$", text, re.MULTILINE):
        found.setdefault(name, pathlib.Path(path))
    return found


def new_name(name: str) -> str:
    stem, so, rest = name.partition(".so")
    return f"{stem}-etendue{so}{rest}"


def bundle(prefix: pathlib.Path) -> dict[str, str]:
    """Makes a prefix need nothing but what is everywhere. Returns name and version of each Debian package that a library is of."""
    files = [file for file in sorted(prefix.rglob("*")) if is_elf(file)]
    own = {file.name for file in files}
    here, packages, renamed = places(), {}, {}
    at = 0
    while at < len(files):
        for name in needed(files[at]):
            if name in own or name in renamed or EVERYWHERE.match(name):
                continue
            if name not in here:
                raise SystemExit(f"etendue: {files[at].name} needs {name}, which is not on this machine")
            source = here[name].resolve()
            package, version = licences.package_of(source)
            packages[package] = version
            copy = prefix / "lib" / new_name(name)
            shutil.copy(source, copy)
            copy.chmod(0o755)
            renamed[name] = copy.name
            files.append(copy)
        at += 1
    for file in files:
        locate(file, prefix, renamed)
    return packages


def locate(file: pathlib.Path, prefix: pathlib.Path, renamed: dict[str, str]) -> None:
    """Sets where a file looks for libraries, and their new names."""
    libraries = "$ORIGIN/" + os.path.relpath(prefix / "lib", file.parent)
    folders = ["$ORIGIN"] if file.parent == prefix / "lib" else ["$ORIGIN", libraries]
    changes = [["--replace-needed", old, renamed[old]] for old in needed(file) if old in renamed]
    if file.name in renamed.values():
        changes.append(["--set-soname", file.name])
    changes.append(["--set-rpath", ":".join(folders)])
    # One change a call: Debian's patchelf 0.14 writes the texts of several changes over one another.
    for change in changes:
        subprocess.run(["patchelf", *change, file], check=True)
