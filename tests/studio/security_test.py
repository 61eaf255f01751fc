"""Whoever should not come in does not, and nothing that is sent ends the studio or its render."""

import contextlib
import os
import pathlib
import random
import socket
import struct
import tempfile
import time
import unittest

from client import Closed, Studio

SCENE = """Job {
    renderer: PathTracer { samples: 100000 }
    camera: PerspectiveCamera { from: [0, 1, -5], to: [0, 0.5, 0] }
    image: ImageBuffer { width: 128, height: 96 }
    scene: BvhScene { objects: [
        Sphere { radius: 1 m, shader: Lambertian { color: 0.7 } }
        Rectangle { corner: [-1, 3, -1], edge_u: [2, 0, 0], edge_v: [0, 0, 2], emission: DiffuseEmission { radiance: 3 } }
    ] }
}
"""


class Security(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.file = pathlib.Path(cls.folder.name) / "scene.etd"
        cls.file.write_text(SCENE, encoding="utf-8")
        os.symlink("/etc", pathlib.Path(cls.folder.name) / "link")
        cls.studio = Studio(cls.file, folder=cls.folder.name)

    @classmethod
    def tearDownClass(cls):
        cls.studio.__exit__()
        cls.folder.cleanup()

    def tearDown(self):
        """Whatever was done: the render goes on, and a page is answered."""
        self.assertTrue(self.studio.alive())
        with self.studio.page() as page:
            before = page.greeting["progress"]
            self.assertEqual(before["state"], "rendering")
            time.sleep(0.5)
            now = page.ask("hello", protocol=1)["progress"]
            self.assertGreater(
                (now["generation"], now["samples"], now["fraction"]), (before["generation"], before["samples"], before["fraction"])
            )

    # ---- who comes in -------------------------------------------------------------------------------------------------------

    def test_tokens(self):
        token = self.studio.token
        self.assertEqual(self.studio.get("/")[0], 403)
        for wrong in ("", token[:-1], token + "0", "0" * len(token), token.upper() + "!"):
            self.assertEqual(self.studio.get(f"/?token={wrong}")[0], 403, wrong)
            self.assertEqual(self.studio.status(token=wrong), 403, wrong)
        self.assertIn(self.studio.get(f"/?token={token}")[0], (200, 503))  # 503: the page is not built

    def test_origins_and_hosts(self):
        port, token = self.studio.port, self.studio.token
        for origin in ("http://evil.example", "null", f"http://127.0.0.1:{port + 1}", f"https://127.0.0.1:{port}", "file://"):
            self.assertEqual(self.studio.status(origin=origin), 403, origin)
        for host in ("evil.example", f"evil.example:{port}", "127.0.0.1", f"127.0.0.1:{port + 1}", ""):
            self.assertEqual(self.studio.get(f"/?token={token}", {"Host": host})[0], 421, host)
            self.assertEqual(self.studio.status(host=host, origin=None), 421, host)
        self.assertEqual(self.studio.status(host=f"localhost:{port}"), 101)

    def test_addresses(self):
        token = self.studio.token
        for path in ("/../etc/passwd", "/scene.etd", "//", "/socket", "/manual/../x.md", "/manual/.md", "/%2e%2e/", "/index.html"):
            self.assertEqual(self.studio.get(f"{path}?token={token}")[0], 404, path)
        for method in ("POST", "PUT", "DELETE", "OPTIONS"):
            self.assertEqual(self.studio.get(f"/?token={token}", method=method)[0], 405)
        fields = self.studio.get(f"/?token={token}")[1]
        self.assertEqual(fields["X-Content-Type-Options"], "nosniff")

    def test_others_need_a_password(self):
        with self.assertRaises(RuntimeError):
            Studio(self.file, "--listen", "0.0.0.0", environment={"ETENDUE_STUDIO_PASSWORD": ""})
        with Studio(
            self.file, "--listen", "0.0.0.0", folder=self.folder.name, environment={"ETENDUE_STUDIO_PASSWORD": "a long secret"}
        ) as studio:
            status, _, body = studio.get("/")
            self.assertEqual((status, b"password" in body), (403, True))
            wrong = studio.get("/login", method="POST", body=b"password=wrong")
            self.assertEqual(wrong[0], 403)
            self.assertEqual(studio.get("/login", method="POST", body=b"password=a+long+secret")[0], 429, "not at once")
            time.sleep(1.1)
            status, fields, _ = studio.get("/login", method="POST", body=b"password=a+long%20secret")
            self.assertEqual(status, 303)
            self.assertIn("HttpOnly; SameSite=Strict", fields["Set-Cookie"])
            cookie = fields["Set-Cookie"].split(";")[0]
            self.assertIn(studio.get("/", {"Cookie": cookie})[0], (200, 503))
            self.assertEqual(studio.get("/", {"Cookie": cookie + "0"})[0], 403)

    # ---- what is sent -------------------------------------------------------------------------------------------------------

    def test_paths_outside(self):
        with self.studio.page() as page:
            for path in ("/etc/passwd", "../x.etd", "link/passwd", "/etc", "a/../../x.etd", "link/new.etd", "", "x\0.etd", "~/x.etd/../../../../etc/x.etd"):
                for request in (
                    {"do": "open", "file": path},
                    {"do": "save", "file": path},
                    {"do": "save_picture", "file": path + ".png"},
                    {"do": "save_state", "file": path},
                    {"do": "load_state", "file": path},
                    {"do": "files", "folder": path},
                    {"do": "queue", "add": [path]},
                ):
                    reply = page.ask(**request)
                    self.assertFalse(reply["ok"], request)
            self.assertNotIn("link", [e["name"] for e in page.good("files")["entries"]], "a link that leads out is not shown")
            text = page.greeting["text"]["text"]
            for line in ('include "/etc/passwd"\n', 'plugin "/tmp/x.so"\n', 'x = spectrum("/etc/passwd")\n'):
                reply = page.ask("text", revision=page.greeting["document"]["revision"], text=line + text)
                self.assertFalse(reply["valid"])
                self.assertIn("outside of the folders", str(reply["errors"]), line)
            page.good("drop_draft")
            reply = page.ask("watch", what="toned", tone_map='plugin "/tmp/x.so"\nAgXToneMap {}')
            self.assertFalse(reply["ok"])
            self.assertFalse(pathlib.Path("/etc/new.etd").exists())

    def test_any_message_is_answered(self):
        draw = random.Random(1)
        with self.studio.page() as page:
            names = [
                "hello edit edits reset undo redo replace add remove duplicate move share unshare rename text drop_draft complete hover",
                "definition save open goals crop watch view orbit pan dolly fly frame pick probe save_picture save_state load_state",
                "replay wireframe pin unpin files manual queue fireflies bad_samples conform",
            ]
            names = " ".join(names).split()
            keys = (
                "component member text index merge class use with to component_to member_to old name revision changes at file over "
                "discard seed samples time error area what layer tone_map edits final x y about sample count paths most folder "
                "endings add remove protocol do"
            ).split()

            def value(depth=0):
                kind = draw.randrange(12 if depth < 3 else 9)
                if kind == 9:
                    return [value(depth + 1) for _ in range(draw.randrange(4))]
                if kind == 10:
                    return {draw.choice(keys): value(depth + 1) for _ in range(draw.randrange(4))}
                if kind == 11:
                    return {"id": draw.randrange(30), "member": "radius", "index": draw.randrange(4)}
                return draw.choice(
                    [None, True, False, draw.randrange(40), -1, 1e300, 2**63, 0.5, "", "radius", "objects", "\u0000", "x" * 5000, "1 m", "Sphere {}", "../x", "É"]
                )

            for number in range(3000):
                # What runs long or leaves files behind is not what is tried here.
                do = draw.choice([n for n in names if n not in ("conform", "queue")])
                request = {"id": number, "do": do, **{k: value() for k in draw.sample(keys, draw.randrange(7))}}
                request["do"] = do
                request.pop("most", None)
                if do in ("goals", "crop", "restart"):
                    continue
                reply = page.ask(**{k: v for k, v in request.items() if k != "id"})
                self.assertIn("ok", reply)
                if not reply["ok"]:
                    self.assertTrue(reply["errors"][0]["message"])
            for text in (b"", b"{", b"[]", b"null", b"5", b'"x"', b"{}", b'{"do":', b'{"do":5}', b"[" * 100000, b'{"a":' * 100000):
                page.send(text)
            page.good("hello", protocol=1)
            self.assertEqual(sum("ok" in e and not e["ok"] and e.get("id") is None for e in page.events), 11)
            page.ask("drop_draft")
            page.ask("open", file=str(self.file), discard=True)

    def test_malformed_frames(self):
        draw = random.Random(2)
        frames = [
            b"\x81\x05hello",  # not masked
            b"\xc1\x80abcd",  # a reserved bit
            b"\x83\x80abcd",  # an unknown opcode
            b"\x89\xfe\x01\x00" + b"abcd" + bytes(256),  # a ping that is too long
            b"\x80\x80abcd",  # goes on with nothing
            b"\x01\x80abcd\x01\x80abcd",  # begins within another
            b"\x81\x85abcd" + b"\xff" * 5,  # no UTF-8
            b"\x88\x81abcdx",  # a close of one byte
        ]
        frames += [draw.randbytes(draw.randrange(1, 200)) for _ in range(150)]
        for data in frames:
            page = self.studio.page(hello=False)
            with contextlib.suppress(OSError):
                page.socket.sendall(data)
                page.socket.shutdown(socket.SHUT_WR)
                page.socket.settimeout(5)
                while page.socket.recv(65536):
                    pass
            page.close()
        for head in (b"\0" * 100, b"GET\r\n\r\n", b"GET / HTTP/9.9\r\n\r\n", b"A" * 100000, b"GET / HTTP/1.1\r\n" + b"X: y\r\n" * 10000):
            with self.studio.socket() as s, contextlib.suppress(OSError):
                s.sendall(head)
                s.settimeout(15)
                while s.recv(65536):
                    pass

    # ---- how much is sent ---------------------------------------------------------------------------------------------------

    def test_huge_messages(self):
        before = self.studio.memory()
        for size in (1 << 30, 1 << 62):
            with self.studio.page() as page:
                page.socket.sendall(b"\x81\xff" + struct.pack(">Q", size) + b"abcd")
                with self.assertRaises((Closed, OSError)):
                    for _ in range(1000):
                        page.socket.sendall(bytes(1 << 20))
                    page.receive()
        status, _, _ = self.studio.get(f"/?token={self.studio.token}", {"Content-Length": str(1 << 40)}, method="POST")
        self.assertIn(status, (0, 405, 413))
        self.assertLess(self.studio.memory() - before, 200 << 20)

    def test_1000_connections(self):
        held = []
        with contextlib.suppress(OSError):
            for _ in range(1000):
                held.append(socket.create_connection(("127.0.0.1", self.studio.port), timeout=5))
        with self.studio.page() as page:  # somebody else still comes in
            self.assertTrue(page.greeting["ok"])
        for s in held:
            s.close()
        pages = []
        for _ in range(40):
            page = self.studio.page(hello=False)
            if page.status == 101:
                pages.append(page)
            else:
                self.assertEqual(page.status, 503)
                page.close()
        self.assertEqual(len(pages), 32)
        for page in pages:
            page.close()
        time.sleep(0.5)

    def test_half_open_and_slow(self):
        with self.studio.socket() as half, self.studio.socket() as slow:
            half.sendall(b"GET / HT")
            begin = time.monotonic()
            closed = False
            for i in range(30):
                try:
                    slow.sendall(b"X")
                    time.sleep(0.5)
                    half.settimeout(0.01)
                    closed = closed or half.recv(1) == b""
                except TimeoutError:
                    pass
                except OSError:
                    break
                if closed:
                    break
            self.assertTrue(closed, "who says nothing for ten seconds is sent away")
            self.assertLess(time.monotonic() - begin, 14)

    def test_a_page_that_does_not_read(self):
        before = self.studio.memory()
        with self.studio.page() as page:
            page.good("watch", what="linear")
            page.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            # 32 requests of the whole vocabulary are over ten megabytes; more are not taken while these wait.
            with contextlib.suppress(OSError, TimeoutError):
                page.socket.settimeout(3)
                for _ in range(2000):
                    page.send({"do": "hello", "protocol": 1})
        self.assertLess(self.studio.memory() - before, 400 << 20)

    def test_read_only(self):
        with Studio(self.file, "--read-only", folder=self.folder.name) as studio, studio.page() as page:
            self.assertTrue(page.greeting["read_only"])
            page.good("watch")
            page.good("pick", x=64, y=48)
            for do in ("edit", "undo", "text", "save", "open", "pause", "restart", "shutdown", "queue", "save_picture", "conform", "files"):
                reply = page.ask(do)
                self.assertEqual(reply["errors"][0]["code"], "read_only", do)


if __name__ == "__main__":
    unittest.main()
