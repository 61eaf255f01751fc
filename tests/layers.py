#!/usr/bin/env python3
"""Checks that sources include downwards only, as src/layers.txt says, and that every folder has its place there."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
MOST_FILES = 40  # in one folder: what belongs together stays together, as far as a person can survey it


def layers():
    lines = (ROOT / "src/layers.txt").read_text(encoding="utf-8").splitlines()
    return [line.split()[0] for line in lines if line.strip() and not line.startswith("#")]


def layer_of(path):
    """Of a file: its folder below src, or that to which a public header belongs."""
    parts = path.relative_to(ROOT).parts[:-1]
    if parts[0] == "include":
        return "/".join(parts[2:]) or "interfaces"
    return "/".join(parts[1:])


def target(file, text):
    for base in (file.parent, ROOT / "src", ROOT / "include"):
        if (base / text).is_file():
            return base / text
    return None


def main():
    order = {name: i for i, name in enumerate(layers())}
    wrong = []
    counts = {}
    for file in sorted([*ROOT.glob("src/**/*.h"), *ROOT.glob("src/**/*.cpp"), *ROOT.glob("include/**/*.h")]):
        if file.parent == ROOT / "src":  # the precompiled header
            continue
        name = file.relative_to(ROOT)
        counts[name.parent] = counts.get(name.parent, 0) + 1
        own = layer_of(file)
        if own not in order:
            wrong.append(f"{name}: src/layers.txt does not know the folder {own}")
            continue
        for text in re.findall(r'^\s*#\s*include "([^"]+)"', file.read_text(encoding="utf-8"), re.M):
            included = target(file, text)
            if included is None:
                wrong.append(f"{name}: there is no {text}")
            elif order.get(layer_of(included), -1) > order[own]:
                wrong.append(f"{name} ({own}) includes {text} of the higher layer {layer_of(included)}")
    for folder, count in sorted(counts.items()):
        if count > MOST_FILES:
            wrong.append(f"{folder} holds {count} files, more than {MOST_FILES}")
    print("\n".join(wrong + [f"{sum(counts.values())} files in {len(order)} layers: {len(wrong)} wrong"]))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
