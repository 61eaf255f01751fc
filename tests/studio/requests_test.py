"""What pages ask beside editing and rendering: warnings, saved views, strategies apart, checks, a new beginning."""

import array
import base64
import pathlib
import struct
import subprocess
import tempfile
import time
import time
import unittest

from client import PROGRAM, Closed, Studio
from render_test import SCENE


def values_of(npy):
    """All numbers of an array of floats or doubles, and its shape."""
    (size,) = struct.unpack_from("<H", npy, 8)
    head = npy[10 : 10 + size].decode()
    kind = "f" if "<f4" in head else "d"
    shape = tuple(int(n) for n in head[head.index("(") + 1 : head.index(")")].split(",") if n.strip())
    return array.array(kind, npy[10 + size :]), shape


# A cube that is divided over and over: at nine levels it is prepared in seconds.
DIVIDED = """Job {
    renderer: PathTracer { samples: 1 }
    camera: PerspectiveCamera {}
    image: ImageBuffer { width: 8, height: 6 }
    scene: BvhScene { objects: [ SubdivisionSurface {
        positions: [[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]]
        indices: [0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7], levels: 9 } ] }
}
"""


class Requests(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.file = pathlib.Path(self.folder.name) / "scene.etd"

    def open(self, text=SCENE, *arguments):
        self.file.write_text(text, encoding="utf-8")
        studio = Studio(self.file, *arguments, folder=self.folder.name)
        self.addCleanup(studio.__exit__)
        return studio

    def test_a_shader_that_is_saved_is_followed(self):
        shader = pathlib.Path(self.folder.name) / "followed.osl"
        shader.write_text("surface followed(float k = 0.25) { Ci = k * diffuse(N); }")
        scene = 'plugin "followed.osl"\n' + SCENE.replace("Lambertian { color: 0.5 }", "Followed {}")
        with self.open(scene).page() as page:
            page.good("warnings")
            time.sleep(0.5)  # the file has been looked at
            shader.write_text("surface followed(float k = 0.25) { Ci = nothing(N); }")
            told = page.wait(lambda e: e.get("event") == "document" and e["errors"])
            self.assertIn("followed.osl:1:", told["errors"][0]["message"])
            self.assertEqual(told["errors"][0]["line"], 1)
            page.events.clear()
            shader.write_text("surface followed(float k = 0.25, float added = 1) { Ci = k * added * diffuse(N); }")
            page.wait(lambda e: e.get("event") == "tree" and "added" in str(e))
            page.wait(lambda e: e.get("event") == "document" and not e["errors"])
            # A page that is loaded anew knows the class as it is now.
            followed = next(c for c in page.good("hello", protocol=1)["classes"] if c["name"] == "Followed")
            self.assertEqual([m["name"] for m in followed["members"]], ["k", "added"])

    def test_warnings_and_advice(self):
        dark = SCENE.replace("emission: DiffuseEmission { radiance: 3 } ", "").replace("PathTracer", "LightTracer")
        with self.open(dark).page() as page:
            found = page.good("warnings")
            self.assertIn("nothing emits light", found["warnings"][0]["message"])
            at = found["warnings"][0]["begin"]
            self.assertTrue(dark[at:].startswith(("objects", "[")), dark[at : at + 20])
        mirrored = SCENE.replace("PathTracer", "LightTracer").replace("Sphere { radius: 1 m, shader: Lambertian { color: 0.5 } }", "Sphere { radius: 1 m, shader: PerfectSpecular {} }")
        with self.open(mirrored).page() as page:
            self.assertTrue(any("LightTracer cannot find" in line for line in page.good("warnings")["advice"]))
        with self.open().page() as page:
            self.assertEqual([w["message"] for w in page.good("warnings")["warnings"]], [])

    def test_what_takes_long_is_told(self):
        # The address is there before the scene is read, and so is whoever asks for it.
        with self.open(DIVIDED) as studio, studio.page(hello=False) as page:
            first = page.wait(lambda e: e.get("event") != "progress")
            self.assertEqual((first["event"], first["what"], first["file"]), ("working", "open", str(self.file)))
            self.assertGreaterEqual(first["seconds"], 0)
            tree = page.ask("hello", protocol=1)["tree"]["components"]
            told = [e["what"] for e in page.events if e["event"] == "working"]
            self.assertEqual(told, ["open", None], "it is over when the first request is answered")
            self.assertTrue(page.good("hello", protocol=1)["document"]["valid"])
            surface = next(int(i) for i, c in tree.items() if c["class"] == "SubdivisionSurface")
            # How long an edit takes is the machine's affair: one level more is four times the work.
            for levels, boundary in (("9", "edges"), ("10", "edges_and_corners")):
                page.good("edit", component=surface, member="levels", text=levels)
                page.events.clear()
                began = time.monotonic()
                page.good("edit", component=surface, member="boundary", text=boundary)
                seconds = time.monotonic() - began
                if seconds > 2:
                    break
            told = [(e["what"], e.get("file")) for e in page.events if e["event"] == "working"]
            self.assertEqual(told, [("edit", None), (None, None)])

    def test_it_ends_while_it_reads(self):
        studio = self.open(DIVIDED)
        studio.process.terminate()
        self.assertEqual(studio.process.wait(60), 0)
        self.assertEqual(studio.process.stderr.read(), "")
        self.assertEqual([p.name for p in self.file.parent.iterdir()], ["scene.etd"])

    def test_a_file_that_cannot_be_read_ends_it(self):
        done = subprocess.run([PROGRAM, "studio", "--no-browser", str(self.file)], capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("scene.etd", done.stderr)

    def test_views(self):
        studio = self.open()
        with studio.page() as page:
            page.good("stop")
            page.good("save_view", name="front")
            self.assertEqual(page.ask("save_view", name="front")["errors"][0]["code"], "busy")
            for name in ("white", "9", "a b", ""):
                self.assertFalse(page.ask("save_view", name=name)["ok"], name)
            page.good("orbit", x=0.5, y=0.1, final=True)
            page.good("save_view", name="side")
            moved = page.ask("hello", protocol=1)["text"]["text"]
            page.good("use_view", name="front")
            text = page.ask("hello", protocol=1)["text"]["text"]
            self.assertIn("camera: PerspectiveCamera { from: [0, 1, -5], to: [0, 0.5, 0] }", text)
            self.assertEqual([v["name"] for v in page.good("views")["views"]], ["front", "side"])
            page.good("undo")
            self.assertEqual(page.ask("hello", protocol=1)["text"]["text"], moved, "one step brings back where it was")
            page.good("save")
            # A view is no mistake: whoever renders the file is told nothing.
            done = subprocess.run(
                [PROGRAM, "render", str(self.file), "-o", f"{self.folder.name}/x.npy", "--quiet", "--samples", "1"], capture_output=True, text=True, check=True
            )
            self.assertEqual(done.stderr, "")
            page.good("orbit", x=0.1, final=True)
            page.good("save_view", name="side", over=True)
            before = page.ask("hello", protocol=1)["text"]["text"]
            page.good("save_view", name="third")
            page.good("remove_view", name="third")
            self.assertEqual(page.ask("hello", protocol=1)["text"]["text"], before, "its line is gone as it came")
            page.good("undo", count=2)
            page.good("remove_view", name="side")
            page.good("remove_view", name="front")
            page.good("undo", count=7)
            self.assertEqual(page.ask("hello", protocol=1)["text"]["text"], SCENE)
            self.assertFalse(page.ask("use_view", name="white")["ok"])

    def task(self, page, number):
        return page.wait(lambda e: e.get("event") == "task" and e["task"] == number and e["state"] != "running", 200)

    def test_strategies_add_up_to_the_picture(self):
        text = SCENE.replace("PathTracer { samples: 64 }", "BidirectionalPathTracer { samples: 4 }")
        with self.open(text).page() as page:
            done = self.task(page, page.good("strategies", samples=4, width=30)["task"])
            self.assertEqual(done["state"], "done", done["text"])
            self.assertEqual((done["width"], done["height"]), (30, 21))
            names = {(s["strategy"], s["length"]) for s in done["strategies"]}
            self.assertIn(("0 from the luminaire, 3 from the camera", 2), names)
            self.assertIn(("1 from the luminaire, 2 from the camera", 2), names)
            self.assertGreater(len({n for n, _ in names}), 6)
            subprocess.run(
                [PROGRAM, "render", str(self.file), "--size", "30x21", "-o", f"{self.folder.name}/x.npy", "--quiet"], check=True
            )
            numbers, shape = values_of(pathlib.Path(self.folder.name, "x.npy").read_bytes())
            true = sum(numbers[1 :: shape[2]]) / (shape[0] * shape[1])
            self.assertAlmostEqual(sum(s["mean"] for s in done["strategies"]) / true, 1, delta=1e-4)
            # A picture is as large as it says, and its light is that of its mean.
            one = max(done["strategies"], key=lambda s: s["mean"])
            halfs = struct.unpack(f"<{3 * 30 * 21}e", base64.b64decode(one["weighted"]["halfs"]))
            y = sum(0.2126 * r + 0.7152 * g + 0.0722 * b for r, g, b in zip(halfs[::3], halfs[1::3], halfs[2::3]))
            self.assertAlmostEqual(y * one["weighted"]["scale"] / (30 * 21) / one["mean"], 1, delta=5e-3)

    def test_the_spectrum_of_a_pixel_has_its_error(self):
        """A lamp of radiance 2 at all wavelengths: bands of a mean of 2, whose deviation is that of renders by the program itself."""
        text = """Job { renderer: PathTracer { samples: 16 }
    image: SpectralFilm { width: 6, height: 4, edges: [400, 440, 520, 550] nm }
    outputs: [NpyOutput { file: "bands.npy", spectrum: true }]
    wavelengths: HeroWavelengths { distribution: uniform }
    camera: PerspectiveCamera { from: [0, 0, -3], to: [0, 0, 0], fov: 20 deg }
    scene: BruteForceScene { objects: [ Sphere { emission: DiffuseEmission { radiance: 2 } } ] } }
"""
        with self.open(text).page() as page:
            done = self.task(page, page.good("spectrum", x=3, y=2, samples=3)["task"])
            self.assertEqual(done["state"], "done", done["text"])
            found = done["spectrum"]
            self.assertEqual((found["x"], found["y"], found["renders"], found["samples"]), (3, 2, 16, 3))
            self.assertEqual(found["channels"], ["S0.420nm", "S0.480nm", "S0.535nm"])
            renders = []
            for seed in range(12):
                subprocess.run([PROGRAM, "render", str(self.file), "--quiet", "--samples", "3", "--seed", str(1000 + seed), "--crop", "3,2,4,3"],
                               cwd=self.folder.name, check=True)
                renders.append(values_of(pathlib.Path(self.folder.name, "bands.npy").read_bytes())[0])
            for band, (value, deviation) in enumerate(zip(found["values"], found["deviations"])):
                self.assertAlmostEqual(value, 2, delta=6 * deviation / (16 * 3) ** 0.5)
                mean = sum(r[band] for r in renders) / 12
                spread = (3 * sum((r[band] - mean) ** 2 for r in renders) / 11) ** 0.5
                # The ratio of the variances has an F distribution of 15 and 11 degrees of freedom: outside by chance 2 in 10,000 times.
                self.assertTrue(0.3 < deviation / spread < 3, (deviation, spread))
            self.assertFalse(page.ask("spectrum", x=6, y=2)["ok"])
            self.assertFalse(page.ask("spectrum", x=1, y=1, renders=1)["ok"])
        with self.open().page() as page:
            self.assertIn("SpectralFilm", page.ask("spectrum", x=1, y=1)["errors"][0]["message"])

    def test_checks_in_processes_of_their_own(self):
        with self.open().page() as page:
            page.good("stop")
            done = self.task(page, page.good("conform", **{"class": "BoxFilter"})["task"])
            self.assertEqual((done["state"], done["passed"]), ("done", True), done["text"])
            self.assertFalse(page.ask("conform", **{"class": "Boxfilter"})["ok"])
            self.assertFalse(page.ask("conform", **{"class": "--help"})["ok"])
            number = page.good("verify", renderers="PathTracer,BidirectionalPathTracer", samples=100000)["task"]
            page.good("end_task", task=number)
            self.assertEqual(self.task(page, number)["state"], "ended")
            self.assertFalse(page.ask("end_task", task=number)["ok"])
            self.assertFalse(page.ask("verify", renderers="PathTracer{},--report=/tmp/x")["ok"])

    def finished(self, page, samples):
        end = time.monotonic() + 120
        while time.monotonic() < end:
            now = page.ask("hello", protocol=1)["progress"]
            if now["state"] == "finished" and now["samples"] == samples:
                return
            page.drain(0.1)
        raise AssertionError(f"it did not end: {now}")

    def saved_picture(self, page):
        page.good("save_picture", file="now.npy", over=True)
        return pathlib.Path(self.folder.name, "now.npy").read_bytes()

    def test_going_on_from_a_state(self):
        with self.open().page() as page:
            self.finished(page, 64)
            page.good("save_state", file="kept.state")
            first = self.saved_picture(page)
            self.assertFalse(page.ask("save_state", file="kept.state")["ok"], "nothing is written over in silence")
        # Another program goes on from it, to the bits of a render in one go.
        more = SCENE.replace("samples: 64", "samples: 96")
        with self.open(more).page() as page:
            page.good("stop")
            page.good("goals", samples=64)
            page.good("load_state", file="kept.state")
            self.assertEqual(page.ask("hello", protocol=1)["progress"]["samples"], 64)
            self.assertEqual(self.saved_picture(page), first)
            page.good("goals", samples=96)
            page.good("start")
            self.finished(page, 96)
            subprocess.run([PROGRAM, "render", str(self.file), "-o", f"{self.folder.name}/whole.npy", "--quiet"], check=True)
            self.assertEqual(self.saved_picture(page), pathlib.Path(self.folder.name, "whole.npy").read_bytes())
            ball = next(int(i) for i, c in page.greeting["tree"]["components"].items() if c["class"] == "Sphere")
            page.good("edit", component=ball, member="radius", text="30 cm")
            self.assertFalse(page.ask("load_state", file="kept.state")["ok"], "it is of another scene")
            self.assertFalse(page.ask("load_state", file="scene.etd")["ok"])

    def test_a_new_beginning(self):
        studio = self.open()
        with studio.page() as page:
            ball = next(int(i) for i, c in page.greeting["tree"]["components"].items() if c["class"] == "Sphere")
            page.good("edit", component=ball, member="radius", text="30 cm")
            self.assertEqual(page.ask("begin_again")["errors"][0]["code"], "busy")
            page.good("save")
            self.assertTrue(page.ask("begin_again")["ok"])
            page.wait(lambda e: e.get("event") == "goodbye")
            with self.assertRaises((Closed, ConnectionResetError)):
                page.drain(20)
        end = time.monotonic() + 30
        while True:  # at the same address, with the same token
            try:
                with studio.page() as page:
                    self.assertEqual(page.status, 101)
                    self.assertIn("radius: 30 cm", page.greeting["text"]["text"])
                    break
            except (ConnectionError, Closed):
                self.assertLess(time.monotonic(), end)
                time.sleep(0.1)
        self.assertTrue(studio.alive())

    def test_a_word_to_end_is_heard_whenever_it_comes(self):
        # Also between the end of the program and its new beginning, where one got lost.
        for pause in (0, 0.002, 0.01, 0.05):
            studio = self.open()
            with studio.page() as page:
                self.assertTrue(page.ask("begin_again")["ok"], "the answer comes before the end")
                time.sleep(pause)
                studio.process.terminate()
                self.assertIsNotNone(studio.process.wait(20))


if __name__ == "__main__":
    unittest.main()
