#!/usr/bin/env python3
"""suite.py SUITE [FOLDER...]: runs the test suite of the Open Shading Language's reference implementation, where it lies.

SUITE is the folder `testsuite` of a copy of AcademySoftwareFoundation/OpenShadingLanguage; nothing of it is part of this
project. Each folder has a recipe, run.py, which builds a text of commands with functions such as testshade(...). The recipe is
evaluated here with functions of our own, so that nothing is run but `etendue shade` (and OpenImageIO's tools, which make
textures). What the shaders print and the pictures that they make are compared to the folder's ref/.

A folder's verdict is one of
  same       as one of the expected outputs
  runs       the reference expects two of its own modes to agree, and states no output; here all commands succeed
  intended   differs for the reason in INTENDED
  excluded   needs what is in EXCLUDED
  differs    the rest: the number that is to become 0
The reference's one and two ways of telling (`Compiled x.osl -> x.oso`, `Connect a.b to c.d`, warnings of its compiler and its
optimizer) are left out of the comparison of texts; numbers agree within 1e-5, or one unit of the last digit that is printed.

With --compare-compilers each command of a folder runs twice, interpreted and as machine code, and a folder `disagrees` where texts
or pictures are not the same to the bit (but for not-a-number's sign and payload); the expected outputs do not matter then.

Needs numpy and PyPI's openimageio (also for its idiff, oiiotool and maketx). The exit status is 0 if nothing differs.
"""

import argparse
import builtins
import concurrent.futures
import contextlib
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import types

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent

EXCLUDED = {
    "backend-cpp": "writes the reference's own C++",
    "compstats": "statistics of the reference's optimizer; testrender",
    "example-batched-deformer": "a program that links with the reference",
    "example-cuda": "GPU; a program that links with the reference",
    "example-deformer": "a program that links with the reference",
    "globals-needed": "prints what the reference's optimizer found",
    "groupdata-opt": "prints the size of the reference's own data",
    "debug-uninit": "prints operations of the reference's intermediate format",
}

INTENDED = {
    "blackbody": "of 192,000 half numbers, up to thousands, none differs by more than one step of half; the threshold is absolute",
    "bug-array-heapoffsets": "textures are filtered by our own filter, over the ellipse of the derivatives",
    "compassign-bool": "varying_le.osl and varying_lt.osl declare each other's names, by which the reference finds what it compiled; "
    "shaders are found by their files' names here",
    "debugnan": "a check of values for not-a-number after each operation is an option of the reference, not of the language",
    "derivs": "pow(0, 0) is 1 with and without derivatives; the reference gives 0 where it computes derivatives",
    "error-malformed": "the reason why a file cannot be opened is told in words of our own",
    "error-serialized": "an error in the text of a group is told once",
    "getattribute-shader": "shader:shadername and the like are known under a computed name, too, where the reference knows constants",
    "gettextureinfo": "averagecolor is the mean of the image, not its smallest MIP level",
    "layers-entry": "with lazyglobals=0 each layer that may assign Ci runs; the reference's optimizer removes assignments first",
    "lazytrace": "trace() is refused: rays are the renderer's",
}

# Lines that the reference's compiler, optimizer or harness add; they state no result of a shader.
REMARKS = re.compile(
    r"WARNING: the option '[^']*' has no effect$|Compiled \S+ -> \S+$|Connect \S+ to \S+$|Output \S+ to \S+$|\S+: warning: |WARNING: Optimization warning|"
    r"  (group|layer|source|issue): |        (group|place): |.*\.oso\b.*could be found|Dump of |\(node \w+\)|Entry (layers|outputs): "
)
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


class Refused(Exception):
    """A recipe asks for what is not run here."""


# ---- recipes ---------------------------------------------------------------------------------------------------------------


class Recipe:
    """What a folder's run.py asks for: commands, the files to compare, and tolerances."""

    def __init__(self, folder):
        self.runs = []  # one list of commands for each call of runtest
        scope = self.scope(folder)
        exec(compile((folder / "run.py").read_text(encoding="utf-8"), str(folder / "run.py"), "exec"), scope)
        if scope["runtest"] is not self.runtest:  # the recipe has its own loop around the usual one
            scope["runtest"](scope["command"], scope["outputs"])
        else:
            self.runtest(scope["command"])
        self.outputs = list(dict.fromkeys(scope["outputs"]))
        self.threshold, self.percent = scope["failthresh"], scope["failpercent"]
        self.compiles = scope["compile_osl_files"]
        self.failure_expected = scope["failureok"]
        self.filter = scope["filter_re"]

    def scope(self, folder):
        def command(kind):
            return lambda *words, **_: f"@{kind} " + " ".join(str(word) for word in words) + " ;\n"

        # A recipe cannot reach files or processes: it says what is to be run.
        modules = {"os": types.SimpleNamespace(path=types.SimpleNamespace(isfile=lambda _: False, exists=lambda _: False, join=os.path.join),
                                               environ={}, remove=lambda _: None),
                   "platform": types.SimpleNamespace(system=lambda: "Linux")}

        def imported(name, *_, **__):
            if name in modules:
                return modules[name]
            raise Refused(f"its recipe imports {name}")

        harmless = {name: getattr(builtins, name) for name in ("range", "len", "str", "int", "float", "list", "dict", "enumerate",
                    "zip", "sorted", "any", "all", "min", "max", "abs", "tuple", "set", "isinstance", "bool")}
        scope = {"__builtins__": {**harmless, "__import__": imported, "print": lambda *_: None}, "__name__": "run", **modules}
        for kind in ("testshade", "oslc", "oslinfo", "testrender", "testoptix", "oiiotool", "maketx", "run_app", "oiiodiff", "app"):
            scope[kind] = command(kind)
        scope.update(runtest=self.runtest, command="", outputs=["out.txt"], failthresh=0.004, failpercent=0.02, hardfail=0.01,
                     compile_osl_files=True, failureok=False, filter_re=None, redirect=" >> out.txt 2>&1 ", pythonbin="python3",
                     splitsymbol=";", path=lambda p: p, test_source_dir=str(folder), refdir="ref/", OSL_TESTSUITE_SKIP_DIFF=False)
        return scope

    def runtest(self, command, *_, **__):
        lines = [line.strip(" ;\n") for line in re.split(r";\s*\n|\n|(?<=\s);(?=\s)", command)]
        self.runs.append([line for line in lines if line])
        return 0


# ---- running ---------------------------------------------------------------------------------------------------------------


class Runner:
    def __init__(self, options):
        self.program, self.options = options.program, options
        self.tools = pathlib.Path(sys.executable).parent
        self.disagreements = {}  # by folder: the first command whose two ways differ

    def run(self, words, folder):
        try:
            done = subprocess.run(words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=self.options.seconds,
                                  check=False)
            return done.returncode, done.stdout.decode("utf-8", "replace")
        except subprocess.TimeoutExpired as late:
            return 124, (late.stdout or b"").decode("utf-8", "replace") + f"\nTIMEOUT after {self.options.seconds} s\n"

    def shade(self, words, folder, defines):
        standard = self.options.suite.parent / "src" / "shaders"  # oslutil.h and the like
        command = [self.program, "shade", "-I", folder.parent, "-I", standard, *defines, *words]
        if not self.options.compare_compilers:
            return self.run(command, folder)
        kept = folder.parent / f"{folder.name}_interpreted"
        shutil.rmtree(kept, ignore_errors=True)
        shutil.copytree(folder, kept, symlinks=True)
        found = {way: self.run([*command[:2], f"--{way}", *command[2:]], place) for way, place in (("interpreter", kept), ("compiler", folder))}
        difference = None if signless(found["interpreter"]) == signless(found["compiler"]) else first_difference(found)
        for path in sorted(folder.iterdir()):
            if not difference and path.is_file() and not path.is_symlink() and not same_file(path, kept / path.name):
                difference = f"{path.name} is not the same"
        if difference:
            self.disagreements.setdefault(folder.name, f"'{' '.join(words)[:80]}': {difference}")
        shutil.rmtree(kept)
        return found["interpreter"]

    def command(self, line, folder, defines):
        """The status and the text of one command of a recipe."""
        if not line.startswith("@"):
            words = shlex.split(line.split(">>")[0])
            if words and words[0] == "echo":
                return 0, " ".join(words[1:]) + "\n"
            raise Refused(f"'{line[:60]}'")
        kind, _, rest = line[1:].partition(" ")
        words = shlex.split(rest)
        if kind == "testshade":
            return self.shade(words, folder, defines)
        if kind == "oslc":
            defines[:] = [word for word in words if word.startswith("-D")]
            status, text = self.shade(["--check", words[-1]], folder, defines)
            return status, text if status else ""
        if kind == "oslinfo" and words[:1] == ["-v"] and len(words) == 2:
            return self.shade(["--describe", words[1]], folder, defines)
        if kind in ("oiiotool", "maketx"):
            tool = self.tools / kind
            if not tool.exists():
                raise Refused(f"'{kind}', which PyPI's openimageio brings")
            return self.run([tool, *words], folder)[0], ""
        raise Refused(f"'{kind}'")


# ---- comparing -------------------------------------------------------------------------------------------------------------


def same_number(a, b):
    try:
        x, y = float(a), float(b)
    except ValueError:
        return a == b
    if x == y:
        return True
    digits = [len(n.split("e")[0].partition(".")[2]) for n in (a, b)]
    unit = 10.0 ** -min(digits) if "e" not in a + b and max(digits) else 0
    return abs(x - y) <= max(1e-5 * max(1, abs(x), abs(y)), 1.01 * unit if 0 < unit <= 1e-3 * max(1, abs(x)) else 0)


def same_line(a, b):
    if a.split() == b.split():
        return True
    if NUMBER.sub("#", " ".join(a.split())).replace("-#", "#") != NUMBER.sub("#", " ".join(b.split())).replace("-#", "#"):
        return False
    return all(same_number(x, y) for x, y in zip(NUMBER.findall(a), NUMBER.findall(b)))


def result_lines(text):
    """Without remarks and what belongs to them, which is indented below a warning; groups without a name have any number."""
    lines, warning = [], False
    for line in text.splitlines():
        warning = ": warning: " in line or (warning and line.startswith("  "))
        if line.strip() and not warning and not REMARKS.match(line):
            lines.append(re.sub(r"unnamed_group_\d+", "unnamed_group", line.rstrip()))
    return lines


def text_difference(ours, theirs, pattern=None):
    """The first line that differs, or None."""
    a, b = result_lines(ours), result_lines(theirs)
    if pattern:
        a = [line for line in a if re.search(pattern, line)]
    for i in range(max(len(a), len(b))):
        x, y = (lines[i] if i < len(lines) else "(nothing)" for lines in (a, b))
        if not same_line(x, y):
            return f"line {i + 1}: {x.strip()[:100]!r}, expected {y.strip()[:100]!r}"
    return None


def image_difference(ours, theirs, threshold, percent):
    """As the reference's idiff says it: more than `percent` of the pixels are off by more than `threshold`."""
    import numpy
    import OpenImageIO

    def pixels(path):
        image = OpenImageIO.ImageBuf(str(path))
        if image.has_error:
            raise ValueError(image.geterror())
        values = numpy.asarray(image.get_pixels(OpenImageIO.FLOAT))
        # The reference writes an int output as 32-bit integers, which are read as fractions of the largest one.
        return values * 2147483647.0 if str(image.spec().format) in ("int", "int32") else values

    a, b = pixels(ours), pixels(theirs)
    if a.shape != b.shape:
        return f"size {a.shape}, expected {b.shape}"
    both = (numpy.isnan(a) & numpy.isnan(b)) | (a == b)
    off = numpy.where(both, 0, numpy.abs(a - b))
    off[numpy.isnan(off)] = numpy.inf
    worst = off.max(axis=2)
    bad = (worst > threshold).mean() * 100
    return None if bad <= percent else f"{bad:.2f} % of the pixels are off by more than {threshold} (the most: {worst.max():.4g})"


def signless(result):
    status, text = result
    return status, text.replace("-nan", "nan")


def first_difference(found):
    (a, ours), (b, theirs) = (signless(found[way]) for way in ("interpreter", "compiler"))
    if a != b:
        return f"status {a} and {b}: {theirs.strip()[-200:]!r}"
    lines = zip(ours.splitlines() + ["(nothing)"], theirs.splitlines() + ["(nothing)"])
    return next((f"{x[:100]!r} and {y[:100]!r}" for x, y in lines if x != y), "")


def same_file(a, b):
    """Whether bytes, or all pixels, are the same; not-a-number is one number."""
    if not b.exists():
        return False
    if a.read_bytes() == b.read_bytes():
        return True
    import numpy
    import OpenImageIO

    x, y = (OpenImageIO.ImageBuf(str(path)) for path in (a, b))
    if x.has_error or y.has_error:
        return False
    p, q = (numpy.asarray(image.get_pixels(OpenImageIO.FLOAT)) for image in (x, y))
    return p.shape == q.shape and bool(((p.view("u4") == q.view("u4")) | (numpy.isnan(p) & numpy.isnan(q))).all())


def expected_files(reference, name):
    """The expected file of a name, and its variants: out-alt.txt, out2.txt, ..."""
    stem, ending = pathlib.Path(name).stem, pathlib.Path(name).suffix
    exact = [reference / name] if (reference / name).exists() else []
    return exact + sorted(set(reference.glob(f"{stem}[-_.0-9]*{ending}")) - set(exact))


# ---- a folder --------------------------------------------------------------------------------------------------------------


def verdict(runner, folder, scratch):
    name = folder.name
    if name in EXCLUDED:
        return "excluded", EXCLUDED[name]
    if not (folder / "run.py").exists():
        return "excluded", "no recipe"
    try:
        recipe = Recipe(folder)
    except Refused as reason:
        return "excluded", f"{reason}"
    work = scratch / name
    shutil.copytree(folder, work)
    with contextlib.suppress(FileExistsError):
        (work / "data").symlink_to(".")
    failed = ""
    try:
        texts, defines = [], []
        for run in recipe.runs:
            texts.append("")
            for line in run:
                status, printed = runner.command(line, work, defines)
                texts[-1] += printed
                if status and not recipe.failure_expected and not failed:
                    last = (result_lines(printed) or [""])[-1]
                    failed = f"'{line[1:80]}' ends with {status}: {last[:160]}"
    except Refused as reason:
        return "excluded", f"needs {reason}"
    if runner.options.compare_compilers:
        difference = runner.disagreements.get(name)
        return ("disagrees", difference) if difference else ("agrees", "")
    (work / "out.txt").write_text(texts[-1], encoding="utf-8")
    reference = folder / "ref"
    compared = 0
    for output in recipe.outputs:
        candidates = expected_files(reference, output)
        if not candidates:
            continue
        compared += 1
        if not (work / output).exists():
            return "differs", failed or f"{output} was not written"
        found = None
        for candidate in candidates:
            try:
                if output.endswith(".txt"):
                    ours = texts if output == "out.txt" else [(work / output).read_text("utf-8", "replace")]
                    theirs = candidate.read_text("utf-8", "replace")
                    found = next((d for d in (text_difference(text, theirs, recipe.filter) for text in ours) if d), None)
                else:
                    found = image_difference(work / output, candidate, recipe.threshold, recipe.percent)
            except ValueError as error:
                found = str(error)
            if found is None:
                break
            first = found if candidate == candidates[0] else first
        else:
            if name in INTENDED:
                return "intended", INTENDED[name]
            return "differs", f"{output}: {first}" + (f"; {failed}" if failed else "")
    if failed:
        return "differs", failed
    return ("same", "") if compared else ("runs", "")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("suite", type=pathlib.Path, help="the reference's folder 'testsuite'")
    parser.add_argument("folders", nargs="*", help="these folders alone")
    parser.add_argument("--program", default=str(ROOT / "build/etendue"))
    parser.add_argument("--keep", type=pathlib.Path, help="a folder in which all outputs remain")
    parser.add_argument("--compare-compilers", action="store_true", help="interpreter against machine code, not against the expected outputs")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=60, help="the longest time of one command")
    parser.add_argument("--json", type=pathlib.Path, help="writes the verdicts")
    options = parser.parse_args()
    runner = Runner(options)
    names = options.folders or sorted(p.name for p in options.suite.iterdir() if (p / "run.py").exists() and p.name != "common")
    scratch = options.keep or pathlib.Path(tempfile.mkdtemp(prefix="osl_suite_"))
    shutil.rmtree(scratch, ignore_errors=True)
    scratch.mkdir(parents=True)
    shutil.copytree(options.suite / "common", scratch / "common")
    verdicts = {}
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        jobs = {name: pool.submit(verdict, runner, options.suite / name, scratch.resolve()) for name in names}
        for name, job in jobs.items():
            kind, reason = verdicts[name] = job.result()
            print(f"{kind:9} {name:34} {reason}", flush=True)
    if not options.keep:
        shutil.rmtree(scratch)
    kinds = ("agrees", "excluded", "disagrees") if options.compare_compilers else ("same", "runs", "intended", "excluded", "differs")
    counts = {kind: sum(v[0] == kind for v in verdicts.values()) for kind in kinds}
    print("\n" + ", ".join(f"{count} {kind}" for kind, count in counts.items()))
    if options.json:
        options.json.write_text(json.dumps(verdicts, indent=1) + "\n", encoding="utf-8")
    return 1 if counts[kinds[-1]] else 0


if __name__ == "__main__":
    os.environ.setdefault("LC_ALL", "C.UTF-8")
    sys.exit(main())
