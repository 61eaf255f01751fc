#!/usr/bin/env python3
"""The spectrum of a picture, read from the bytes of its OpenEXR file by this script alone.

Renders a scene with a spectral film and checks against the published layout (Fichet, Pacanowski & Wilkie 2021) the names of the
channels and the attributes, then that the bands, weighted with the CIE observer, add up to the picture's X, Y, Z, that NumPy's
files hold the same numbers, and that `etendue image spectrum` prints them. Needs NumPy; exits with 77 without it.

    spectral_exr.py --program build/etendue
"""

import argparse
import json
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import zlib

try:
    import numpy as np
except ImportError:
    sys.exit(77)

ROOT = pathlib.Path(__file__).resolve().parents[2]
# The expression of the published reader (spectral-exr, EXRSpectralImage.cpp).
CHANNEL = re.compile(r"^((S([0-3]))|T)\.(\d*,?\d*([Ee][+-]?\d+)?)(Y|Z|E|P|T|G|M|k|h|da|d|c|m|u|n|p)?(m|Hz)$")


def text_at(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def read_exr(path):
    """The attributes and the channels of a file with scan lines and zip compression (OpenEXR File Layout)."""
    data = path.read_bytes()
    assert data[:4] == b"\x76\x2f\x31\x01", "no OpenEXR file"
    at, attributes = 8, {}
    while data[at]:
        name, at = text_at(data, at)
        kind, at = text_at(data, at)
        size = struct.unpack_from("<i", data, at)[0]
        attributes[name] = (kind, data[at + 4 : at + 4 + size])
        at += 4 + size
    at += 1
    names, listed = [], attributes["channels"][1]
    place = 0
    while listed[place]:
        name, place = text_at(listed, place)
        kind, _, x, y = struct.unpack_from("<iiii", listed, place)
        assert (kind, x, y) == (2, 1, 1), "single precision, not subsampled"
        names.append(name)
        place += 16
    x0, y0, x1, y1 = struct.unpack("<iiii", attributes["dataWindow"][1])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    assert attributes["compression"][1] == b"\3", "zip in blocks of 16 lines"
    pixels = np.zeros((len(names), height, width), np.float32)
    for offset in struct.unpack_from(f"<{(height + 15) // 16}Q", data, at):
        line, size = struct.unpack_from("<ii", data, offset)
        rows = min(16, height - (line - y0))
        block = data[offset + 8 : offset + 8 + size]
        if size < rows * width * len(names) * 4:
            # Differences of neighbouring bytes, after the bytes at even and odd places were separated.
            packed = np.frombuffer(zlib.decompress(block), np.uint8).astype(np.int64)
            packed[1:] -= 128
            packed = (np.cumsum(packed) & 255).astype(np.uint8)
            whole = np.empty_like(packed)
            half = (len(packed) + 1) // 2
            whole[0::2], whole[1::2] = packed[:half], packed[half:]
            block = whole.tobytes()
        values = np.frombuffer(block, "<f4").reshape(rows, len(names), width)
        pixels[:, line - y0 : line - y0 + rows] = values.transpose(1, 0, 2)
    return attributes, dict(zip(names, pixels.astype(np.float64)))


def observer():
    """The CIE 1931 observer from 360 to 830 nm, in steps of 1 nm, from the tables of the sources."""
    text = (ROOT / "src/color/tables_observer.cpp").read_text()
    rows = re.findall(r"\{([-\d.e]+), ([-\d.e]+), ([-\d.e]+)\}", text)
    table = np.array(rows, dtype=np.float64)
    assert table.shape == (471, 3)
    return table


def layout(channels):
    """The wavelengths and the values of all bands, as the published reader finds them."""
    found = []
    for name, values in channels.items():
        match = CHANNEL.match(name)
        if match and match[3] == "0":
            assert (match[6], match[7]) == ("n", "m")
            found.append((float(match[4].replace(",", ".")), values))
    found.sort(key=lambda band: band[0])
    return np.array([w for w, _ in found]), np.stack([v for _, v in found], axis=-1)


def check(program, renderer, folder):
    exr, npy, colours = folder / "a.exr", folder / "spectrum.npy", folder / "xyz.npy"
    scene = folder / "scene.etd"
    scene.write_text(
        f"""
Job {{
    renderer: {renderer}
    camera: PerspectiveCamera {{ from: [0, 0.5, -4] m, to: [0, 0, 0] m, fov: 40 deg }}
    image: SpectralFilm {{ width: 20, height: 18, bands: 470 }}
    scene: BruteForceScene {{ objects: [
        Sphere {{ radius: 1 m, shader: Lambertian {{ color: rgb(0.8, 0.3, 0.1) }} }}
        Rectangle {{ corner: [-3, -1, -3] m, edge_u: [0, 0, 6] m, edge_v: [6, 0, 0] m, shader: Lambertian {{ color: rgb(0.2, 0.6, 0.3) }} }}
        Sphere {{ centre: [2, 3, -2] m, radius: 0.7 m, emission: DiffuseEmission {{ radiance: illuminant("D65") }} }}
    ] }}
    outputs: [
        ExrOutput {{ file: "a.exr" }}
        NpyOutput {{ file: "spectrum.npy", spectrum: true }}
        NpyOutput {{ file: "xyz.npy" }}
    ]
}}
"""
    )
    subprocess.run([program, "render", str(scene), "--quiet"], check=True)
    attributes, channels = read_exr(exr)
    assert attributes["spectralLayoutVersion"] == ("string", b"1.0")
    assert attributes["emissiveUnits"] == ("string", b"W.m^-2.sr^-1")
    assert {"R", "G", "B"} <= set(channels)
    wavelengths, spectrum = layout(channels)
    assert np.array_equal(wavelengths, np.arange(360.5, 830)), wavelengths

    edges, stored, xyz = np.load(folder / "spectrum.edges.npy"), np.load(npy), np.load(colours)
    assert np.array_equal(edges, np.arange(360, 831))
    assert np.array_equal(stored.astype(np.float32), spectrum.astype(np.float32))

    curves = observer()
    weights = (curves[1:] + curves[:-1]) / 2 / curves[:, 1].sum()
    error = np.abs((spectrum @ weights).mean((0, 1)) / xyz.mean((0, 1)) - 1).max()
    print(f"{renderer}: the bands' X, Y, Z of the whole picture deviate by {error:.1e}")
    assert error < 1e-4

    shown = json.loads(subprocess.run([program, "image", "spectrum", str(exr), "--area", "3,4,9,8", "--json"], check=True,
                                      capture_output=True, text=True).stdout)
    assert np.array_equal(shown["wavelengths"], wavelengths) and np.array_equal(shown["edges"], edges)
    assert np.allclose(shown["values"], spectrum[4:8, 3:9].mean((0, 1)), rtol=1e-12, atol=0)
    for wrong in (["--pixel", "20,3"], ["--pixel", "1"], ["--area", "3,3,3,4"]):
        refused = subprocess.run([program, "image", "spectrum", str(exr), *wrong], capture_output=True)
        assert refused.returncode == 2, wrong


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", required=True)
    program = str(pathlib.Path(parser.parse_args().program).resolve())
    with tempfile.TemporaryDirectory() as folder:
        for renderer in ("PathTracer { samples: 512 }", "LightTracer { samples: 512 }"):
            check(program, renderer, pathlib.Path(folder))


main()
