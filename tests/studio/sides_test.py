"""Renders beside the document's own: two algorithms on one scene, in turns, each the picture that a fresh render makes."""

import pathlib
import struct
import subprocess
import tempfile
import time
import unittest

from client import PROGRAM, Studio
from render_test import SCENE

BIDIRECTIONAL = "BidirectionalPathTracer"


class Sides(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.file = pathlib.Path(self.folder.name) / "scene.etd"
        self.file.write_text(SCENE, encoding="utf-8")
        self.studio = Studio(self.file, folder=self.folder.name)
        self.addCleanup(self.studio.__exit__)

    def fresh(self, text):
        """The bytes of a render of a text of its own."""
        file = pathlib.Path(self.folder.name, "fresh.etd")
        file.write_text(text, encoding="utf-8")
        subprocess.run([PROGRAM, "render", str(file), "-o", f"{self.folder.name}/fresh.npy", "--quiet"], check=True)
        return pathlib.Path(self.folder.name, "fresh.npy").read_bytes()

    def saved(self, page, number):
        page.good("save_picture", file="side.npy", render=number, over=True)
        return pathlib.Path(self.folder.name, "side.npy").read_bytes()

    def finished(self, page, number):
        """Waits until what is told of a render now says that it has come to its end."""
        end = time.monotonic() + 120
        while time.monotonic() < end:
            (now,) = (r for r in page.good("renders")["renders"] if r["render"] == number)
            if now["state"] == "finished" and now["samples"] == 64:
                return now
            self.assertEqual(now["errors"], [])
            page.drain(0.1)
        raise AssertionError(f"it did not end: {now}")

    def test_each_is_the_picture_of_a_fresh_render_and_follows_edits(self):
        with self.studio.page() as page:
            number = page.good("renders", add={"renderer": BIDIRECTIONAL})["render"]
            shallow = page.good("renders", add={"set": {"renderer.max_depth": "2"}})["render"]
            self.finished(page, number)
            bidirectional = SCENE.replace("PathTracer", BIDIRECTIONAL)
            self.assertEqual(self.saved(page, number), self.fresh(bidirectional))
            self.finished(page, shallow)
            self.assertEqual(self.saved(page, shallow), self.fresh(SCENE.replace("samples: 64", "samples: 64, max_depth: 2")))

            ball = next(int(i) for i, c in page.greeting["tree"]["components"].items() if c["class"] == "Sphere")
            page.good("edit", component=ball, member="radius", text="70 cm")
            page.good("orbit", x=0.1, y=0.02, final=True)
            self.finished(page, number)
            text = page.ask("hello", protocol=1)["text"]["text"]
            self.assertEqual(self.saved(page, number), self.fresh(text.replace("PathTracer", BIDIRECTIONAL)))
            self.assertIn("PathTracer", text)
            self.assertNotIn(BIDIRECTIONAL, text, "the document knows nothing of them")
            course = page.good("course", render=number)["points"]
            self.assertGreater(len(course), 0)
            self.assertTrue(all(error > 0 for _, error, _ in course))
            page.good("renders", remove=number)
            self.assertFalse(page.ask("probe", x=1, y=1, render=number)["ok"])

    def test_both_are_seen_at_once(self):
        with self.studio.page() as page:
            number = page.good("renders", add={"renderer": BIDIRECTIONAL})["render"]
            page.good("watch")
            page.good("watch", slot=1, render=number)
            self.finished(page, number)
            page.drain(1)
            last = {m.slot: m for m in page.pixels}
            self.assertEqual(sorted(last), [0, 1])
            for slot, render in ((0, 0), (1, number)):
                tiles = {}
                for m in page.pixels:
                    if m.slot == slot:
                        tiles.update(m.tiles)
                self.assertEqual(len(tiles), 4, "100 x 70 pixels are four tiles")
                # Another picture than that of the other slot: its own pixel.
                probe = page.good("probe", x=64, y=64, render=render)
                pixel = struct.unpack_from("<3e", tiles[1, 1], 0)
                for ours, true in zip(pixel, probe["rgb"]):
                    self.assertLess(abs(ours * last[slot].scale - true), 2e-3 * abs(true) + 1e-6)

    def test_they_take_turns(self):
        with self.studio.page() as page:
            page.good("goals", samples=1000000)
            number = page.good("renders", add={"renderer": BIDIRECTIONAL})["render"]
            page.good("restart")
            # A step is 64 samples of this picture: some of both, so that one step more or less does not matter.
            end = time.monotonic() + 90
            while time.monotonic() < end:
                page.drain(0.5)
                (side,) = page.good("renders")["renders"]
                own = page.ask("hello", protocol=1)["progress"]
                if side["samples"] >= 4 * 64 and own["samples"] >= 4 * 64:
                    break
            self.assertEqual((own["state"], side["state"]), ("rendering", "rendering"))
            # Each has about the half of the time; as they do not work at once, these times are whole.
            both = side["seconds"] + own["seconds"]
            self.assertGreater(side["seconds"], 0.25 * both)
            self.assertGreater(own["seconds"], 0.25 * both)
            page.good("pause", render=number)
            paused = page.good("renders")["renders"][0]
            end = time.monotonic() + 90
            while page.ask("hello", protocol=1)["progress"]["samples"] < own["samples"] + 4 * 64:
                self.assertLess(time.monotonic(), end)
                page.drain(0.2)
            later = page.good("renders")["renders"][0]
            self.assertEqual(later["state"], "paused")
            self.assertLessEqual(later["samples"], paused["samples"] + 64, "but for the step at hand it stood still")

    def test_what_does_not_go(self):
        with self.studio.page() as page:
            self.assertIn("did you mean 'PathTracer'", page.ask("renders", add={"renderer": "PathTraser"})["errors"][0]["message"])
            self.assertFalse(page.ask("renders", add={"set": {"renderer.max_dept": "3"}})["ok"])
            secret = page.ask("renders", add={"set": {"scene.objects[0].shader": 'Lambertian { color: spectrum("/etc/passwd") }'}})
            self.assertIn("outside", secret["errors"][0]["message"])
            self.assertFalse(page.ask("renders", add=[1])["ok"])
            self.assertFalse(page.ask("renders", remove=7)["ok"])
            self.assertFalse(page.ask("watch", slot=1, render=7)["ok"])
            self.assertFalse(page.ask("watch", slot=24)["ok"])
            page.good("pause")
            for _ in range(4):
                page.good("renders", add={})
            self.assertIn("remove one", page.ask("renders", add={})["errors"][0]["message"])
            self.assertEqual(len(page.ask("hello", protocol=1)["renders"]), 4)
            page.good("new", discard=True)
            self.assertEqual(page.ask("hello", protocol=1)["renders"], [], "they were of the other document")


if __name__ == "__main__":
    unittest.main()
