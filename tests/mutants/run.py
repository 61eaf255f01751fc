#!/usr/bin/env python3
"""Puts deliberate mistakes into the sources, one at a time, and counts how many of them the tests notice.

Each file *.mutant beside this one describes a mistake: what it is, the source it is in, the text to find there (which must
occur once), what stands in its place, and the tests that are likely to notice. For each mistake

1. the source is copied with the mistake in it, and only what includes that source is compiled, with the commands of an
   existing build, and linked into a copy of the library of its own (nothing in the build folder is changed);
2. the tests it names run with that library; when they pass, all tests of the suite do that are not among the slow ones.

A mistake that no test notices survives. The score is the part of the mistakes that were noticed.

    tests/mutants/run.py --list              names, and what the mistakes are
    tests/mutants/run.py --check             that each still applies to the sources (part of the test suite)
    tests/mutants/run.py                     all of them, against ./build
    tests/mutants/run.py --only plastic_*    some of them
"""

import argparse
import concurrent.futures
import contextlib
import fcntl
import fnmatch
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent

# What takes long and tests programs or statistics, not numbers: left out when a mistake survived the tests it names.
SLOW = ["BuiltIn/*", "Conform*", "Faulty*", "Conform.*", "Checkpoint*", "Verify*", "VerifyScenes*", "SeededBugs*", "Plugin*", "Program*",
        "*ProgramTest*", "ReplayProgram*", "Manual*", "*LanguageMutation*", "NoLeaks*", "Rows/*", "Robustness*", "Scenes/*",
        "CornellBox*", "*DegenerateObjects*", "NestedPictures*", "Renderers/NestedPictures*", "All/EndlessSurfaces*",
        "SubdivisionSurface*", "DisplacedMesh*", "Subsurface*", "SceneStructures*", "Measured*"]


# What is made: the library, what is linked with it or loaded from the folder it lies in itself, and the tests.
LIBRARY = "libetendue.so"
BESIDE = ["libetendue_openimageio.so", "libetendue_formats.so", "libetendue_osl.so", "libetendue_laboratory.so", "libetendue_studio.so",
          "libetendue_app.so", "libetendue_commands.so"]


class Mutant:
    """One file: a line `# what the mistake is`, lines `file:` and `tests:`, and pairs of blocks `--- find`, `--- replace`."""

    def __init__(self, path):
        self.name = path.stem
        self.what, self.tests, self.edits = "", "", []
        file, block, blocks = None, None, []
        for line in path.read_text(encoding="utf-8").splitlines():
            if line.startswith("--- "):
                block = [line[4:].strip(), file, []]
                blocks.append(block)
            elif block is not None and not re.match(r"^file: ", line):
                block[2].append(line)
            elif line.startswith("# "):
                self.what += (" " if self.what else "") + line[2:].strip()
            elif line.startswith("file:"):
                file, block = line[5:].strip(), None
            elif line.startswith("tests:"):
                self.tests = line[6:].strip()
            elif line.strip():
                raise ValueError(f"{path.name}: cannot read the line '{line}'")
        for find, replace in zip(blocks[::2], blocks[1::2]):
            if find[0] != "find" or replace[0] != "replace" or not find[1]:
                raise ValueError(f"{path.name}: wants a file and blocks '--- find' and '--- replace' by turns")
            self.edits.append((find[1], "\n".join(find[2]).strip("\n"), "\n".join(replace[2]).strip("\n")))
        if len(blocks) % 2 or not self.edits or not self.what or not self.tests:
            raise ValueError(f"{path.name}: wants '# what', 'file:', 'tests:', '--- find' and '--- replace'")

    def area(self):
        folders = [part for part in self.edits[0][0].split("/")[:-1] if part not in ("src", "include", "etendue", "components")]
        return folders[0] if folders else "include"

    def apply(self):
        """Texts of the changed files by their paths; ValueError where the mistake does not apply any more."""
        texts = {}
        for file, find, replace in self.edits:
            path = ROOT / file
            if not path.is_file():
                raise ValueError(f"{self.name}: there is no {file}")
            text = texts.get(file) or path.read_text(encoding="utf-8")
            count = text.count(find)
            if count != 1:
                raise ValueError(f"{self.name}: its text occurs {count} times in {file}, not once: {find.splitlines()[0].strip()}")
            if find == replace:
                raise ValueError(f"{self.name}: changes nothing")
            texts[file] = text.replace(find, replace)
        return texts


def mutants(patterns):
    found = [Mutant(p) for p in sorted(HERE.glob("*.mutant"))]
    names = {m.name for m in found}
    for p in patterns:
        if not any(fnmatch.fnmatch(n, p) for n in names):
            sys.exit(f"no mistake is called '{p}'")
    return [m for m in found if not patterns or any(fnmatch.fnmatch(m.name, p) for p in patterns)]


class Build:
    """The commands and objects of an existing build folder."""

    def __init__(self, folder, lock, tests):
        self.folder, self.lock = folder, lock
        self.tests = pathlib.Path(tests).resolve() if tests else folder / "tests/etendue_tests"
        # Where the sources were when they were compiled.
        cache = (folder / "CMakeCache.txt").read_text(encoding="utf-8")
        self.root = pathlib.Path(re.search(r"^CMAKE_HOME_DIRECTORY:INTERNAL=(.*)$", cache, re.M).group(1))
        self.compile = {}  # object -> (source, command)
        for entry in json.loads((folder / "compile_commands.json").read_text(encoding="utf-8")):
            words = shlex.split(entry["command"])
            made = words[words.index("-o") + 1]
            self.compile[made] = (entry["file"], words)
        self.includes = self.dependencies()
        self.links = {name: self.link_command(name) for name in (LIBRARY, *BESIDE, "tests/etendue_tests")}

    def ninja(self, *words):
        return subprocess.run(["ninja", "-C", str(self.folder), *words], check=True, capture_output=True, text=True).stdout

    def dependencies(self):
        """Of each source below the root: the objects made of it."""
        users, target = {}, None
        for line in self.ninja("-t", "deps").splitlines():
            if line and not line.startswith(" "):
                target = line.split(":")[0]
            elif line.strip() and target in self.compile:
                path = os.path.normpath(self.folder / line.strip())
                users.setdefault(path, set()).add(target)
        return users

    def link_command(self, name):
        out = os.path.realpath(self.folder / name)
        for line in reversed(self.ninja("-t", "commands", os.path.relpath(out, self.folder)).splitlines()):
            # ": && command && :" with words after it, such as making a link.
            for part in line.split("&&"):
                words = shlex.split(part)
                if "-o" in words and words[words.index("-o") + 1] == os.path.relpath(out, self.folder):
                    return words
        raise RuntimeError(f"the build has no command that links {name}")

    @contextlib.contextmanager
    def locked(self):
        if not self.lock:
            yield
            return
        with open(self.lock, "a", encoding="utf-8") as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            yield

    def run(self, words):
        done = subprocess.run(words, cwd=self.folder, capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(shlex.join(words[:3]) + " …\n" + done.stderr[-3000:])

    def make(self, texts, place):
        """Compiles and links what the changed sources are part of. Returns the test program to run."""
        shadow = place / "sources"
        # What lies beside a header finds it there first: all sources move with it.
        together = any(file.startswith("src/") and file.endswith(".h") for file in texts)
        if together:
            shutil.copytree(self.root / "src", shadow / "src")
        objects = {}
        for file, text in texts.items():
            copy = shadow / file
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_text(text, encoding="utf-8")
            for made in self.includes.get(str(self.root / file), ()):
                objects[made] = None
        wanted = {name: [o for o in objects if o in words] for name, words in self.links.items()}
        if not any(wanted.values()):
            raise RuntimeError("neither the libraries nor the tests are made of " + ", ".join(texts))
        public = any(file.startswith("include/") for file in texts)
        commands = []
        for made in sorted(set(sum(wanted.values(), []))):
            source, words = self.compile[made]
            words = list(words)
            relative = os.path.relpath(source, self.root)
            if relative in texts or (together and relative.startswith("src/")):
                words[words.index(source)] = str(shadow / relative)
            objects[made] = str(place / (made.replace("/", "_")))
            words[words.index("-o") + 1] = objects[made]
            if public:  # these are part of the precompiled header
                words = without_precompiled(words)
                words[1:1] = ["-include", str(self.root / "src/precompiled.h")]
                if made.startswith("tests/"):
                    words[1:1] = ["-include", "gtest/gtest.h", "-include", "nlohmann/json.hpp"]
            words[1:1] = ["-iquote", os.path.dirname(source), "-I", str(shadow / "src"), "-I", str(shadow / "include")]
            words = [w for w in words if w not in ("-Werror",)] + ["-w"]
            commands.append(words)
        with self.locked() if len(commands) > 4 else contextlib.nullcontext():
            for words in commands:
                self.run(words)
        tests = self.tests
        for name, used in wanted.items():
            if not used:
                continue
            words = [objects.get(w) or w for w in self.links[name]]
            soname = [w[len("-Wl,-soname,"):] for w in words if w.startswith("-Wl,-soname,")]
            out = place / (soname[0] if soname else os.path.basename(name))
            words[words.index("-o") + 1] = str(out)
            self.run(words)
            if not name.startswith("lib"):
                tests = out
        if any(wanted[name] for name in BESIDE) and not wanted[LIBRARY]:
            library = (self.folder / LIBRARY).resolve()
            (place / os.readlink(self.folder / LIBRARY)).symlink_to(library)
        return tests


def without_precompiled(words):
    """Without the options that take in a precompiled header, for either compiler."""
    kept, i = [], 0
    while i < len(words):
        if words[i] == "-Xclang" and i + 3 < len(words) and words[i + 1] in ("-include-pch", "-include"):
            i += 4
        elif words[i] == "-include" and "cmake_pch" in words[i + 1]:
            i += 2
        else:
            kept.append(words[i])
            i += 1
    return kept


class Tests:
    """Runs tests with some library, and knows which fail anyway."""

    def __init__(self, build, seconds):
        self.build, self.seconds = build, seconds
        self.broken = []

    def run(self, program, filters, place, stop=True):
        """(outcome, names of failed tests, seconds)"""
        place.mkdir(parents=True, exist_ok=True)
        temporary = place / "tmp"
        temporary.mkdir(exist_ok=True)
        env = dict(os.environ, TEST_TMPDIR=str(temporary) + "/", GTEST_COLOR="no")
        path = [str(place), str(self.build.folder)]
        env["LD_LIBRARY_PATH"] = ":".join(path + [env["LD_LIBRARY_PATH"]] if env.get("LD_LIBRARY_PATH") else path)
        positive, _, negative = filters.partition("-")
        excluded = ":".join(filter(None, [negative] + self.broken))
        words = [str(program), "--gtest_filter=" + positive + ("-" + excluded if excluded else ""), "--gtest_brief=1"]
        if stop:
            words.append("--gtest_fail_fast")
        began = time.monotonic()
        try:
            # The folder of the tests is the sources' own.
            done = subprocess.run(words, env=env, cwd=ROOT, capture_output=True, text=True, errors="replace",
                                  timeout=self.seconds)
            failed = sorted(set(re.findall(r"^\[  FAILED  \] ([^\s,]+)", done.stdout, re.M)) - {"1"})
            failed = [f for f in failed if "." in f]
            ran = re.search(r"(\d+) tests? from", done.stdout)
            outcome = "passed" if done.returncode == 0 else "failed"
            if done.returncode == 0 and ran and ran.group(1) == "0":
                outcome = "nothing"
            if done.returncode < 0:
                outcome = f"signal {-done.returncode}"
        except subprocess.TimeoutExpired:
            outcome, failed = "too slow", []
        shutil.rmtree(temporary, ignore_errors=True)
        return outcome, failed, time.monotonic() - began


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--list", action="store_true", help="say what the mistakes are")
    p.add_argument("--check", action="store_true", help="check that each mistake still applies")
    p.add_argument("--only", action="append", default=[], metavar="NAME", help="only this one; may be a pattern, and be repeated")
    p.add_argument("--build", default=str(ROOT / "build"), help="a build folder that is up to date (default: build)")
    p.add_argument("--work", help="where to compile (default: a temporary folder)")
    p.add_argument("--jobs", type=int, default=1, help="mistakes at a time")
    p.add_argument("--named-only", action="store_true", help="run only the tests each mistake names")
    p.add_argument("--seconds", type=float, default=1200, help="a test run that takes longer counts as failed")
    p.add_argument("--lock", help="a file to lock while many sources are compiled, where builds must not run at the same time")
    p.add_argument("--tests", help="the test program (default: that of the build)")
    p.add_argument("--keep", action="store_true", help="keep the libraries that were made")
    p.add_argument("--report", help="write outcomes to this file, as JSON")
    a = p.parse_args()

    chosen = mutants(a.only)
    if a.list:
        for m in chosen:
            print(f"{m.name:44} {m.what}")
        return 0
    if a.check:
        errors = []
        for m in chosen:
            try:
                m.apply()
            except ValueError as e:
                errors.append(str(e))
        print("\n".join(errors + [f"{len(chosen) - len(errors)} of {len(chosen)} mistakes apply"]))
        return 1 if errors else 0

    build = Build(pathlib.Path(a.build).resolve(), a.lock, a.tests)
    tests = Tests(build, a.seconds)
    work = pathlib.Path(a.work) if a.work else pathlib.Path(tempfile.mkdtemp(prefix="mutants-"))
    work.mkdir(parents=True, exist_ok=True)

    # Tests that fail without any mistake say nothing of mistakes.
    named = ":".join(sorted({f for m in chosen for f in m.tests.split(":")}))
    outcome, failed, seconds = tests.run(build.tests, named, work / "none", stop=False)
    if outcome not in ("passed", "failed"):
        sys.exit(f"without a mistake the tests end by: {outcome}")
    tests.broken = failed
    print(f"Without a mistake, in {seconds:.0f} s: {outcome}" + (": " + ", ".join(failed) + " (left out)" if failed else ""),
          flush=True)

    def one(m):
        place = work / m.name
        shutil.rmtree(place, ignore_errors=True)
        place.mkdir(parents=True)
        began = time.monotonic()
        try:
            program = build.make(m.apply(), place)
        except (RuntimeError, ValueError) as e:
            return m, "error", str(e), [], time.monotonic() - began
        made = time.monotonic() - began
        outcome, failed, seconds = tests.run(program, m.tests, place)
        by = "named tests"
        if outcome == "nothing":
            return m, "error", "it names no test there is", [], made
        if outcome == "passed" and not a.named_only:
            by = "the suite"
            outcome, failed, seconds = tests.run(program, "*-" + ":".join(SLOW), place)
        if not a.keep:
            shutil.rmtree(place, ignore_errors=True)
        if outcome == "passed":
            return m, "survived", "", [], made + seconds
        return m, "noticed", f"{by} ({outcome})" if outcome != "failed" else by, failed, made + seconds

    rows = []
    with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
        for m, outcome, how, failed, seconds in pool.map(one, chosen):
            rows.append((m, outcome, how, failed))
            print(f"{outcome.upper() if outcome != 'noticed' else outcome:9} {m.name:44} {seconds:5.0f} s  {how}"
                  + (": " + ", ".join(failed[:3]) if failed else ""), flush=True)

    print()
    for area in sorted({m.area() for m, *_ in rows}):
        of = [r for r in rows if r[0].area() == area]
        print(f"  {area:16} {sum(r[1] == 'noticed' for r in of):3} of {len(of):3}")
    noticed, errors = sum(r[1] == "noticed" for r in rows), [r for r in rows if r[1] == "error"]
    for m, outcome, *_ in rows:
        if outcome == "survived":
            print(f"survived: {m.name}: {m.what}")
    for m, _, how, _ in errors:
        print(f"cannot be tried: {m.name}: {how}")
    total = len(rows) - len(errors)
    print(f"Noticed {noticed} of {total} mistakes" + (f", {100 * noticed / total:.1f} %." if total else "."))
    if a.report:
        pathlib.Path(a.report).write_text(json.dumps(
            [{"name": m.name, "area": m.area(), "what": m.what, "outcome": o, "how": h, "tests": f} for m, o, h, f in rows],
            indent=1), encoding="utf-8")
    if not a.work and not a.keep:
        shutil.rmtree(work, ignore_errors=True)
    return 0 if noticed == total and not errors else 1


if __name__ == "__main__":
    sys.exit(main())
