"""Makes wheels of the Python package, with the program, the library and all that these need.

    ./etendue wheel             for each of Python 3.10, 3.11 and from 3.12 on (stable ABI), builds for every architecture: an hour
    ./etendue wheel --native    for this machine's Python and processor, from the launcher's own build: a minute, to try the package

The wheels are in build/dist. Equal sources give equal wheels: files are sorted, and dated by the last commit.
"""

import argparse
import base64
import datetime
import hashlib
import os
import pathlib
import shutil
import subprocess
import sys
import sysconfig
import tomllib
import zipfile

import bundling
import installing
import licences

DISTRIBUTIONS = installing.BUILD / "dist"
# Of the C library that the libraries are linked with: Debian 12's.
PLATFORM = "manylinux_2_36_x86_64"
# By the name that an extension module's file has: the Pythons that can load it.
TAGS = {
    "cpython-310-x86_64-linux-gnu": "cp310-cp310",
    "cpython-311-x86_64-linux-gnu": "cp311-cp311",
    "abi3": "cp312-abi3",
}


def commit_time() -> datetime.datetime:
    text = os.environ.get("SOURCE_DATE_EPOCH")
    if not text:
        text = subprocess.run(["git", "-C", installing.ROOT, "log", "-1", "--format=%ct"], capture_output=True, text=True).stdout
    return datetime.datetime.fromtimestamp(int(text or "946684800"), datetime.timezone.utc)


def metadata(project: dict) -> str:
    """The file METADATA (core metadata 2.1) from the table `project` of pyproject.toml."""
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {installing.version()}"]
    lines += [f"Summary: {project['description']}", "License: Apache-2.0", f"Requires-Python: {project['requires-python']}"]
    lines += [f"Keywords: {','.join(project['keywords'])}"]
    lines += [f"Classifier: {classifier}" for classifier in project["classifiers"]]
    lines += [f"Requires-Dist: {requirement}" for requirement in project["dependencies"]]
    for extra, requirements in project["optional-dependencies"].items():
        lines += [f"Provides-Extra: {extra}"]
        lines += [f"Requires-Dist: {requirement}; extra == '{extra}'" for requirement in requirements]
    lines += ["Description-Content-Type: text/markdown", "", (installing.ROOT / project["readme"]).read_text(encoding="utf-8")]
    return "\n".join(lines)


def entry_points(project: dict) -> str:
    groups = project["entry-points"].items()
    return "".join(f"[{group}]\n" + "".join(f"{name} = {target}\n" for name, target in entries.items()) for group, entries in groups)


class Wheel:
    """A wheel that is written: a zip archive with a list of its files and their digests."""

    def __init__(self, tag: str, native: bool) -> None:
        platform = "linux_x86_64" if native else PLATFORM
        self.tag = f"{tag}-{platform}"
        self.name = f"etendue-{installing.version()}"
        DISTRIBUTIONS.mkdir(parents=True, exist_ok=True)
        self.path = DISTRIBUTIONS / f"{self.name}-{self.tag}.whl"
        self.time = commit_time().timetuple()[:6]
        self.files: dict[str, tuple[bytes, bool]] = {}

    def add(self, name: str, content: bytes | str, executable: bool = False) -> None:
        self.files[name] = (content.encode() if isinstance(content, str) else content, executable)

    def add_folder(self, name: str, folder: pathlib.Path, left_out: frozenset[pathlib.Path] = frozenset()) -> None:
        for file in folder.rglob("*"):
            if file.is_symlink():
                raise SystemExit(f"etendue: a wheel has no links, but there is {file}")
            if file.is_file() and file not in left_out and "__pycache__" not in file.parts:
                self.add(f"{name}/{file.relative_to(folder).as_posix()}", file.read_bytes(), os.access(file, os.X_OK))

    def write(self) -> None:
        record = f"{self.name}.dist-info/RECORD"
        lines = []
        for name, (content, _) in sorted(self.files.items()):
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            lines.append(f"{name},sha256={digest},{len(content)}\n")
        self.add(record, "".join(lines) + f"{record},,\n")
        with zipfile.ZipFile(self.path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
            for name, (content, executable) in sorted(self.files.items(), key=lambda entry: (entry[0] == record, entry[0])):
                entry = zipfile.ZipInfo(name, self.time)
                entry.compress_type = zipfile.ZIP_DEFLATED
                entry.external_attr = (0o100755 if executable else 0o100644) << 16
                archive.writestr(entry, content)
        installing.say(f"made {self.path} ({self.path.stat().st_size / 1e6:.1f} MB)")


def extensions(prefix: pathlib.Path) -> dict[str, frozenset[pathlib.Path]]:
    """Extension modules of all architectures, by the ending that says for which Pythons they are."""
    kinds: dict[str, set[pathlib.Path]] = {}
    for file in prefix.glob("*/_core.*.so"):
        kinds.setdefault(file.name.removeprefix("_core.").removesuffix(".so"), set()).add(file)
    return {kind: frozenset(files) for kind, files in sorted(kinds.items())}


def write_wheel(kind: str, prefix: pathlib.Path, texts: dict[str, str], native: bool) -> None:
    with open(installing.ROOT / "pyproject.toml", "rb") as file:
        project = tomllib.load(file)["project"]
    wheel = Wheel(TAGS[kind], native)
    kinds = extensions(prefix)
    others = frozenset().union(*(files for name, files in kinds.items() if name != kind))
    for file in (installing.ROOT / "python" / "etendue").iterdir():
        if file.suffix in (".py", ".pyi") or file.name == "py.typed":
            wheel.add(f"etendue/{file.name}", file.read_bytes())
    wheel.add_folder("etendue/_prefix", prefix, others)
    program = (installing.ROOT / "python" / "etendue_program.py").read_bytes()
    wheel.add(f"{wheel.name}.data/scripts/etendue", program, executable=True)
    information = f"{wheel.name}.dist-info"
    wheel.add(f"{information}/METADATA", metadata(project))
    wheel.add(f"{information}/entry_points.txt", entry_points(project))
    wheel.add(f"{information}/WHEEL", f"Wheel-Version: 1.0\nGenerator: etendue\nRoot-Is-Purelib: false\nTag: {wheel.tag}\n")
    wheel.add(f"{information}/licenses/LICENSE", (installing.ROOT / "LICENSE").read_bytes())
    for name, text in texts.items():
        wheel.add(f"{information}/licenses/{name}", text)
    wheel.write()


def main() -> None:
    parser = argparse.ArgumentParser(prog="./etendue wheel", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--native", action="store_true", help="for this machine alone, from the launcher's own build")
    parser.add_argument("--no-build", action="store_true", help="of what is built already")
    arguments = parser.parse_args()
    pythons = ["3.10", "3.11", "3.12"]
    built = installing.installed(arguments.native, not arguments.no_build, pythons)
    prefix = built.with_name(built.name + "-bundled")
    shutil.rmtree(prefix, ignore_errors=True)
    shutil.copytree(built, prefix)
    bundled = bundling.bundle(prefix)
    licences.write_versions(bundled, prefix)
    texts = licences.collected(bundled, installing.BUILD / "python-tools", installing.FOLDER / "openimageio")
    kinds = extensions(prefix)
    if not kinds:
        raise SystemExit(f"etendue: no extension module was built for Python {sysconfig.get_python_version()} ({sys.executable})")
    for kind in kinds:
        write_wheel(kind, prefix, texts, arguments.native)


if __name__ == "__main__":
    main()
