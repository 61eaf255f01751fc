"""A render that is watched and edited over connections: what is seen, and what comes of it."""

import array
import math
import pathlib
import struct
import subprocess
import tempfile
import time
import unittest

from client import PROGRAM, Studio

SCENE = """# A small room, é.
white = Lambertian { color: 0.7 }   # a wall
Job {
    renderer: PathTracer { samples: 64 }   # few
    camera: PerspectiveCamera { from: [0, 1, -5], to: [0, 0.5, 0] }
    image: ImageBuffer { width: 100, height: 70, filter: BoxFilter {} }
    outputs: [ NpyOutput {} ]
    scene: BvhScene { objects: [
        Sphere { radius: 1 m, shader: Lambertian { color: 0.5 } }
        Rectangle { corner: [-3, -1, -3], edge_u: [6, 0, 0], edge_v: [0, 0, 6], shader: white }   # floor
        Rectangle { corner: [-1, 3, -1], edge_u: [2, 0, 0], edge_v: [0, 0, 2], emission: DiffuseEmission { radiance: 3 } }
    ] }
}
"""


def half(bits):
    return struct.unpack("<e", struct.pack("<H", bits))[0]


def picture(messages):
    """Pixels (x, y) of the newest picture, put together from its tiles."""
    last = messages[-1]
    tiles = {}
    for m in messages:
        if (m.width, m.height, m.scale) == (last.width, last.height, last.scale):
            tiles.update(m.tiles)
    pixels = {}
    for (column, row), data in tiles.items():
        values = array.array("H", data)
        width = min(64, last.width - 64 * column)
        for i in range(len(values) // 3):
            pixels[64 * column + i % width, 64 * row + i // width] = [half(v) * last.scale for v in values[3 * i : 3 * i + 3]]
    return pixels


class Rendering(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.file = pathlib.Path(self.folder.name) / "scene.etd"
        self.file.write_text(SCENE, encoding="utf-8")
        self.studio = Studio(self.file, folder=self.folder.name, environment={"ETENDUE_OIDN": "/nowhere/lib.so"})
        self.addCleanup(self.studio.__exit__)

    def finished(self, page):
        generation = page.ask("hello", protocol=1)["progress"]["generation"]
        return page.wait(
            lambda e: e.get("event") == "progress" and e["state"] == "finished" and e["generation"] >= generation and e["samples"] == 64
        )

    def test_film_is_the_picture(self):
        with self.studio.page() as page:
            page.good("watch")
            self.finished(page)
            page.drain(1)
            self.assertTrue(page.pixels[-1].flags & 2)
            pixels = picture(page.pixels)
            self.assertEqual(len(pixels), 100 * 70)
            for x, y in ((3, 5), (50, 35), (64, 64), (99, 69), (70, 20)):
                probe = page.good("probe", x=x, y=y)
                self.assertEqual(probe["samples"], 64)
                for ours, true in zip(pixels[x, y], probe["rgb"]):
                    self.assertLess(abs(ours - true), 1e-3 * abs(true) + 1e-6 * page.pixels[-1].scale)

    def test_picture_after_edits_and_reconnects_is_that_of_a_fresh_render(self):
        for round in range(4):
            with self.studio.page() as page:
                page.good("watch")
                tree = page.greeting["tree"]
                ids = {c["class"]: int(i) for i, c in tree["components"].items()}
                page.good("edit", component=ids["Sphere"], member="radius", text=f"{80 + round} cm", merge="slide")
                page.good("edit", component=ids["PerspectiveCamera"], member="fov", text=f"{40 + round} deg")
                page.good("orbit", x=0.1, y=0.02)
                page.drain(0.1)
                self.assertIn(1, [m.flags & 1 for m in page.pixels], "a moving camera is shown at once, if coarse")
                self.assertLessEqual(max(m.samples for m in page.pixels if m.flags & 1), 4, "by a few paths")
                page.good("orbit", x=0.1, y=0.02, final=True)
                if round == 2:
                    page.good("undo", count=2)
                if round == 1:
                    page.good("duplicate", component=ids["BvhScene"], member="objects", index=0)
            # The connection is lost here, in the middle of rendering.
        with self.studio.page() as page:
            self.finished(page)
            page.good("save")
            page.good("save_picture", file="studio.npy")
            text = page.greeting["text"]["text"]
        self.assertEqual(text, self.file.read_text(encoding="utf-8"))
        for comment in ("# A small room, é.", "# a wall", "# few", "# floor"):
            self.assertIn(comment, text)
        subprocess.run([PROGRAM, "render", str(self.file), "-o", f"{self.folder.name}/fresh.npy", "--quiet"], check=True)
        fresh = pathlib.Path(self.folder.name, "fresh.npy").read_bytes()
        self.assertEqual(pathlib.Path(self.folder.name, "studio.npy").read_bytes(), fresh)

    def test_two_pages_see_one_document(self):
        with self.studio.page() as one, self.studio.page() as two:
            ball = next(int(i) for i, c in one.greeting["tree"]["components"].items() if c["class"] == "Sphere")
            revision = one.good("edit", component=ball, member="radius", text="30 cm")["revision"]
            change = two.wait(lambda e: e.get("event") == "text" and e["revision"] == revision)
            (edit,) = change["changes"]
            text = two.greeting["text"]["text"]
            self.assertEqual(text[: edit["begin"]] + edit["insert"] + text[edit["end"] :], SCENE.replace("radius: 1 m", "radius: 30 cm"))
            self.assertEqual(change["by"], one.greeting["browser"])
            update = two.wait(lambda e: e.get("event") == "tree")["update"][str(ball)]
            self.assertEqual(update["members"]["radius"]["text"], "30 cm")
            self.assertTrue(math.isclose(update["members"]["radius"]["value"], 0.3))
            two.good("undo")
            self.assertEqual(one.ask("hello", protocol=1)["text"]["text"], SCENE)

    def test_drafts(self):
        with self.studio.page() as page:
            wrong = SCENE.replace("Sphere", "Spere")
            reply = page.good("text", revision=1, text=wrong)
            self.assertFalse(reply["valid"])
            error = reply["errors"][0]
            self.assertIn("did you mean 'Sphere'", error["message"])
            self.assertEqual(wrong[error["begin"] : error["end"]], "Spere")
            self.assertEqual(page.ask("undo")["errors"][0]["code"], "draft")
            self.assertEqual(page.ask("save")["errors"][0]["code"], "draft")
            self.assertEqual(page.ask("hello", protocol=1)["text"]["draft"]["text"], wrong, "it waits for whoever comes next")
            at = SCENE.index("64 }")
            reply = page.good("text", revision=1, changes=[{"begin": at, "end": at + 2, "insert": "32"}, {"begin": 2, "end": 3, "insert": "É"}])
            self.assertTrue(reply["valid"])
            self.assertTrue(page.ask("hello", protocol=1)["text"]["text"].startswith("# É small"))

    def test_files_are_not_overwritten_in_silence(self):
        with self.studio.page() as page:
            ids = {c["class"]: int(i) for i, c in page.greeting["tree"]["components"].items()}
            page.good("edit", component=ids["Sphere"], member="radius", text="0.5")
            self.file.write_text("# somebody else's\n", encoding="utf-8")
            self.assertEqual(page.ask("save")["errors"][0]["code"], "changed_on_disk")
            self.assertEqual(self.file.read_text(encoding="utf-8"), "# somebody else's\n")
            self.assertEqual(page.ask("save", file="scene.etd")["errors"][0]["code"], "changed_on_disk")
            page.good("save", over=True)
            self.assertIn("radius: 0.5", self.file.read_text(encoding="utf-8"))
            pathlib.Path(self.folder.name, "there.etd").write_text("", encoding="utf-8")
            self.assertEqual(page.ask("save", file="there.etd")["errors"][0]["code"], "changed_on_disk")

    def test_what_is_not_saved_is_kept_aside(self):
        with self.studio.page() as page:
            ball = next(int(i) for i, c in page.greeting["tree"]["components"].items() if c["class"] == "Sphere")
            page.good("edit", component=ball, member="radius", text="30 cm")
            self.assertEqual(page.ask("shutdown")["errors"][0]["code"], "busy")
        self.studio.process.terminate()
        self.assertEqual(self.studio.process.wait(20), 0)
        self.assertIn("scene.unsaved.etd", self.studio.process.stderr.read())
        self.assertIn("radius: 30 cm", pathlib.Path(self.folder.name, "scene.unsaved.etd").read_text(encoding="utf-8"))
        self.assertEqual(self.file.read_text(encoding="utf-8"), SCENE)

    def test_control(self):
        with self.studio.page() as page:
            page.good("goals", samples=100000)
            page.good("pause")
            page.wait(lambda e: e.get("event") == "progress" and e["state"] == "paused")
            page.good("start")
            page.good("stop")
            page.good("crop", area=[10, 20, 40, 50])
            page.good("watch")
            page.good("start")
            page.drain(1.5)
            last = page.pixels[-1]
            self.assertEqual((last.x0, last.y0, last.width, last.height, last.full_width, last.full_height), (10, 20, 30, 30, 100, 70))
            page.good("crop", area=None)
            page.good("goals", samples=None)
            self.finished(page)
            self.assertFalse(page.ask("crop", area=[10, 20, 5, 5])["ok"])
            self.assertFalse(page.ask("goals", samples=0.5)["ok"])
            page.good("restart", seed=7)
            self.finished(page)
            picked = page.good("pick", x=50, y=30)
            ball = next(int(i) for i, c in page.greeting["tree"]["components"].items() if c["class"] == "Sphere")
            self.assertEqual(picked["component"], ball)
            replay = page.good("replay", x=50, y=30, paths=3)["replay"]
            self.assertEqual(len(replay["paths"]), 3)
            self.assertGreater(len(page.good("wireframe")["lines"]), 6)
            page.good("watch", what="toned")
            page.drain(1)
            self.assertEqual(page.pixels[-1].kind, 2)

    def test_queue(self):
        with self.studio.page() as page:
            page.good("pause")
            other = pathlib.Path(self.folder.name, "other.etd")
            other.write_text(SCENE.replace("samples: 64", "samples: 1"), encoding="utf-8")
            page.good("queue", add=["other.etd"], start=True)
            done = page.wait(lambda e: e.get("event") == "queue" and e["entries"] and e["entries"][0]["state"] in ("done", "failed"))
            self.assertEqual(done["entries"][0]["errors"], [])
            subprocess.run([PROGRAM, "render", str(other), "-o", f"{self.folder.name}/fresh.npy", "--quiet"], check=True)
            self.assertEqual(
                pathlib.Path(self.folder.name, "other.npy").read_bytes(), pathlib.Path(self.folder.name, "fresh.npy").read_bytes()
            )

    def test_queue_loses_nothing_to_what_goes_wrong(self):
        folder = pathlib.Path(self.folder.name)

        def write(name, outputs):
            text = SCENE.replace("samples: 64", "samples: 1").replace("NpyOutput {}", outputs)
            (folder / name).write_text(text, encoding="utf-8")

        write("one.etd", 'PngOutput { file: "one.etd/below_a_file.png" }, NpyOutput {}')
        write("two.etd", "DenoisedOutput { output: NpyOutput {} }")
        with self.studio.page() as page:
            page.good("pause")
            page.good("queue", add=["one.etd", "two.etd"], start=True)
            done = page.wait(lambda e: e.get("event") == "queue" and [x["state"] for x in e["entries"]] == ["failed", "failed"])
        one, two = done["entries"]
        self.assertEqual([pathlib.Path(f).name for f in one["outputs"]], ["one.npy"])
        self.assertIn("below_a_file.png", one["errors"][0]["message"])
        self.assertEqual((two["outputs"], len(two["errors"])), ([], 1))
        self.assertIn("/nowhere/lib.so", two["errors"][0]["message"])
        self.assertTrue((folder / "one.npy").exists())
        self.assertFalse((folder / "two.npy").exists(), "nothing is rendered that could not be denoised")


if __name__ == "__main__":
    unittest.main()
