"""A client of the studio by raw sockets: no library stands between the tests and the bytes."""

import base64
import contextlib
import faulthandler
import json
import math
import os
import re
import select
import socket
import struct
import subprocess
import time

PROGRAM = os.environ.get("ETENDUE_PROGRAM", "build/etendue")


# A test that waits for ever says where, shortly before its time limit ends it without a word.
if "ETENDUE_STUDIO_PATIENCE" in os.environ:
    faulthandler.dump_traceback_later(int(os.environ["ETENDUE_STUDIO_PATIENCE"]), exit=True)


class Closed(Exception):
    """The other side ended the connection."""


class Studio:
    """The program, and where it listens."""

    def __init__(self, file=None, *arguments, folder=None, threads=2, environment=None, command="studio", launcher=()):
        command = [*launcher, os.path.abspath(PROGRAM), command, "--no-browser", *arguments]
        if threads:
            command += ["--threads", str(threads)]
        if file:
            command.append(str(file))
        self.process = subprocess.Popen(
            command,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            cwd=folder,
            text=True,
            env={**os.environ, **(environment or {})},
        )
        line = self.process.stdout.readline()
        found = re.match(r"http://(127\.0\.0\.1|\[::1\]|[\d.]+):(\d+)/\?token=([0-9a-f]+)", line)
        if not found:
            self.process.wait(20)
            raise RuntimeError(f"no address: {line} {self.process.stderr.read()}")
        self.host, self.port, self.token = found[1], int(found[2]), found[3]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            raise
        finally:
            self.process.stdout.close()
            self.process.stderr.close()

    def alive(self):
        return self.process.poll() is None

    def memory(self):
        """Resident memory in bytes."""
        with open(f"/proc/{self.process.pid}/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    def socket(self):
        s = socket.create_connection(("127.0.0.1", self.port), timeout=30)
        s.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return s

    def get(self, target, headers=None, method="GET", body=b""):
        """Status and body of one request."""
        with self.socket() as s:
            lines = {"Host": f"127.0.0.1:{self.port}", **(headers or {})}
            head = f"{method} {target} HTTP/1.1\r\n" + "".join(f"{k}: {v}\r\n" for k, v in lines.items() if v is not None)
            if body:
                head += f"Content-Length: {len(body)}\r\n"
            s.sendall(head.encode() + b"\r\n" + body)
            answer = b""
            with contextlib.suppress(ConnectionResetError, TimeoutError):
                while part := s.recv(65536):
                    answer += part
        if not answer:
            return 0, {}, b""
        head, _, rest = answer.partition(b"\r\n\r\n")
        fields = dict(line.split(": ", 1) for line in head.decode().split("\r\n")[1:])
        return int(head.split()[1]), fields, rest

    def page(self, **options):
        return Page(self, **options)

    def status(self, **options):
        """What a page is answered that asks for the WebSocket."""
        with Page(self, hello=False, **options) as page:
            return page.status


class Page:
    """A WebSocket to a studio, as a browser's page has one."""

    def __init__(self, studio, token=None, origin="own", host="own", hello=True):
        self.socket = studio.socket()
        self.buffer = b""
        self.events, self.pixels, self.next = [], [], 1
        host = f"127.0.0.1:{studio.port}" if host == "own" else host
        head = f"GET /socket?token={studio.token if token is None else token} HTTP/1.1\r\nHost: {host}\r\n"
        if origin:
            head += f"Origin: {'http://' + host if origin == 'own' else origin}\r\n"
        key = base64.b64encode(os.urandom(16)).decode()
        head += f"Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n"
        self.socket.sendall(head.encode())
        while b"\r\n\r\n" not in self.buffer:
            self.fill()
        head, _, self.buffer = self.buffer.partition(b"\r\n\r\n")
        self.status = int(head.split()[1])
        if self.status == 101 and hello:
            self.greeting = self.ask("hello", protocol=1)

    def close(self):
        self.socket.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def fill(self):
        part = self.socket.recv(1 << 20)
        if not part:
            raise Closed
        self.buffer += part

    def take(self, size):
        while len(self.buffer) < size:
            self.fill()
        part, self.buffer = self.buffer[:size], self.buffer[size:]
        return part

    def send_frame(self, opcode, data, fin=True):
        head = bytes([(0x80 if fin else 0) | opcode])
        if len(data) < 126:
            head += bytes([0x80 | len(data)])
        elif len(data) < 65536:
            head += bytes([0x80 | 126]) + struct.pack(">H", len(data))
        else:
            head += bytes([0x80 | 127]) + struct.pack(">Q", len(data))
        mask = os.urandom(4)
        long_mask = (mask * (len(data) // 4 + 1))[: len(data)]
        masked = (int.from_bytes(data, "big") ^ int.from_bytes(long_mask, "big")).to_bytes(len(data), "big")
        self.socket.sendall(head + mask + masked)

    def receive(self, end=math.inf):
        """One message: words or pixels. The server's pings alone do not keep anybody waiting beyond `end`."""
        whole, kind = b"", 0
        while True:
            if time.monotonic() > end:
                raise AssertionError(f"nothing but pings came; the last of {len(self.events)} events: {self.events[-1:]}")
            first, second = self.take(2)
            size = second & 127
            if size == 126:
                (size,) = struct.unpack(">H", self.take(2))
            elif size == 127:
                (size,) = struct.unpack(">Q", self.take(8))
            data = self.take(size)
            opcode = first & 15
            if opcode == 8:
                raise Closed
            if opcode == 9:
                self.send_frame(10, data)
                continue
            if opcode == 10:
                continue
            kind = kind or opcode
            whole += data
            if first & 128:
                return json.loads(whole) if kind == 1 else Pixels(whole)

    def note(self, message):
        (self.pixels if isinstance(message, Pixels) else self.events).append(message)

    def send(self, request):
        self.send_frame(1, request if isinstance(request, bytes) else json.dumps(request).encode())

    def ask(self, do, **arguments):
        """A request's reply, whatever comes before it."""
        number = self.next
        self.next += 1
        self.send({"id": number, "do": do, **arguments})
        end = time.monotonic() + 120
        while time.monotonic() < end:
            message = self.receive(end)
            if isinstance(message, dict) and message.get("id") == number and "ok" in message:
                return message
            self.note(message)
        raise AssertionError(f"no reply to {do} {arguments}; the last of {len(self.events)} events: {self.events[-1:]}")

    def good(self, do, **arguments):
        reply = self.ask(do, **arguments)
        if not reply["ok"]:
            raise AssertionError(f"{do} {arguments}: {reply}")
        return reply

    def drain(self, seconds=0.0):
        """Whatever has come, and comes within a time; what goes on coming is left after ten seconds more."""
        end = time.monotonic() + seconds
        while time.monotonic() < end + 10 and (
            self.buffer or select.select([self.socket], [], [], max(end - time.monotonic(), 0))[0]
        ):
            self.note(self.receive())

    def wait(self, condition, seconds=60):
        """Reads until a message fulfils a condition; that message."""
        for message in self.events:
            if condition(message):
                return message
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if not self.buffer and not select.select([self.socket], [], [], 1)[0]:
                continue
            message = self.receive(end)
            self.note(message)
            if not isinstance(message, Pixels) and condition(message):
                return message
        raise AssertionError(f"what was waited for did not come; the last of {len(self.events)} events: {self.events[-1:]}")


class Pixels:
    """A binary message."""

    tile = 64

    def __init__(self, data):
        fields = struct.unpack_from("<8If3I", data)
        (self.kind, self.generation, self.width, self.height, self.x0, self.y0, self.full_width, self.full_height) = fields[:8]
        self.scale, self.samples, self.flags, count = fields[8:]
        self.slot = self.flags >> 8 & 0xFF
        self.size = len(data)
        self.tiles = {}
        at = 48 + 4 * count
        per_pixel = 6 if self.kind == 1 else 3
        for i in range(count):
            column, row = struct.unpack_from("<HH", data, 48 + 4 * i)
            width = min(self.tile, self.width - column * self.tile)
            height = min(self.tile, self.height - row * self.tile)
            size = width * height * per_pixel
            self.tiles[column, row] = data[at : at + size]
            at += size
        assert at == len(data), "the message is as long as its tiles"
