"""Many renders' worth of edits, reconnects and browsers on one studio: `--minutes 30` is the long run, the suite has a short one.
Memory must not grow by more than a tenth after the first sixth, and the picture at the end must be, byte for byte, that of a
fresh render of the text at the end."""

import argparse
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import time

SCENE = """# Soaked.
white = Lambertian { color: 0.7 }   # a wall
Job {
    renderer: PathTracer { samples: 16 }
    camera: PerspectiveCamera { from: [0, 1, -5], to: [0, 0.5, 0] }
    image: ImageBuffer { width: 160, height: 120 }
    outputs: [ NpyOutput {} ]
    scene: BvhScene { objects: [
        Sphere { radius: 1 m, shader: Lambertian { color: 0.5 } }
        Rectangle { corner: [-3, -1, -3], edge_u: [6, 0, 0], edge_v: [0, 0, 6], shader: white }   # floor
        Rectangle { corner: [-1, 3, -1], edge_u: [2, 0, 0], edge_v: [0, 0, 2], emission: DiffuseEmission { radiance: 3 } }
    ] }
}
"""


def id_of(page, name):
    components = page.ask("hello", protocol=1)["tree"]["components"]
    return next((int(i) for i, c in components.items() if c["class"] == name), None)


def act(page, r):
    """One thing that a person might do; what is refused is refused."""
    what = r.randrange(14)
    ball = id_of(page, "Sphere")
    if what < 4:
        for i in range(r.randrange(1, 6)):
            page.ask("edit", component=ball, member="radius", text=f"{50 + r.randrange(60)} cm", merge="slide")
    elif what < 6:
        for i in range(r.randrange(1, 5)):
            page.ask("orbit", x=r.uniform(-0.2, 0.2), y=r.uniform(-0.1, 0.1), final=False)
        page.ask("orbit", x=0.01, y=0, final=True)
    elif what == 6:
        page.ask("duplicate", component=id_of(page, "BvhScene"), member="objects", index=0)
    elif what == 7:
        page.ask("remove", component=id_of(page, "BvhScene"), member="objects", index=3)
    elif what == 8:
        page.ask("undo", count=r.randrange(1, 8))
    elif what == 9:
        page.ask("watch", what=r.choice(["linear", "toned", "none"]), slot=r.randrange(2))
    elif what == 10:
        page.ask("replay", x=r.randrange(160), y=r.randrange(120), paths=3)
        page.ask("wireframe")
        page.ask("warnings")
    elif what == 11:
        page.ask("restart")
        page.ask("pin", name="p")
    elif what == 12:
        sides = page.ask("renders", add={"renderer": r.choice(["BidirectionalPathTracer", "LightTracer"])})
        if len(sides.get("renders", [])) > 1 or not sides["ok"]:
            for side in page.ask("renders")["renders"]:
                page.ask("renders", remove=side["render"])
    else:
        page.ask("save_view", name="v", over=True)
        page.ask("use_view", name="v")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default=os.environ.get("ETENDUE_PROGRAM", "build/etendue"))
    parser.add_argument("--minutes", type=float, default=0.5)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    import client

    client.PROGRAM = options.program
    r = random.Random(options.seed)
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "soak.etd")
        file.write_text(SCENE, encoding="utf-8")
        begin = time.monotonic()
        length = 60 * options.minutes
        acts = pages = 0
        early = late = 0
        with client.Studio(file, folder=folder) as studio:
            while time.monotonic() - begin < length:
                with studio.page() as page:
                    pages += 1
                    page.ask("watch")
                    for _ in range(r.randrange(1, 12)):
                        act(page, r)
                        acts += 1
                        page.drain(r.random() * 0.2)
                        page.events.clear()
                        page.pixels.clear()
                    if r.random() < 0.5:
                        page.socket.close()  # lost, in the midst of things
                # As people stop now and then: undo must not be what grows.
                if pages % 10 == 0:
                    with studio.page() as page:
                        page.ask("save", over=True)
                        page.ask("open", file="soak.etd", discard=True)
                        page.ask("unpin", name="p")
                now = studio.memory()
                if time.monotonic() - begin < length / 6:
                    early = max(early, now)
                else:
                    late = max(late, now)
            with studio.page() as page:
                for side in page.ask("renders")["renders"]:
                    page.ask("renders", remove=side["render"])
                page.ask("goals", samples=None, time=None, error=None)
                page.ask("crop", area=None)
                page.good("save", over=True)
                page.good("restart")
                at = page.ask("hello", protocol=1)["progress"]["generation"]
                page.events.clear()
                page.wait(lambda e: e.get("event") == "progress" and e["state"] == "finished" and e["generation"] >= at, 300)
                page.good("save_picture", file="soaked.npy", over=True)
            alive = studio.alive()
        subprocess.run([options.program, "render", str(file), "-o", f"{folder}/fresh.npy", "--quiet"], check=True, stderr=subprocess.DEVNULL)
        same = pathlib.Path(folder, "soaked.npy").read_bytes() == pathlib.Path(folder, "fresh.npy").read_bytes()
        growth = late / early - 1 if early and late else 0
        print(
            f"{acts} acts of {pages} pages in {(time.monotonic() - begin) / 60:.1f} minutes, seed {options.seed}: memory {early >> 20} MB at most "
            f"in the first sixth, {late >> 20} MB later ({100 * growth:+.1f} %); the picture {'equals' if same else 'DIFFERS FROM'} a fresh render's"
        )
        # A short run has hardly begun when it ends: its memory says little.
        bound = 0.1 if options.minutes >= 10 else 0.5
        return 0 if alive and same and growth <= bound else 1


if __name__ == "__main__":
    sys.exit(main())
