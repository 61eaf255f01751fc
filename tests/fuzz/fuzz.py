#!/usr/bin/env python3
"""Fuzzes the readers of other programs' files, by turns.

    tests/fuzz/fuzz.py --program build-asan/tests/fuzz/readers_fuzz --seconds 3600              an hour for each
    tests/fuzz/fuzz.py --program build-asan/tests/fuzz/readers_fuzz --runs 100000 pbrt glb      so many inputs for these

Each reader begins with the right files of tests/hostile and with a dictionary of all words in quotes of its sources. --work keeps
what it finds to be new for the next time, and inputs that crash, hang, leak or take more memory than --memory. Exit
status: 0 when there is none.
"""
import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/hostile"))
import seed_models  # noqa: E402
import seed_scenes  # noqa: E402
import seeds  # noqa: E402

SOURCES = {"mitsuba": ["importers/mitsuba"], "pbrt": ["importers/pbrt"], "gltf": ["importers/gltf"], "glb": ["importers/gltf", "importers/gltf/compressed"],
           "obj": ["importers/meshes", "objects/meshes"], "mtl": ["importers/meshes"], "stl": ["objects/meshes"],
           "off": ["objects/meshes"], "ply": ["objects/meshes"]}


def readers():
    """For each reader its right files, and those beside them."""
    scenes = {**seed_scenes.beside(), "brdf.bsdf": seeds.rgl()}
    models = {}
    for name, file, data, _, files in seed_models.models():
        reader = "mtl" if name == "mtl" else file.split(".")[1]
        right, beside = models.setdefault(reader, ([], {}))
        right.append(data)
        beside.update(files)
    mitsuba, pbrt = [data for _, data in seed_scenes.mitsuba_scenes()], [data for _, data in seed_scenes.pbrt_scenes()]
    return {
        "mitsuba": (mitsuba, scenes),
        "mitsuba_included": ([seed_scenes.MITSUBA_FRAGMENT], {**scenes, "scene.xml": seed_scenes.MITSUBA_INCLUDING}),
        "pbrt": (pbrt, scenes),
        "pbrt_included": ([seed_scenes.PBRT_FRAGMENT], {**scenes, "scene.pbrt": seed_scenes.PBRT_INCLUDING}),
        **models,
        "ply": ([seeds.ply(kind) for kind in ("ascii", "binary_little_endian", "binary_big_endian")] + [seed_scenes.PLY], {}),
        "serialized": ([seed_scenes.serialized_mesh(*kind) for kind in ((4, 0x1001), (4, 0x200B), (3, 0x1012))], {}),
        "nvdb": ([seed_scenes.nanovdb()], {}),
        "vol": ([seed_scenes.volume(1), seed_scenes.volume(3), seed_scenes.volume(1, 3)], {}),
        "npy": ([seeds.numpy_array((2, 3, 4)), seeds.numpy_array((2, 3, 4, 3), "f8")], {}),
    }


def dictionary(reader):
    words = set()
    for folder in SOURCES.get(reader.split("_")[0], []):
        for source in (ROOT / "src/components" / folder).glob("*.cpp"):
            words.update(re.findall(r'"([\w.+:-]{2,30})"', source.read_text()))
    return "".join(f'"{word}"\n' for word in sorted(words))


def fuzz(arguments, reader, right, beside, work):
    folder = work / reader
    for name, files in (("beside", beside), ("right", {f"{i}": data for i, data in enumerate(right)}), ("corpus", {}), ("found", {})):
        (folder / name).mkdir(parents=True, exist_ok=True)
        for file, data in files.items():
            (folder / name / file).write_bytes(data)
    words = dictionary(reader)
    (folder / "words").write_text(words)
    command = [arguments.program, f"--reader={reader}", f"--beside={folder / 'beside'}", f"-timeout={arguments.timeout}", f"-rss_limit_mb={arguments.memory}",
               "-max_len=16384", *([f"-dict={folder / 'words'}"] if words else []), f"-artifact_prefix={folder / 'found'}/", f"-seed={arguments.seed}",
               "-print_final_stats=1", "-close_fd_mask=1"]
    command += [f"-runs={arguments.runs}"] if arguments.runs else [f"-max_total_time={arguments.seconds}"]
    environment = dict(os.environ, UBSAN_OPTIONS="print_stacktrace=1", ASAN_OPTIONS="allocator_may_return_null=0")
    with open(folder / "log", "wb") as log:  # the program's own warnings are in it too
        status = subprocess.run(command + [folder / "corpus", folder / "right"], stdout=log, stderr=log, env=environment).returncode
    said = (folder / "log").read_bytes().decode(errors="replace")
    numbers = {key: int(value) for key, value in re.findall(r"stat::(\w+):\s+(\d+)", said)}
    covered = re.findall(r"cov: (\d+) ft: (\d+)", said) or [("?", "?")]
    print(f"{reader}: {numbers.get('number_of_executed_units', '?')} inputs, {numbers.get('average_exec_per_sec', '?')} a second, "
          f"{covered[-1][0]} places reached, most memory {numbers.get('peak_rss_mb', '?')} MB, "
          f"slowest {numbers.get('slowest_unit_time_sec', '?')} s: {'nothing found' if status == 0 else 'FOUND, see ' + str(folder)}",
          flush=True)
    return status == 0


def main():
    all_readers = readers()
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True, type=lambda p: str(pathlib.Path(p).resolve()))
    parser.add_argument("--seconds", type=int, default=60)
    parser.add_argument("--runs", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--timeout", type=int, default=10, help="[s] by the clock: more where other programs run at the same time")
    parser.add_argument("--memory", type=int, default=1024, help="[MB]; the program itself and the sanitizers take about 300")
    parser.add_argument("--work", type=pathlib.Path)
    parser.add_argument("reader", nargs="*", choices=[*all_readers, []], default=[])
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        work = (arguments.work or pathlib.Path(folder)).resolve()
        # Not stopped by what one of them finds.
        return 0 if all([fuzz(arguments, r, *all_readers[r], work) for r in arguments.reader or all_readers]) else 1


if __name__ == "__main__":
    sys.exit(main())
