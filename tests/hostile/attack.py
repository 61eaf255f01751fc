#!/usr/bin/env python3
"""Runs Étendue on damaged files of every format it reads, and reports what must not happen.

    tests/hostile/attack.py --program build/etendue --plugin build/tests/libhostile.so --count 20000

Every input comes from a right file and the numbers --seed and its own (see seeds.py and mutations.py), so that any of them can be
made again: --only N runs number N alone, tells what is said and keeps the file. The program has 4 GB of memory and 20 s of the
processor's time, and five times as long by the clock, as other programs may be busy. Reported are

    crash     it was ended by a signal, or by a sanitizer
    time      it took longer
    memory    it used more than --memory, or ran out of memory, for an input below 1 MB
    nameless  it failed without the name of the damaged file
    odd       an exit status that is none of 0, 1, 2, or "unexpected failure"

Exit status: 0 when nothing is reported. For a program with sanitizers give --sanitized: those need an address space without limit,
so that the limit is on what it may write to (with --server), or on what it uses at a time.
"""
import argparse
import collections
import concurrent.futures
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

import mutations
import seeds

MEMORY = 4 << 30
SECONDS = 20
THREAD = threading.local()


class Server:
    """Runs commands one after another; see server.cpp."""

    def __init__(self, arguments):
        environment = dict(arguments.environment, LD_PRELOAD=arguments.server, OPENIMAGEIO_THREADS="1", OPENBLAS_NUM_THREADS="1",
                           ETENDUE_SERVER_LOADS=str(pathlib.Path(arguments.program).parent / "libetendue_openimageio.so"))
        self.memory = MEMORY if arguments.sanitized else 0
        self.process = subprocess.Popen([arguments.program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment)

    def run(self, seconds, command, folder, text):
        """(status, processor's seconds, peak memory [bytes])"""
        self.process.stdin.write("\x1f".join([str(folder), str(text), str(self.memory), *command]) + "\n")
        self.process.stdin.flush()
        child = int(self.process.stdout.readline().split()[1])
        timer = threading.Timer(5 * seconds, os.kill, (child, signal.SIGKILL))
        timer.start()
        answer = self.process.stdout.readline().split()
        timer.cancel()
        return int(answer[1]), float(answer[3]), int(answer[5]) * 1024


def run_anew(arguments, command, folder, text):
    with open(text, "wb") as out:
        process = subprocess.Popen([arguments.program, *command], cwd=folder, stdin=subprocess.DEVNULL, stdout=out, stderr=out,
                                   env=arguments.environment)
        timer = threading.Timer(5 * arguments.seconds, process.kill)
        timer.start()
        _, status, usage = os.wait4(process.pid, 0)
        timer.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
    return process.returncode, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024


def run(arguments, command, folder):
    """(status, text, processor's seconds, peak memory [bytes]); status None: it took too long."""
    text, begin = folder / "said", time.monotonic()
    if arguments.server:
        if not hasattr(THREAD, "server"):
            THREAD.server = Server(arguments)
        status, seconds, memory = THREAD.server.run(arguments.seconds, command, folder, text)
    else:
        status, seconds, memory = run_anew(arguments, command, folder, text)
    late = seconds > arguments.seconds or time.monotonic() - begin > 5 * arguments.seconds
    return None if late else status, text.read_bytes().decode(errors="replace"), seconds, memory


def verdict(status, said, memory, seed, data, limit):
    if status is None:
        return "time"
    if status < 0 or "AddressSanitizer" in said or "runtime error:" in said or "terminate called" in said:
        return "crash"
    short = any(word in said for word in ("bad_alloc", "not enough memory", "out of memory", "of memory there are"))
    if len(data) < 1 << 20 and (memory > limit or (short and "bad_alloc" not in seed.format)):
        return "memory"
    if status not in (0, 1, 2) or "unexpected failure" in said:
        return "odd"
    # What an included file no longer defines is missed where it is used; and a number of it that is right by itself, but too
    # large for the component that gets it, is told at that component.
    used = r"is not defined|^\s*scene\.etd:\d+:\d+: [A-Z]\w+: "
    named = seed.name in said or (seed.format == "etd included" and re.search(used, said, re.MULTILINE))
    if status != 0 and not named:
        return "nameless"
    return None


def thread_folder(arguments):
    if not hasattr(THREAD, "folder"):
        THREAD.folder = pathlib.Path(tempfile.mkdtemp(dir=arguments.folder))
    return THREAD.folder


def refusals(arguments, seed):
    """What is wrong with the answers to a file that is right."""
    folder, found = thread_folder(arguments), []
    for name, content in (*seed.beside.items(), (seed.name, seed.data)):
        (folder / name).write_bytes(content)
    for command in seed.commands:
        status, said, _, _ = run(arguments, command, folder)
        if status != 0 and "found" not in seed.format and not seed.format.startswith("etd "):
            found.append(f"a right file is refused: {seed.format}: {' '.join(command)}: status {status}\n    {said.strip()}\n")
    return found


def attack(arguments, all_seeds, number):
    generator = random.Random(arguments.seed * 1000003 + number)
    seed = all_seeds[number % len(all_seeds)]
    data = mutations.damaged(seed, generator, all_seeds)
    folder = thread_folder(arguments)
    for name, content in seed.beside.items():
        (folder / name).write_bytes(content)
    (folder / seed.name).write_bytes(data)
    command = generator.choice(seed.commands)
    status, said, seconds, memory = run(arguments, command, folder)
    problem = verdict(status, said, memory, seed, data, arguments.memory)
    if problem or arguments.only is not None:
        print(f"{problem or 'nothing'}: number {number}, {seed.format}, {len(data)} bytes: {' '.join(command)}: status {status}, "
              f"{seconds:.1f} s, {memory >> 20} MB\n    " + "\n    ".join(said.strip().splitlines()[-12:])[:2000], flush=True)
        if arguments.keep:
            kept = pathlib.Path(arguments.keep) / f"{number}-{problem}"
            kept.mkdir(parents=True, exist_ok=True)
            for name in (seed.name, *seed.beside, "said"):
                shutil.copy(folder / name, kept)
    return seed.format, problem, status, seconds, memory


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--plugin", help="a right plugin, to be damaged")
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--first", type=int, default=0, help="the first number")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int)
    parser.add_argument("--format", help="only formats that begin so, or so: some, with commas between")
    parser.add_argument("--keep", help="a folder for the inputs that something is reported of")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--seconds", type=float, default=SECONDS)
    parser.add_argument("--memory", type=int, default=2048, help="[MB]")
    parser.add_argument("--sanitized", action="store_true")
    parser.add_argument("--server", help="libhostile_server.so: the program is started once, which is ten times as fast")
    arguments = parser.parse_args()
    arguments.program = str(pathlib.Path(arguments.program).resolve())
    arguments.server = arguments.server and str(pathlib.Path(arguments.server).resolve())
    arguments.memory <<= 20
    arguments.environment = dict(os.environ)
    if arguments.sanitized:
        arguments.environment["ASAN_OPTIONS"] = "allocator_may_return_null=0:detect_leaks=0:hard_rss_limit_mb=4096:max_allocation_size_mb=4096"
        arguments.environment["UBSAN_OPTIONS"] = "print_stacktrace=1"
    else:
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, resource.RLIM_INFINITY))

    with tempfile.TemporaryDirectory() as folder:
        arguments.folder = folder
        all_seeds = seeds.seeds(arguments.program, arguments.plugin, pathlib.Path(folder))
        wrong = 0
        with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:  # what is not damaged must be read
            for refused in pool.map(lambda seed: refusals(arguments, seed), all_seeds if arguments.only is None else []):
                wrong += len(refused)
                print("".join(refused), end="")
        if arguments.format:
            all_seeds = [s for s in all_seeds if s.format.startswith(tuple(arguments.format.split(",")))]
        numbers = [arguments.only] if arguments.only is not None else range(arguments.first, arguments.first + arguments.count)
        with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
            results = list(pool.map(lambda n: attack(arguments, all_seeds, n), numbers))

    problems = collections.Counter(p for _, p, *_ in results if p)
    by_format = collections.Counter(f.split()[0] for f, *_ in results)
    refused = sum(status not in (0, None) for _, _, status, *_ in results)
    slowest, largest = max(r[3] for r in results), max(r[4] for r in results)
    print(f"{len(results)} damaged inputs ({', '.join(f'{n} {f}' for f, n in sorted(by_format.items()))}): {refused} refused; "
          f"slowest {slowest:.1f} s, most memory {largest >> 20} MB")
    print("reported: " + (", ".join(f"{n} {p}" for p, n in problems.items()) or "nothing"))
    return 1 if problems or wrong else 0


if __name__ == "__main__":
    sys.exit(main())
