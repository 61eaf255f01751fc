#!/usr/bin/env python3
"""How much of the sources the tests execute: a table with a row for each folder of src, from the counts of an instrumented build.

    tools/coverage.py build/coverage            prints the table and writes it to build/coverage/coverage.md
    tools/coverage.py build/coverage --html     also writes every source with its counts to build/coverage/html

`./etendue coverage` builds with -DETENDUE_COVERAGE=ON, runs the tests and then this. Processes that are killed, and those that end
by _exit() (the children of tests/hostile/server.cpp), leave no counts. src/assimp, src/draco and src/apart are programs with limits
of their own, which are not instrumented.
"""
import argparse
import collections
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
KINDS = ("lines", "functions", "branches")


def instrumented(build):
    """The programs and libraries of a build that hold a map from counters to sources."""
    places = [build, build / "tests", build / "python" / "etendue"]
    files = {f.resolve() for place in places if place.is_dir() for f in place.iterdir() if f.is_file()}
    return [f for f in sorted(files) if is_elf(f) and b"__llvm_covmap" in f.read_bytes()]


def is_elf(file):
    with open(file, "rb") as opened:
        return opened.read(4) == b"\x7fELF"


def merged(build):
    """One profile of all processes."""
    profiles = sorted((build / "profiles").glob("*.profraw"))
    if not profiles:
        sys.exit(f"there are no counts in {build / 'profiles'}: no test has run")
    profile = build / "coverage.profdata"
    subprocess.run(["llvm-profdata-19", "merge", "-sparse", "-failure-mode=warn", *profiles, "-o", profile], check=True)
    return profile


def arguments_of_llvm_cov(profile, objects):
    return ["-instr-profile", profile, objects[0], *(a for o in objects[1:] for a in ("-object", o))]


def folder_of(file):
    """The folder that a file is counted in: one below src, and of src/components one below that."""
    parts = pathlib.Path(file).relative_to(ROOT / "src").parts[:-1]
    return "/".join(("src", *parts[: 2 if parts[:1] == ("components",) else 1]))


def sums(files):
    """By folder and kind: how many there are, and how many of them are executed."""
    folders = collections.defaultdict(lambda: {kind: [0, 0] for kind in KINDS})
    for file in files:
        if not pathlib.Path(file["filename"]).is_relative_to(ROOT / "src"):
            continue
        for kind in KINDS:
            for folder in (folder_of(file["filename"]), "all"):
                folders[folder][kind][0] += file["summary"][kind]["count"]
                folders[folder][kind][1] += file["summary"][kind]["covered"]
    return folders


def table(folders):
    def percent(count, covered):
        return f"{100 * covered / count:.1f} % of {count}" if count else "-"

    rows = [f"| folder | {' | '.join(KINDS)} |", "|---" * (1 + len(KINDS)) + "|"]
    for folder in sorted(folders, key=lambda f: (f == "all", f)):
        rows.append(f"| {folder} | {' | '.join(percent(*folders[folder][kind]) for kind in KINDS)} |")
    return "\n".join(rows) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--html", action="store_true", help="also every source, with how often each line was executed")
    arguments = parser.parse_args()
    build = arguments.build.resolve()
    objects = instrumented(build)
    if not objects:
        sys.exit(f"nothing in {build} was built with -DETENDUE_COVERAGE=ON")
    common = arguments_of_llvm_cov(merged(build), objects)
    exported = subprocess.run(["llvm-cov-19", "export", "-summary-only", *common], check=True, stdout=subprocess.PIPE)
    text = table(sums(json.loads(exported.stdout)["data"][0]["files"]))
    (build / "coverage.md").write_text(text, encoding="utf-8")
    print(text, end="")
    if arguments.html:
        subprocess.run(["llvm-cov-19", "show", "-format=html", "-output-dir", build / "html", *common,
                        "-sources", ROOT / "src", ROOT / "include"], check=True)
        print(f"{build / 'html' / 'index.html'}: every source")


if __name__ == "__main__":
    main()
