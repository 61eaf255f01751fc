#!/usr/bin/env python3
"""Files of a sensor, by readers of other people.

    python3 raw_files.py --program build/etendue

Needs NumPy. A lamp's spectrum from dark to bright is exposed by a measured camera and written as numbers, TIFF and DNG. The digital numbers in the
files are compared with those of the .npy by a reader of plain TIFF here, and by rawpy (LibRaw), tifffile and dcraw where they are installed. LibRaw
then develops the linear DNG with the matrices and the white that it states: the colours must be those of `--white D65`.
"""
import argparse
import os
import shutil
import struct
import subprocess
import sys
import tempfile

try:
    import numpy as np
except ImportError as error:
    print("skipped: %s" % error)
    sys.exit(77)

WIDTH, HEIGHT = 48, 32
# A gradient of reflectances of several colours, so that no two pixels are alike and none is clipped.
SCENE = """Job {
    renderer: PathTracer { samples: 64 }
    camera: OrthographicCamera { from: [3, 2, 2] m, to: [3, 2, 0] m, width: 6 m }
    image: SpectralFilm { width: %d, height: %d, bands: 47, filter: BoxFilter {} }
    outputs: [ExrOutput { file: "picture.exr" }]
    scene: BruteForceScene { objects: [
        Environment { emission: EnvironmentEmission { radiance: illuminant("D65") } }
%s
    ] } }
"""


def scene():
    patches = []
    for y in range(4):
        for x in range(6):
            r, g, b = [0.08 + 0.75 * v for v in ((x / 5), (y / 3), ((x + y) % 4 / 3))]
            patches.append("        Rectangle { corner: [%d, %d, 0] m, edge_u: [1, 0, 0] m, edge_v: [0, 1, 0] m, shader: Lambertian { color: rgb(%g, %g, %g) } }"
                           % (x, y, r, g, b))
    return SCENE % (WIDTH, HEIGHT, "\n".join(patches))


def plain_tiff(path):
    """{tag: values} of the first directory and of the Exif directory, and the samples."""
    data = open(path, "rb").read()
    assert data[:4] == b"II*\0", data[:4]

    def directory(at):
        fields = {}
        (count,) = struct.unpack_from("<H", data, at)
        tags = []
        for i in range(count):
            tag, kind, number = struct.unpack_from("<HHI", data, at + 2 + 12 * i)
            letter = {1: "B", 2: "s", 3: "H", 4: "I", 5: "II", 10: "ii"}[kind]
            size = number * struct.calcsize("<" + letter)
            where = at + 10 + 12 * i if size <= 4 else struct.unpack_from("<I", data, at + 10 + 12 * i)[0]
            assert where % 2 == 0 and where + size <= len(data), tag
            if kind == 2:
                fields[tag] = data[where:where + number].rstrip(b"\0").decode()
            else:
                values = struct.unpack_from("<" + letter * number, data, where)
                fields[tag] = [a / b for a, b in zip(values[::2], values[1::2])] if kind in (5, 10) else list(values)
            tags.append(tag)
        assert tags == sorted(tags), "tags must increase"
        assert struct.unpack_from("<I", data, at + 2 + 12 * count) == (0,)
        return fields

    fields = directory(struct.unpack_from("<I", data, 4)[0])
    exif = directory(fields[34665][0]) if 34665 in fields else {}
    shape = (fields[257][0], fields[256][0], fields[277][0])
    assert fields[258] == [16] * shape[2] and fields[259] == [1] and fields[279] == [2 * shape[0] * shape[1] * shape[2]]
    samples = np.frombuffer(data, "<u2", count=int(np.prod(shape)), offset=fields[273][0]).reshape(shape)
    return fields, exif, samples


def mosaic_of(raw, order):
    channel = ["RGB".index(c) for c in order]
    result = np.zeros(raw.shape[:2])
    for y in range(raw.shape[0]):
        for x in range(raw.shape[1]):
            result[y, x] = raw[y, x, channel[2 * (y % 2) + x % 2]]
    return result


def check_by_libraw(raw, photo):
    try:
        import rawpy
    except ImportError:
        print("without rawpy")
        return
    with rawpy.imread("raw.dng") as linear:
        assert np.array_equal(linear.raw_image_visible[..., :3], raw)
        assert linear.white_level == 16383 and linear.black_level_per_channel[:3] == [256] * 3, (linear.white_level, linear.black_level_per_channel)
        developed = linear.postprocess(gamma=(1, 1), no_auto_bright=True, output_bps=16, use_camera_wb=True, user_flip=0,
                                       output_color=rawpy.ColorSpace.sRGB, highlight_mode=rawpy.HighlightMode.Clip) / 65535
    # LibRaw divides linear raw by the white level without subtracting the black level from it, which the specification wants.
    scale = (developed * photo).sum() / (photo ** 2).sum()
    difference = np.abs(developed - scale * photo).max() / photo.max()
    print("LibRaw %s: developed colours differ by %.4f of the brightest, scale %.4f" % (rawpy.libraw_version, difference, scale))
    assert difference < 2e-3, difference
    assert min(abs(scale - 1), abs(scale - (16383 - 256) / 16383)) < 1e-3, scale
    for order in ("RGGB", "BGGR", "GRBG", "GBRG"):
        with rawpy.imread(order + ".dng") as mosaic:
            assert np.array_equal(mosaic.raw_image_visible, mosaic_of(raw, order)), order
            seen = "".join(mosaic.color_desc.decode()[i] for i in mosaic.raw_pattern.ravel())
            assert seen == order, (seen, order)
            # Demosaiced, far from the edges of patches.
            picture = mosaic.postprocess(gamma=(1, 1), no_auto_bright=True, output_bps=16, use_camera_wb=True, user_flip=0,
                                         output_color=rawpy.ColorSpace.sRGB) / 65535
            def middles(image):
                return image.reshape(HEIGHT // 8, 8, WIDTH // 8, 8, 3)[:, 2:6, :, 2:6].mean(axis=(1, 3))
            error = np.abs(middles(picture) - middles(photo)).max()
            print("    mosaic %s: differs by %.4f" % (order, error))
            assert error < 0.006, (order, error)


def check_by_others(raw, photo):
    try:
        import tifffile
    except ImportError:
        print("without tifffile and dcraw")
        return
    assert np.array_equal(tifffile.imread("raw.tif"), raw)
    assert np.array_equal(tifffile.imread("raw.dng"), raw)
    assert np.abs(tifffile.imread("photo.tif") / 65535 - np.clip(photo, 0, 1)).max() < 1e-5
    print("tifffile agrees")
    if not shutil.which("dcraw"):
        print("without dcraw")
        return
    subprocess.run(["dcraw", "-D", "-4", "-T", "RGGB.dng"], check=True)  # the numbers as they are
    assert np.array_equal(tifffile.imread("RGGB.tiff"), mosaic_of(raw, "RGGB"))
    about = subprocess.run(["dcraw", "-i", "-v", "RGGB.dng"], check=True, capture_output=True, text=True).stdout
    for words in ("ISO speed: 200", "Shutter: 1/4000.0 sec", "Aperture: f/8.0", "DNG Version: 1.4.0.0"):
        assert words in about, (words, about)
    print("dcraw agrees")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", required=True)
    program = os.path.abspath(parser.parse_args().program)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        open("scene.etd", "w").write(scene())
        subprocess.run([program, "render", "scene.etd", "--quiet"], check=True)

        def expose(*options):
            subprocess.run([program, "image", "sensor", "picture.exr", *options, "--camera", "Nikon D5100", "--iso", "200", "--shutter", "0.00025",
                            "--black-level", "256"], check=True, stdout=subprocess.DEVNULL)
        for name in ("raw.npy", "raw.tif", "raw.dng"):
            expose(name)
        for order in ("RGGB", "BGGR", "GRBG", "GBRG"):
            expose(order + ".dng", "--mosaic", order)
        expose("photo.tif", "--white", "D65")
        expose("photo.exr", "--white", "D65")
        expose("lamp.dng", "--white", "A")
        expose("small.png")
        expose("CAPITAL.PNG")
        assert open("small.png", "rb").read() == open("CAPITAL.PNG", "rb").read()
        for name, *options, told in (("picture.tga", "--output: "), ("volts.PNG", "--quantity", "volts", "--quantity: "),
                                     ("nothing.npy", "--f-number", "nan", "'nan' is not a number")):
            refused = subprocess.run([program, "image", "sensor", "picture.exr", name, *options, "--camera", "Nikon D5100"], capture_output=True, text=True)
            assert refused.returncode == 2 and told in refused.stderr and not os.path.exists(name), (name, refused)
        raw = np.load("raw.npy")
        assert raw.shape == (HEIGHT, WIDTH, 3) and 300 < raw.min() and raw.max() < 16383 and len(np.unique(raw)) > 30, (raw.min(), raw.max())

        assert np.array_equal(plain_tiff("raw.tif")[2], raw)
        fields, exif, samples = plain_tiff("raw.dng")
        assert np.array_equal(samples, raw)
        assert fields[262] == [34892] and fields[50717] == [16383] * 3 and fields[50714] == [256] * 3 and fields[272] == "Nikon D5100"
        assert "noise: none" in fields[270], fields[270]
        assert abs(exif[33434][0] - 0.00025) < 1e-9 and exif[33437] == [8] and exif[34855] == [200]
        for order in ("RGGB", "BGGR", "GRBG", "GBRG"):
            fields, _, samples = plain_tiff(order + ".dng")
            assert fields[262] == [32803] and fields[33422] == ["RGB".index(c) for c in order]
            assert np.array_equal(samples[..., 0], mosaic_of(raw, order))

        # What the specification says about the matrices: the colour matrix turns the illuminant's white into the channels of a perfect white, the
        # forward matrix balanced channels of 1 into D50.
        whites = {"raw.dng": (50722, [0.9505, 1, 1.0891]), "lamp.dng": (50721, [1.0985, 1, 0.3558])}
        for name, (tag, white) in whites.items():
            fields = plain_tiff(name)[0]
            neutral = np.array(fields[tag]).reshape(3, 3) @ white
            assert np.abs(neutral / neutral.max() - fields[50728]).max() < 1e-3, (name, neutral, fields[50728])
            for forward in (50964, 50965):
                assert np.abs(np.array(fields[forward]).reshape(3, 3).sum(axis=1) - [0.9642, 1, 0.8252]).max() < 1e-3, fields[forward]
        assert fields[50778] == [17] and fields[50779] == [21]

        photo = plain_tiff("photo.tif")[2] / 65535
        check_by_libraw(raw, photo)
        check_by_others(raw, photo)
    print("all agree")


if __name__ == "__main__":
    main()
