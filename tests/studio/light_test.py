"""Light that is kept apart, and light in space: groups of luminaires, photons, what a guide has learned, by raw sockets."""

import array
import math
import pathlib
import tempfile
import unittest

from client import Studio
from render_test import picture

SCENE = """# A small room with two lamps.
white = Lambertian { color: 0.7 }
key = Rectangle { corner: [-1, 3, -1], edge_u: [2, 0, 0], edge_v: [0, 0, 2], emission: DiffuseEmission { radiance: 3, sides: both } }
Job {
    renderer: PathTracer { samples: 64 }
    camera: PerspectiveCamera { from: [0, 1, -5], to: [0, 0.5, 0] }
    image: ImageBuffer { width: 100, height: 70, layers: ["light.key"] }
    outputs: [ NpyOutput {} ]
    scene: BvhScene { objects: [
        Sphere { radius: 1 m, shader: white }
        Rectangle { corner: [-3, -1, -3], edge_u: [6, 0, 0], edge_v: [0, 0, 6], shader: white }
        key
        Sphere { centre: [2, 0, 1], radius: 0.2 m, emission: DiffuseEmission { radiance: rgb(4, 1, 0.2) } }
    ] }
}
"""
PHOTONS = "PhotonMapper { samples: 16, photon_walks: 20000 }"
GUIDED = "GuidedPathTracer { samples: 128 }"
PIXELS = ((3, 65), (50, 35), (50, 60), (20, 55), (90, 62))


def doubles(path):
    """The numbers of a NumPy file of doubles: X Y Z of 100 x 70 pixels, row by row."""
    values = array.array("d")
    values.frombytes(path.read_bytes()[-100 * 70 * 3 * values.itemsize :])
    return values


class Light(unittest.TestCase):
    def begin(self, text):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        file = pathlib.Path(self.folder.name) / "scene.etd"
        file.write_text(text, encoding="utf-8")
        self.studio = Studio(file, folder=self.folder.name)
        self.addCleanup(self.studio.__exit__)
        return self.studio.page()

    def finished(self, page):
        generation = page.ask("hello", protocol=1)["progress"]["generation"]
        return page.wait(lambda e: e.get("event") == "progress" and e["state"] == "finished" and e["generation"] >= generation)

    def test_groups_are_watched_and_are_the_picture_together(self):
        with self.begin(SCENE) as page:
            for slot, layer in ((0, ""), (8, "light.key"), (9, "light.rest")):
                page.good("watch", slot=slot, layer=layer)
            self.assertEqual(self.finished(page)["layers"], ["light.key", "light.rest"])
            page.drain(1)
            of_slot = {s: picture([m for m in page.pixels if m.flags >> 8 & 255 == s]) for s in (0, 8, 9)}
            for at in PIXELS:
                whole, key, rest = (of_slot[s][at] for s in (0, 8, 9))
                self.assertGreater(max(key), 0)
                for a, b, c in zip(key, rest, whole):
                    self.assertLess(abs(a + b - c), 3e-3 * max(whole) + 1e-6)

    def test_a_picture_is_saved_with_its_lights_weighed(self):
        with self.begin(SCENE) as page:
            self.finished(page)
            page.good("save_picture", file="as_it_is.npy")
            page.good("save_picture", file="weighed.npy", lights={"key": [0.25, 0.25, 0.25], "rest": [3, 3, 3]})
            page.good("save_picture", file="one.npy", lights={"key": [0, 0, 0]})
            folder = pathlib.Path(self.folder.name)
            whole, weighed, rest = (doubles(folder / name) for name in ("as_it_is.npy", "weighed.npy", "one.npy"))
            for x, y in PIXELS:
                for c in range(3):
                    i = 3 * (100 * y + x) + c
                    self.assertTrue(math.isclose(weighed[i], 0.25 * (whole[i] - rest[i]) + 3 * rest[i], rel_tol=1e-4, abs_tol=1e-6))
                    self.assertGreater(whole[i], rest[i])
            for lights in ({"lamp": [1, 1, 1]}, {"key": [1, 1]}, {"key": [-1, 1, 1]}, {"key": "a"}, [1]):
                self.assertFalse(page.ask("save_picture", file="no.npy", lights=lights)["ok"], lights)
            self.assertFalse((folder / "no.npy").exists())

    def test_photons_lie_where_light_comes_to(self):
        with self.begin(SCENE.replace("PathTracer { samples: 64 }", PHOTONS)) as page:
            self.finished(page)
            said = page.good("photons", most=500)
            places = [said["positions"][i : i + 3] for i in range(0, len(said["positions"]), 3)]
            self.assertLessEqual(len(places), 500)
            self.assertGreater(len(places), 200)
            self.assertGreater(said["all"], 2000)
            for x, y, z in places:
                on_floor, on_ball = abs(y + 1) < 1e-3, abs(math.hypot(x, y, z) - 1) < 1e-3
                self.assertTrue(on_floor or on_ball, (x, y, z))
            ways = [said["directions"][i : i + 3] for i in range(0, len(said["directions"]), 3)]
            for way, place, segments in zip(ways, places, said["segments"]):
                self.assertAlmostEqual(math.hypot(*way), 1, places=4)
                if segments == 1 and abs(place[1] + 1) < 1e-3:
                    self.assertLess(way[1], 0, "light falls onto the floor")
            self.assertGreater(min(said["powers"]), -1e-3 * max(said["powers"]))
            self.assertFalse(page.ask("photons", most=20001)["ok"])
            self.assertIn("keeps no guide", page.ask("lobes", x=50, y=60)["errors"][0]["message"])

    def test_a_guide_is_a_density_and_looks_to_the_light(self):
        with self.begin(SCENE.replace("PathTracer { samples: 64 }", GUIDED)) as page:
            self.finished(page)
            said = page.good("lobes", x=50, y=66)
            self.assertAlmostEqual(said["position"][1], -1, places=3)
            self.assertAlmostEqual(said["normal"][1], 1, places=4)
            self.assertGreater(said["share"], 0)
            density, rows, columns = said["density"], said["rows"], said["columns"]
            self.assertEqual(len(density), rows * columns)
            self.assertAlmostEqual(4 * math.pi * sum(density) / len(density), 1, delta=0.1)
            row, column = divmod(max(range(len(density)), key=density.__getitem__), columns)
            z = 1 - (2 * row + 1) / rows
            up = math.sqrt(1 - z * z) * math.sin(2 * math.pi * (column + 0.5) / columns)
            self.assertGreater(up, 0.2, "the lamps are above")
            self.assertIn("keeps no photons", page.ask("photons")["errors"][0]["message"])
            self.assertFalse(page.ask("lobes", x=0, y=0)["ok"], "nothing is seen there")

    def test_a_renderer_without_either_says_so(self):
        with self.begin(SCENE) as page:
            self.assertIn("PathTracer keeps no photons", page.ask("photons")["errors"][0]["message"])
            self.assertIn("PathTracer keeps no guide", page.ask("lobes", x=50, y=60)["errors"][0]["message"])

    def test_fireflies_tell_why_no_path_can_be_shown(self):
        text = SCENE.replace(', layers: ["light.key"]', "")
        for renderer, refused in (("PrimarySampleMetropolis { samples: 16 }", "none can be replayed"), ("PathTracer { samples: 16 }", None)):
            with self.begin(text.replace("PathTracer { samples: 64 }", renderer)) as page:
                page.good("fireflies", count=5)
                page.good("restart")
                self.finished(page)
                said = page.good("fireflies", count=5)
                self.assertEqual(len(said["samples"]), 5)
                if refused:
                    self.assertIn(refused, said["refused"])
                else:
                    self.assertIsNone(said["refused"])


if __name__ == "__main__":
    unittest.main()
