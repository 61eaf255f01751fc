"""Makes a Debian package and an archive of the sources, in build/dist.

    ./etendue package             with builds for every architecture: an hour, or minutes after `./etendue wheel`
    ./etendue package --native    for processors like this machine's, from the launcher's own build: to try the package

The Debian package has in /usr/lib/etendue what a wheel has in etendue/_prefix, but depends on Debian's own libraries. OpenImageIO alone
is brought along, as Debian's needs 250 others.
"""

import argparse
import gzip
import pathlib
import re
import shutil
import subprocess

import installing
import licences
import wheel


def write(file: pathlib.Path, content: str, executable: bool = False) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(content, encoding="utf-8")
    file.chmod(0o755 if executable else 0o644)


def lay_out(tree: pathlib.Path, built: pathlib.Path) -> None:
    """The files as they will lie under /."""
    shutil.rmtree(tree, ignore_errors=True)
    usr = tree / "usr"
    shutil.copytree(built, usr / "lib" / "etendue")
    licences.write_versions({}, usr / "lib" / "etendue")
    for file in usr.glob("lib/etendue/lib/*.so*"):
        file.chmod(0o644)
    write(usr / "bin" / "etendue", (installing.ROOT / "packaging" / "etendue.sh").read_text(encoding="utf-8"), executable=True)
    (usr / "lib" / "cmake").mkdir()
    (usr / "lib" / "cmake" / "etendue").symlink_to("../etendue/lib/cmake/etendue")

    python = usr / "lib" / "python3" / "dist-packages" / "etendue"
    python.mkdir(parents=True)
    for file in (installing.ROOT / "python" / "etendue").iterdir():
        if file.suffix in (".py", ".pyi") or file.name == "py.typed":
            shutil.copy(file, python)
    (python / "_prefix").symlink_to("../../../etendue")

    texts = licences.collected({}, installing.BUILD / "python-tools", installing.FOLDER / "openimageio")
    write(usr / "share" / "doc" / "etendue" / "copyright", (installing.ROOT / "LICENSE").read_text(encoding="utf-8"))
    for name, text in texts.items():
        write(usr / "share" / "doc" / "etendue" / "licences" / name, text)


def make_debian_package(tree: pathlib.Path) -> None:
    time = int(wheel.commit_time().timestamp())
    environment = [
        f"SOURCE_DATE_EPOCH={time}",
        f"ETENDUE_TREE={tree}",
        f"ETENDUE_DISTRIBUTIONS={wheel.DISTRIBUTIONS}",
        f"ETENDUE_VERSION={installing.version()}",
    ]
    installing.run("env", *environment, "cpack", "--config", installing.ROOT / "packaging" / "debian.cmake")
    shutil.rmtree(wheel.DISTRIBUTIONS / "_CPack_Packages", ignore_errors=True)


def make_source_archive() -> None:
    """Of the last commit. Equal commits give equal bytes: git dates all files by the commit, and gzip is given no date."""
    name = f"etendue-{installing.version()}"
    archive = ["git", "-C", str(installing.ROOT), "archive", "--format=tar", f"--prefix={name}/", "HEAD"]
    tar = subprocess.run(archive, check=True, capture_output=True).stdout
    path = wheel.DISTRIBUTIONS / f"{name}.tar.gz"
    with open(path, "wb") as file, gzip.GzipFile("", "wb", 9, file, mtime=0) as compressed:
        compressed.write(tar)
    installing.say(f"made {path} ({path.stat().st_size / 1e6:.1f} MB)")


def main() -> None:
    parser = argparse.ArgumentParser(prog="./etendue package", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--native", action="store_true", help="for processors like this machine's, from the launcher's own build")
    parser.add_argument("--no-build", action="store_true", help="of what is built already")
    arguments = parser.parse_args()
    built = installing.installed(arguments.native, not arguments.no_build, ["3.11", "3.12"])
    tree = installing.FOLDER / "debian"
    lay_out(tree, built)
    wheel.DISTRIBUTIONS.mkdir(parents=True, exist_ok=True)
    make_debian_package(tree)
    for path in sorted(wheel.DISTRIBUTIONS.glob("etendue_*.deb")):
        depends = subprocess.run(["dpkg-deb", "-f", path, "Depends"], check=True, capture_output=True, text=True).stdout
        count = len(re.findall(r"[^,]+", depends))
        installing.say(f"made {path} ({path.stat().st_size / 1e6:.1f} MB), which depends on {count} packages")
    make_source_archive()


if __name__ == "__main__":
    main()
