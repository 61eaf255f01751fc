"""`etendue render --tev`: what a tev would be sent. Its README (section "Over a Network") says that each packet is its length in
bytes, an operation and what belongs to that, in little endian; what belongs to each stands in its header Ipc.h."""

import pathlib
import socket
import struct
import subprocess
import tempfile
import threading
import time
import unittest

from client import PROGRAM
from requests_test import values_of

SCENE = """Job { renderer: PathTracer { samples: SAMPLES }, camera: PerspectiveCamera { from: [0, 1, -5], to: [0, 0, 0] }
image: ImageBuffer { width: 600, height: 500, filter: BoxFilter {} }, scene: BvhScene { objects: [
  Environment { emission: EnvironmentEmission { radiance: rgb(0.2, 0.4, 0.6) } }, Sphere { radius: 1 m, shader: Lambertian { color: 0.5 } } ] } }
"""


class Tev:
    """The picture that a tev would hold after all packets."""

    def __init__(self, data):
        self.operations, self.pictures = [], {}
        at = 0
        while at < len(data):
            (size,) = struct.unpack_from("<I", data, at)
            assert 5 < size <= len(data) - at, "a packet is as long as it says"
            self.packet(data[at + 4 : at + size])
            at += size

    def packet(self, data):
        self.data, self.at = data, 1
        operation = data[0]
        self.operations.append(operation)
        if operation == 2:
            del self.pictures[self.text()]
        elif operation == 4:
            self.take("<B")
            name, (width, height, count) = self.text(), self.take("<3i")
            names = [self.text() for _ in range(count)]
            self.pictures[name] = (width, height, {n: [0.0] * (width * height) for n in names})
        elif operation == 5:
            self.take("<B")
            name, (count,) = self.text(), self.take("<i")
            names = [self.text() for _ in range(count)]
            x, y, width, height = self.take("<4i")
            whole, _, planes = self.pictures[name]
            for n in names:
                values = self.take(f"<{width * height}f")
                for row in range(height):
                    planes[n][(y + row) * whole + x : (y + row) * whole + x + width] = values[row * width : (row + 1) * width]
        else:
            raise AssertionError(f"operation {operation}")
        assert self.at == len(data), "nothing is left of a packet"

    def take(self, form):
        values = struct.unpack_from(form, self.data, self.at)
        self.at += struct.calcsize(form)
        return values

    def text(self):
        end = self.data.index(0, self.at)
        text = self.data[self.at : end].decode()
        self.at = end + 1
        return text


class Sending(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)
        (self.path / "ball.etd").write_text(SCENE.replace("SAMPLES", "2"), encoding="utf-8")

    def render(self, *arguments):
        command = [PROGRAM, "render", "ball.etd", "-o", "ball.npy", "--quiet", "--threads", "2", *arguments]
        return subprocess.run(command, cwd=self.path, capture_output=True, text=True, timeout=120)

    def listening(self, serve):
        listener = socket.create_server(("127.0.0.1", 0))
        self.addCleanup(listener.close)
        thread = threading.Thread(target=lambda: serve(listener.accept()[0]), daemon=True)
        thread.start()
        return f"127.0.0.1:{listener.getsockname()[1]}", thread

    def test_the_last_picture_is_the_one_in_the_file(self):
        received = bytearray()

        def serve(connection):
            with connection:
                while part := connection.recv(1 << 20):
                    received.extend(part)

        address, thread = self.listening(serve)
        done = self.render("--tev", address)
        thread.join(30)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        tev = Tev(bytes(received))
        self.assertEqual(tev.operations.count(4), 1)
        self.assertEqual(tev.operations[0], 4, "it is made before it is filled")
        ((name, (width, height, planes)),) = tev.pictures.items()
        self.assertEqual((pathlib.Path(name).name, width, height, sorted(planes)), ("ball", 600, 500, ["B", "G", "R"]))
        numbers, shape = values_of((self.path / "ball.npy").read_bytes())
        # X Y Z to linear sRGB (IEC 61966-2-1).
        matrix = ((3.2404542, -1.5371385, -0.4985314), (-0.9692660, 1.8760108, 0.0415560), (0.0556434, -0.2040259, 1.0572252))
        for x, y in ((0, 0), (300, 250), (599, 499), (17, 437)):
            xyz = numbers[shape[2] * (y * width + x) :][:3]
            for row, channel in zip(matrix, "RGB"):
                self.assertAlmostEqual(planes[channel][y * width + x], sum(a * b for a, b in zip(row, xyz)), delta=2e-4)

    def test_nobody_there(self):
        closed = socket.create_server(("127.0.0.1", 0))
        port = closed.getsockname()[1]
        closed.close()
        done = self.render("--tev", f"127.0.0.1:{port}")
        self.assertEqual(done.returncode, 0)
        self.assertIn(f"not shown in tev at 127.0.0.1:{port}: Connection refused", done.stderr)
        self.assertTrue((self.path / "ball.npy").exists())
        self.assertIn("not shown in tev", self.render("--tev", "no.such.host.invalid").stderr)

    def test_one_who_hangs_up_and_one_who_does_not_read(self):
        plain = self.render()
        self.assertEqual(plain.returncode, 0)
        true = (self.path / "ball.npy").read_bytes()
        address, _ = self.listening(lambda c: c.close())
        done = self.render("--tev", address)
        self.assertEqual(done.returncode, 0)
        self.assertIn("not shown in tev", done.stderr)
        address, _ = self.listening(lambda c: time.sleep(60))
        began = time.monotonic()
        done = self.render("--tev", address)
        self.assertEqual(done.returncode, 0)
        self.assertIn("there is no answer", done.stderr)
        self.assertLess(time.monotonic() - began, 40)
        self.assertEqual((self.path / "ball.npy").read_bytes(), true)

    def test_a_slow_one_does_not_hold_the_picture_back(self):
        def serve(connection):
            with connection:
                while connection.recv(1000):
                    time.sleep(0.25)

        address, _ = self.listening(serve)
        began, written_after = time.monotonic(), []

        def watch():
            while not (self.path / "ball.npy").exists() and time.monotonic() - began < 60:
                time.sleep(0.05)
            written_after.append(time.monotonic() - began)

        watcher = threading.Thread(target=watch)
        watcher.start()
        done = self.render("--tev", address)
        ended = time.monotonic() - began
        watcher.join()
        self.assertEqual(done.returncode, 0)
        self.assertIn("no answer in time", done.stderr)
        self.assertGreater(ended - written_after[0], 1.5, "the viewer is waited for, with the picture in its file")
        self.assertLess(ended - written_after[0], 12)

    def test_what_is_no_address(self):
        for text in ("", ":14158", "host:", "host:0", "host:70000", "host:x", "[::1", "[::1]x"):
            done = self.render("--tev", text) if text else self.render("--tev=")
            if text:
                self.assertEqual(done.returncode, 2, text)
                self.assertIn("--tev", done.stderr)


if __name__ == "__main__":
    unittest.main()
