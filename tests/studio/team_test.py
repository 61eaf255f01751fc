"""`mpirun etendue studio`: the page of the first process shows what all of them render, and all follow its edits."""

import os
import pathlib
import shutil
import signal
import sys
import tempfile
import time
import unittest

import render_test
from client import PROGRAM, Studio

MPIRUN = ["mpirun", "--oversubscribe", "--allow-run-as-root", "--bind-to", "none", "-n", "3"]
# Each process writes its number into a file first.
MPIRUN += ["sh", "-c", 'echo $$ > "rank.$OMPI_COMM_WORLD_RANK"; exec "$@"', "rank"]


class Team(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.file = pathlib.Path(self.folder.name) / "scene.etd"
        self.file.write_text(render_test.SCENE, encoding="utf-8")
        self.studio = Studio(self.file, folder=self.folder.name, threads=1, launcher=MPIRUN)
        self.addCleanup(self.studio.__exit__)

    def ranks(self):
        return {int(f.name[5:]): int(f.read_text()) for f in pathlib.Path(self.folder.name).glob("rank.*")}

    def all_ended(self, ranks, seconds):
        """Whether mpirun and all processes end within a time."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if not self.studio.alive() and not any(pathlib.Path(f"/proc/{number}/maps").exists() for number in ranks.values()):
                return True
            time.sleep(0.05)
        return False

    finished = render_test.Rendering.finished
    test_edits = render_test.Rendering.test_picture_after_edits_and_reconnects_is_that_of_a_fresh_render

    def test_ctrl_c_ends_all(self):
        ranks = self.ranks()
        with self.studio.page() as page:
            page.good("goals", samples=1000000)
            page.good("edit", component=1, member="seed", text="5")
            self.studio.process.send_signal(signal.SIGINT)
            self.assertTrue(self.all_ended(ranks, 10))

    def test_a_process_that_is_killed_ends_all(self):
        ranks = self.ranks()
        with self.studio.page() as page:
            page.good("goals", samples=1000000)
            os.kill(ranks[1], signal.SIGKILL)
            self.assertTrue(self.all_ended(ranks, 30))
        self.assertIn("signal 9", self.studio.process.stderr.read())


if __name__ == "__main__":
    if not shutil.which("mpirun") or not (pathlib.Path(PROGRAM).resolve().parent / "libetendue_mpi.so").exists():
        sys.exit(77)
    unittest.main()
