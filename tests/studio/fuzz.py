"""Fuzzes the studio's server: what is sent is nearly, but not quite, what a page would send. `--seconds 3600 --program
build-asan/etendue` is the long run; the suite has a short one. The program must stay alive, say nothing of a sanitizer, keep
answering an honest page, and its memory must stay bounded. A failure names the seed and the case, by which `--case` repeats it."""

import argparse
import json
import os
import pathlib
import random
import re
import socket
import struct
import sys
import tempfile
import time

SCENE = """white = Lambertian { color: 0.7 }   # a wall
Job {
    renderer: PathTracer { samples: 1000000 }
    camera: PerspectiveCamera { from: [0, 1, -5], to: [0, 0.5, 0] }
    image: ImageBuffer { width: 40, height: 30 }
    outputs: [ NpyOutput {} ]
    scene: BvhScene { objects: [
        Sphere { radius: 1 m, shader: white, emission: DiffuseEmission { radiance: 3 } }
        Sphere { radius: 50 cm, transform: translate(1, 0, 0), shader: white }
    ] }
}
"""

TEXTS = ["", "x", "\0", "é" * 300, "../../etc/passwd", "/etc/passwd", "/dev/zero", "{", "]", "1e999", "-1", "30 cm", "none", "white", "Sphere {}",
         "Lambertian { color: 0.5 }", "[0, 0, 0]", "pin:x", "linear", "PathTracer", "radius", "objects", "scene.etd", "other.etd", "a" * 5000,
         "rgb(1, 0, 0)", "\ud83d\ude00", "include \"/etc/passwd\"", "spectrum(\"/etc/passwd\")", "plugin \"x.so\"", "(" * 400, "[" * 400]
NUMBERS = [0, 1, 2, 3, 5, 8, -1, 0.5, 1e9, -1e18, 2**31, 2**53, 2**63, 1e308, 4294967296]


def program_requests(source):
    """The requests there are, by name, from the sources, so that none is forgotten."""
    names = set()
    for file in source.glob("requests/*.cpp"):
        table = file.read_text(encoding="utf-8")
        names |= set(re.findall(r'\{"(\w+)", (?:true|false), \w+\}', table))
    assert len(names) > 50, names
    return sorted(names - {"shutdown", "begin_again", "conform", "verify"})


KEYS = ["component", "member", "index", "text", "class", "use", "to", "with", "name", "old", "count", "revision", "changes", "at", "file", "over",
        "discard", "seed", "samples", "time", "error", "area", "what", "layer", "tone_map", "edits", "final", "x", "y", "about", "right", "up",
        "forward", "paths", "sample", "most", "folder", "endings", "add", "remove", "start", "stop", "merge", "render", "slot", "picture", "width",
        "task", "protocol", "component_to", "member_to"]


class Words:
    """Requests at random: many are nearly right."""

    def __init__(self, random_numbers, requests):
        self.r, self.requests = random_numbers, requests

    def value(self, depth=0):
        kind = self.r.randrange(10 if depth < 3 else 7)
        if kind < 2:
            return self.r.choice(NUMBERS)
        if kind < 4:
            return self.r.choice(TEXTS)
        if kind == 4:
            return self.r.randrange(12)
        if kind == 5:
            return self.r.choice([True, False, None])
        if kind == 6:
            return self.r.uniform(-3, 3)
        if kind < 9:
            return [self.value(depth + 1) for _ in range(self.r.randrange(5))]
        return {self.r.choice(KEYS): self.value(depth + 1) for _ in range(self.r.randrange(4))}

    def request(self):
        r = self.r
        message = {"id": r.choice([1, "a", None, [1], 2**70]), "do": r.choice(self.requests)}
        likely = {"component": lambda: r.randrange(1, 12), "member": lambda: r.choice(["radius", "objects", "shader", "color", "transform", "samples", "x"]),
                  "text": lambda: r.choice(TEXTS), "index": lambda: r.randrange(3), "x": lambda: r.uniform(-1, 40), "y": lambda: r.uniform(-1, 30),
                  "class": lambda: r.choice(["Sphere", "Mirror", "Phong", "Dielectric", "BidirectionalPathTracer", "Box", "Union"]),
                  "revision": lambda: r.randrange(40), "name": lambda: r.choice(["white", "view", "a b", "x"]), "final": lambda: r.random() < 0.5,
                  "changes": lambda: [{"begin": r.randrange(400), "end": r.randrange(400), "insert": r.choice(TEXTS)}], "samples": lambda: r.choice([1, 2, 9]),
                  "width": lambda: 8, "discard": lambda: True, "protocol": lambda: 1}
        for key, make in likely.items():
            if r.random() < 0.6:
                message[key] = make()
        for _ in range(r.randrange(4)):
            message[r.choice(KEYS)] = self.value()
        return message

    def bytes(self):
        text = json.dumps(self.request()).encode("utf-8", "surrogatepass")
        if self.r.random() < 0.3:  # damaged
            data = bytearray(text)
            for _ in range(self.r.randrange(1, 6)):
                at = self.r.randrange(len(data) + 1)
                what = self.r.randrange(3)
                if what == 0:
                    data[at:at] = bytes(self.r.randrange(256) for _ in range(self.r.randrange(1, 9)))
                elif what == 1:
                    del data[at : at + self.r.randrange(1, 9)]
                elif at < len(data):
                    data[at] ^= 1 << self.r.randrange(8)
            text = bytes(data)
        return text


def frame(r, payload):
    """A WebSocket frame (RFC 6455, section 5.2), at times a wrong one."""
    opcode = r.choice([1] * 12 + [0, 2, 3, 8, 9, 10, 11, 15])
    first = (0x80 if r.random() < 0.85 else 0) | (r.choice([0x10, 0x20, 0x40]) if r.random() < 0.05 else 0) | opcode
    masked = 0x80 if r.random() < 0.95 else 0
    size = len(payload)
    if r.random() < 0.04:  # a length that is not true
        size = r.choice([0, 125, 126, 65535, 65536, 1 << 30, (1 << 63) - 1, (1 << 64) - 1, size + 1, max(size - 1, 0)])
    if size < 126 and r.random() < 0.97:
        head = bytes([first, masked | size])
    elif size < 65536 and r.random() < 0.97:
        head = bytes([first, masked | 126]) + struct.pack(">H", size)
    else:
        head = bytes([first, masked | 127]) + struct.pack(">Q", size)
    if not masked:
        return head + payload
    mask = r.randbytes(4)
    return head + mask + bytes(b ^ mask[i & 3] for i, b in enumerate(payload))


def hand_shake(r, host, token):
    """Asks for a WebSocket: rightly, or nearly."""
    head = [f"GET /socket?token={token} HTTP/1.1", f"Host: {host}", f"Origin: http://{host}", "Upgrade: websocket", "Connection: Upgrade",
            "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==", "Sec-WebSocket-Version: 13"]
    text = "\r\n".join(head) + "\r\n\r\n"
    if r.random() < 0.2:
        data = bytearray(text.encode())
        for _ in range(r.randrange(1, 8)):
            at = r.randrange(len(data))
            data[at : at + r.randrange(3)] = r.randbytes(r.randrange(4))
        return bytes(data)
    return text.encode()


def one_case(r, studio, words):
    """A connection that sends what it likes, and reads what it likes."""
    try:
        with socket.create_connection(("127.0.0.1", studio.port), timeout=5) as s:
            s.sendall(hand_shake(r, f"127.0.0.1:{studio.port}", studio.token))
            if r.random() < 0.1:
                s.sendall(r.randbytes(r.randrange(3000)))
            for _ in range(r.randrange(1, 40)):
                payload = words.bytes() if r.random() < 0.9 else r.randbytes(r.randrange(200))
                data = frame(r, payload)
                cut = r.randrange(len(data)) if r.random() < 0.05 else len(data)
                s.sendall(data[:cut])
                if r.random() < 0.3:
                    s.settimeout(0.02)
                    try:
                        if not s.recv(1 << 20):
                            return
                    except TimeoutError:
                        pass
                    s.settimeout(5)
            if r.random() < 0.5:
                s.settimeout(0.1)
                try:
                    while s.recv(1 << 20):
                        pass
                except TimeoutError:
                    pass
    except (ConnectionError, TimeoutError, OSError):
        pass


def honest(studio):
    """A page that does what pages do is answered."""
    with studio.page() as page:
        page.good("watch")
        assert page.ask("probe", x=3, y=3) is not None
        page.drain(0.1)
        page.ask("new", discard=True)
        page.good("open", file="scene.etd", discard=True)
        page.good("drop_draft")
        for side in page.greeting["renders"]:
            page.ask("renders", remove=side["render"])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default=os.environ.get("ETENDUE_PROGRAM", "build/etendue"))
    parser.add_argument("--seconds", type=float, default=15)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--case", type=int, help="this case alone, and those of its round before it")
    options = parser.parse_args()
    os.environ["ETENDUE_PROGRAM"] = options.program
    import client

    client.PROGRAM = options.program
    requests = program_requests(pathlib.Path(__file__).parents[2] / "src" / "studio")
    end, number, rounds, sent, largest = time.monotonic() + options.seconds, 0, 0, 0, 0
    in_round = 200  # then the program is begun anew, so that a failure is found again from there
    if options.case is not None:
        number = options.case // in_round * in_round
    while time.monotonic() < end and (options.case is None or number <= options.case):
        rounds += 1
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "scene.etd")
            file.write_text(SCENE, encoding="utf-8")
            studio = client.Studio(file, folder=folder, threads=1)
            complaint, first = "", 0
            try:
                first = studio.memory()
                for _ in range(in_round):
                    if time.monotonic() > end or (options.case is not None and number > options.case):
                        break
                    r = random.Random(f"{options.seed} {number}")
                    one_case(r, studio, Words(r, requests))
                    number += 1
                    if not studio.alive():
                        complaint = "the program has ended"
                        break
                    if number % 20 == 0:
                        file.write_text(SCENE, encoding="utf-8")
                        honest(studio)
                    sent += 1
                    largest = max(largest, studio.memory() - first)
                    if studio.memory() - first > 2 << 30:
                        complaint = f"{studio.memory() >> 20} MB are in use"
                        break
            except Exception as error:  # whatever it is, the case is what matters
                complaint = f"an honest page failed: {type(error).__name__}: {error}"
            studio.process.terminate()
            try:
                _, said = studio.process.communicate(timeout=60)
            except Exception:
                studio.process.kill()
                _, said = studio.process.communicate()
                complaint = complaint or "it did not end when it was asked to"
            if studio.process.returncode != 0 and not complaint:
                complaint = f"it ended with {studio.process.returncode}"
            if "Sanitizer" in said or "runtime error" in said:
                complaint = complaint or "a sanitizer reported"
            if complaint:
                print(f"seed {options.seed}, before case {number}: {complaint}\n{said[-8000:]}", flush=True)
                return 1
    print(f"{sent} connections in {rounds} programs, seed {options.seed}: nothing reported; memory grew by {largest >> 20} MB at most")
    return 0


if __name__ == "__main__":
    sys.exit(main())
