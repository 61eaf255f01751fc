#!/usr/bin/env python3
"""Converts scenes of other programs and compares the pictures of the converted files with those of the originals: bytes by bytes.

    tests/references/converted.py --program build/etendue --data ../shared/validation
    tests/references/converted.py --program build/etendue --data ../shared/validation --all     # every file there

Small scenes of each format are written here; those of the validation data are taken when there are any. Each is rendered with few
samples at few pixels, converted to .etd and to .json, saved once more from the .etd, and all four pictures must be the same.
"""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

from small_scenes import write_small_scenes

ENDINGS = "xml pbrt gltf glb obj ply stl off 3ds fbx dae lwo lws ase x blend usda usdc usdz".split()
# Of the validation data: what is neither large nor slow, at least one of each format.
CHOSEN = [
    "mitsuba/tests/scenes/bsdf_spheres/test_textured_diffuse_path.xml",
    "mitsuba/tests/scenes/instancing/test_instancing_path.xml",
    "mitsuba/tests/scenes/mesh_attributes/test_mesh_attributes_3_vertex_direct.xml",
    "mitsuba/tests/scenes/participating_media/test_hetero_sigmat_volpath.xml",
    "mitsuba/tests/scenes/spot_light/test_spot_direct.xml",
    "bitterli/pbrt-classic/veach-mis",
    "bitterli/cornell-box/scene.xml",
    "import/gltf",
    "import/glb",
    "import/obj",
]


def files_of(data, everything):
    """The files of the validation data that are tried."""
    for chosen in ["mitsuba", "bitterli", "mesh", "import"] if everything else CHOSEN:
        path = data / chosen
        if path.is_file():
            yield path
        for file in sorted(path.rglob("*")) if path.is_dir() else []:
            if file.suffix[1:].lower() in ENDINGS and "broken" not in file.parts and "include" not in file.parts:
                yield file


class Program:
    def __init__(self, path, data):
        self.path, self.data = path, data

    def run(self, *words):
        result = subprocess.run([self.path, *map(str, words)], capture_output=True, text=True, timeout=600)
        return result.returncode == 0, result.stderr

    def picture(self, file, folder, name):
        """The bytes of a picture of few samples; or what is wrong."""
        out = Path(folder) / f"{name}.npy"
        good, told = self.run("render", file, "--allow-path", self.data, "--quiet", "--size", "20x15", "--samples", 2, "--seed", 7,
                              "--set", "image.crop=[]", "--set", f'outputs=[NpyOutput {{ file: "{out}" }}]')
        return (out.read_bytes(), "") if good else (None, told)


def compare(program, file, folder):
    """Whether all pictures are the same, and words about it."""
    original, told = program.picture(file, folder, "original")
    if original is None:
        return None, "cannot be rendered: " + next((line for line in told.splitlines() if "warning: " not in line), told)
    for name, command, source in (("converted.etd", "convert", file), ("converted.json", "convert", file),
                                  ("saved.etd", "save", Path(folder) / "converted.etd")):
        target = Path(folder) / name
        allowed = ["--allow-path", program.data]
        good, told = program.run(command, source, *allowed, "-o", target)
        if not good:
            return False, f"{name} cannot be written: {told.strip()}"
        picture, told = program.picture(target, folder, name)
        if picture is None:
            return False, f"{name} cannot be rendered: {told.strip()}"
        if picture != original:
            return False, f"{name} makes another picture"
    return True, ""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--data", help="the folder of validation data, if there is one")
    parser.add_argument("--all", action="store_true", help="all scenes and models of the validation data")
    parser.add_argument("--only", default="", help="files whose name holds this")
    options = parser.parse_args()
    data = Path(options.data or ".").resolve()
    program = Program(str(Path(options.program).resolve()), data)
    same = different = untried = 0
    with tempfile.TemporaryDirectory() as written:
        for file in [*write_small_scenes(Path(written)), *(files_of(data, options.all) if options.data else [])]:
            if options.only not in str(file):
                continue
            with tempfile.TemporaryDirectory() as folder:
                equal, words = compare(program, file, folder)
            small = file.is_relative_to(written)
            if equal is None and not small:
                untried += 1
            elif equal:
                same += 1
            else:
                different += 1
            if not equal:
                print(f"{file}: {words}", flush=True)
    print(f"{same} make the same pictures, {different} do not, {untried} cannot be rendered")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
