#!/usr/bin/env python3
"""Which MaterialX documents are rendered: reads and renders all below a folder, and prints a table for docs/results/materialx.md.

    benchmarks/materialx.py --program build/etendue MaterialX/resources/Materials --allow MaterialX --pictures pictures

The documents are those of github.com/AcademySoftwareFoundation/MaterialX, resources/Materials (Apache-2.0), which the PyPI package
`materialx` is released with. Each is rendered small, with few samples: whether it renders, and what the program says is lost. Errors
are counted by document, losses by what is lost. A picture that is black, or has light where none is, is told: then look at it.
"""
import argparse
import collections
import os
import pathlib
import re
import subprocess
import sys
import time


def lost(line):
    """What a warning says, without names of files and materials, so that equal losses are counted together."""
    line = re.sub(r"^(\S+: )?warning: ", "", line)
    line = re.sub(r"'[^']*\.(png|jpg|bmp|gif|tga|hdr|exr|tx|jpeg)'", "…", line)
    line = re.sub(r"^\w+: ", "", line)
    line = re.sub(r"^\S+ is left out: ", "a material is left out: ", line)
    return re.sub(r"^the colour space '[^']*'", "the colour space", line)


def render(program, document, allow, picture, timeout):
    command = [program, "render", str(document), "--samples", "4", "--size", "64x64", "-o", str(picture)]
    for folder in allow:
        command += ["--allow-path", folder]
    begin = time.time()
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=timeout, check=False)
    except subprocess.TimeoutExpired:
        return f"takes more than {timeout} s", [], timeout
    lines = [line for line in done.stderr.splitlines() if line.strip()]
    warnings = list(dict.fromkeys(lost(line) for line in lines if "warning:" in line))
    errors = [line for line in lines if "warning:" not in line and re.match(r"\S*\.mtlx\S*: ", line)]
    reason = "" if done.returncode == 0 else re.sub(r"^(\S+\.mtlx: ?)?(plugin '[^']*': )?", "", (errors or lines or ["?"])[0])
    return reason, warnings, time.time() - begin


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--program", default="build/etendue")
    parser.add_argument("--allow", action="append", default=[], help="a folder from which images may be read")
    parser.add_argument("--pictures", type=pathlib.Path, default=pathlib.Path("pictures"))
    parser.add_argument("--timeout", type=float, default=300, help="[s] for a document")
    given = parser.parse_args()
    os.makedirs(given.pictures, exist_ok=True)
    groups = collections.OrderedDict()
    for document in sorted(given.folder.rglob("*.mtlx")):
        group = groups.setdefault(str(document.parent.relative_to(given.folder)), [])
        name = str(document.relative_to(given.folder)).replace("/", "__")
        reason, warnings, seconds = render(given.program, document, given.allow, given.pictures / (name + ".png"), given.timeout)
        group.append((document.stem, reason, warnings, seconds))
        print(f"{name}: {reason or 'renders'}", file=sys.stderr)
    print("| folder | documents | render | of these with losses | do not |\n|---|---|---|---|---|")
    for folder, entries in groups.items():
        good = [e for e in entries if not e[1]]
        print(f"| {folder} | {len(entries)} | {len(good)} | {sum(1 for e in good if e[2])} | {len(entries) - len(good)} |")
    every = [e for entries in groups.values() for e in entries]
    good = sum(1 for e in every if not e[1])
    print(f"| **all** | {len(every)} | {good} | {sum(1 for e in every if not e[1] and e[2])} | {len(every) - good} |")
    print("\n| document that does not render | why |\n|---|---|")
    for name, reason, _, _ in every:
        if reason:
            print(f"| {name} | {reason} |")
    losses = collections.defaultdict(list)
    for name, _, warnings, _ in every:
        for warning in warnings:
            losses[warning].append(name)
    print("\n| what is lost | documents |\n|---|---|")
    for warning, names in sorted(losses.items(), key=lambda item: -len(item[1])):
        print(f"| {warning} | {len(names)}: {', '.join(names[:4])}{' …' if len(names) > 4 else ''} |")


if __name__ == "__main__":
    main()
