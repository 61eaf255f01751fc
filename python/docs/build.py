#!/usr/bin/env python3
"""Builds the documentation as a static site: the pages of docs, the manual, and the reference of the Python package.

    python3 python/docs/build.py --program build/etendue --output build/docs     (by ./etendue docs)

The folder of sources that Sphinx reads is made anew beside the output: the repository's layout, so that the pages' relative links stay
what they are. Links that lead to nothing end it with an error.
"""

from __future__ import annotations

import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "LICENSE")
sys.path[:0] = [str(pathlib.Path(__file__).parent), str(ROOT / "tests")]

import api  # noqa: E402
import links  # noqa: E402  (what a link is)


def stage(sources: pathlib.Path, program: str) -> None:
    """Makes the folder of sources."""
    shutil.rmtree(sources, ignore_errors=True)
    sources.mkdir(parents=True)
    for name in PAGES:
        shutil.copy(ROOT / name, sources / name)
    shutil.copytree(ROOT / "docs", sources / "docs")
    subprocess.run([program, "manual", "-o", str(sources / "docs/manual")], check=True, stdout=subprocess.DEVNULL)

    for page in list(sources.rglob("*.md")):
        copy_referred(page, sources)
    api.write(sources / "api", sources / "docs/manual")
    add_contents(sources / "docs/index.md")
    for page in [*(sources / "docs").rglob("*.md")]:
        list_folders(page)


def copy_referred(page: pathlib.Path, sources: pathlib.Path) -> None:
    """Copies the files outside of docs that a page refers to, and those that these pages refer to."""
    for link, other in links.LINK.findall(links.without_code(page.read_text(encoding="utf-8"))):
        path = urllib.parse.unquote((link or other).partition("#")[0])
        target = (page.parent / path).resolve() if path and not re.match(r"[a-z][a-z0-9+.-]*:", path) else page
        if target.exists() or not target.is_relative_to(sources.resolve()):
            continue
        original = ROOT / target.relative_to(sources.resolve())
        if original.is_file():
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(original, target)
            if target.suffix == ".md":
                copy_referred(target, sources)


def add_contents(index: pathlib.Path) -> None:
    """The navigation: the sections of the index with their pages, in their order."""
    text = index.read_text(encoding="utf-8")
    trees = []
    for section in re.split(r"(?m)^## ", text)[1:]:
        title, _, body = section.partition("\n")
        pages = dict.fromkeys(re.findall(r"\]\(([^)#\s]+)\.md\)", body))
        entries = "\n".join("/" + str(pathlib.PurePosixPath("docs") / p).replace("docs/../", "") for p in pages)
        trees.append(f"```{{toctree}}\n:hidden:\n:caption: {title}\n\n{entries}\n```\n")
    trees.append("```{toctree}\n:hidden:\n:caption: Reference\n\n/api/index\n```\n")
    index.write_text(text + "\n- [Python reference](../api/index.md): functions, and all classes with their members.\n\n" + "\n".join(trees))


def list_folders(page: pathlib.Path) -> None:
    """A link to a folder of docs becomes one to a page that lists its files."""
    text = page.read_text(encoding="utf-8")
    for target in set(re.findall(r"\]\(([\w./-]+)\)", text)):
        folder = page.parent / target
        if not folder.is_dir():
            continue
        listing = folder / "index.md"
        if not listing.exists():
            files = sorted(f.name for f in folder.iterdir() if f.is_file())
            listing.write_text(f"# {folder.name}\n\n" + "\n".join(f"- [{f}]({f})" for f in files) + "\n", encoding="utf-8")
        text = text.replace(f"]({target})", f"]({target.rstrip('/')}/index.md)")
        page.write_text(text, encoding="utf-8")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", required=True, help="the program, for the manual")
    parser.add_argument("--output", type=pathlib.Path, required=True, help="folder of the site")
    given = parser.parse_args()
    sources = given.output.with_name(given.output.name + "-sources")
    stage(sources, given.program)
    options = ["-W", "--keep-going", "-q", "-b", "html", "-j", "auto", "-c", str(pathlib.Path(__file__).parent)]
    status = subprocess.run([sys.executable, "-m", "sphinx", *options, str(sources), str(given.output)]).returncode
    if status == 0:
        (given.output / "index.html").write_text('<!DOCTYPE html><meta http-equiv="refresh" content="0; url=docs/index.html">\n')
        print(f"{given.output}/index.html")
    return status


if __name__ == "__main__":
    sys.exit(main())
