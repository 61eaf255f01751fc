"""Pictures in files, shown by the studio's viewer: `etendue view`."""

import pathlib
import struct
import subprocess
import tempfile
import unittest
import zlib

from client import PROGRAM, Studio


def npy(values, height, width):
    """An array of floats, as NumPy writes it (format 1.0)."""
    head = f"{{'descr': '<f4', 'fortran_order': False, 'shape': ({height}, {width}, 3), }}"
    head += " " * (-(len(head) + 11) % 64) + "\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head.encode() + struct.pack(f"<{len(values)}f", *values)


def png(rows):
    """8 bit RGB (W3C recommendation Portable Network Graphics, second edition)."""

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    raw = b"".join(b"\0" + bytes(row) for row in rows)
    head = struct.pack(">IIBBBBB", len(rows[0]) // 3, len(rows), 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b"")


class Viewing(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)

    def test_pictures_of_all_kinds(self):
        width, height = 70, 3  # two tiles
        values = [0.25 * (i % 7) + 0.001 * i for i in range(3 * width * height)]
        (self.path / "a.npy").write_bytes(npy(values, height, width))
        (self.path / "b.png").write_bytes(png([[255, 0, 0, 128, 128, 128], [0, 0, 0, 255, 255, 255]]))
        (self.path / "s.etd").write_text(
            "Job { renderer: PathTracer { samples: 1 }, camera: PerspectiveCamera {}, image: ImageBuffer { width: 8, height: 6 }, "
            "scene: BvhScene { objects: [ Environment { emission: EnvironmentEmission { radiance: 2 } } ] } }",
            encoding="utf-8",
        )
        subprocess.run(
            [PROGRAM, "render", "s.etd", "--checkpoint", "c.state", "-o", "c.exr", "--quiet"], cwd=self.path, check=True, capture_output=True
        )
        with Studio("a.npy", "b.png", "c.state", "c.exr", folder=self.path, command="view", threads=0) as studio, studio.page() as page:
            self.assertTrue(page.greeting["viewing"] and page.greeting["read_only"])
            sizes = {p["name"]: (p["width"], p["height"]) for p in page.greeting["pictures"]}
            self.assertEqual(sizes, {"a.npy": (width, height), "b.png": (2, 2), "c.state": (8, 6), "c.exr": (8, 6)})

            page.good("watch", layer="pin:a.npy")
            page.drain(1)
            last = page.pixels[-1]
            self.assertEqual((last.width, last.height, last.full_width, last.full_height), (width, height, width, height))
            probe = page.good("picture_probe", picture="a.npy", x=65, y=2)
            for ours, true in zip(probe["xyz"], values[3 * (2 * width + 65) :]):
                self.assertAlmostEqual(ours, true, places=5)
            shown = struct.unpack_from("<3e", last.tiles[1, 0], 6 * (2 * 6 + 1))
            for ours, true in zip(shown, probe["rgb"]):
                self.assertAlmostEqual(ours * last.scale, true, delta=2e-3 * abs(true) + 1e-6)

            # An 8 bit grey of 128 is 0.2158605 of linear light (IEC 61966-2-1).
            for value in page.good("picture_probe", picture="b.png", x=1, y=0)["rgb"]:
                self.assertAlmostEqual(value, 0.2158605, places=4)
            page.good("watch", what="toned", layer="pin:b.png")
            page.drain(1)
            self.assertEqual((page.pixels[-1].kind, page.pixels[-1].width), (2, 2))
            # The picture of a checkpoint is that of the file.
            self.assertAlmostEqual(
                page.good("picture_probe", picture="c.state", x=3, y=3)["xyz"][1], page.good("picture_probe", picture="c.exr", x=3, y=3)["xyz"][1], places=3
            )
            for refused in ({"do": "edit", "component": 1, "member": "seed", "text": "2"}, {"do": "save", "file": "x.etd"}):
                self.assertEqual(page.ask(**refused)["errors"][0]["code"], "read_only")
            self.assertFalse(page.ask("picture_probe", picture="a.npy", x=width, y=0)["ok"])
            self.assertFalse(page.ask("picture_probe", picture="none", x=0, y=0)["ok"])

    def test_files_that_are_written_again(self):
        (self.path / "a.npy").write_bytes(npy([1.0] * 12, 2, 2))
        with Studio("a.npy", folder=self.path, command="view", threads=0) as studio, studio.page() as page:
            page.good("watch", layer="pin:a.npy")
            page.drain(1)
            before = page.good("picture_probe", picture="a.npy", x=0, y=0)["rgb"][1]
            frames = len(page.pixels)
            (self.path / "a.npy").write_bytes(b"half of a")  # it stays until the file is whole
            page.drain(2)
            self.assertEqual(page.good("picture_probe", picture="a.npy", x=0, y=0)["rgb"][1], before)
            (self.path / "b").write_bytes(npy([2.0] * 48, 4, 4))
            (self.path / "b").rename(self.path / "a.npy")
            page.drain(4)
            self.assertAlmostEqual(page.good("picture_probe", picture="a.npy", x=3, y=3)["rgb"][1], 2 * before, places=3)
            self.assertGreater(len(page.pixels), frames)
            self.assertEqual((page.pixels[-1].width, page.pixels[-1].height), (4, 4))

    def test_what_is_no_picture(self):
        (self.path / "text.exr").write_text("this is no picture", encoding="utf-8")
        done = subprocess.run([PROGRAM, "view", "--no-browser", "text.exr", "none.png"], cwd=self.path, capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 2)
        self.assertIn("text.exr", done.stderr)
        self.assertIn("none.png", done.stderr)


if __name__ == "__main__":
    unittest.main()
