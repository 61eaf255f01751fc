"""Machines joined by a slow network, on one machine: runs a command by mpirun in network namespaces.

    python3 benchmarks/slow_network.py --delay 1e-3 --rate 1e9 -n 2 build/etendue render box.etd …

Each process gets a namespace with a name and an address of its own, which stands for a machine, and a TUN device. This script carries the packets
between the devices: each leaves its machine when those before it have left at `--rate` [bit/s], and arrives `--delay` [s] later. So does `tc netem`, which
not every kernel has. Needs root, iproute2 and Open MPI. Messages between the processes go by TCP, the first process is on the machine that starts them.

It shows how much of the time of messages is hidden by computing (docs/results/team-costs.md). Delays below 0.1 ms are not resolved, as the script
sleeps that long.
"""

import argparse
import collections
import ctypes
import fcntl
import os
import pathlib
import select
import struct
import subprocess
import sys
import tempfile
import threading
import time

NAME = "etendue-machine-{}"
ADDRESS = "10.77.0.{}"
PACKET = 9000  # [bytes] largest, as in fast Ethernet networks
TUNSETIFF, IFF_TUN, IFF_NO_PI = 0x400454CA, 0x0001, 0x1000
CLONE_NEWNET = 0x40000000


def ip(*arguments):
    subprocess.run(["ip", *arguments], check=True)


def enter(namespace):
    if ctypes.CDLL(None, use_errno=True).setns(namespace.fileno(), CLONE_NEWNET) != 0:
        raise OSError(ctypes.get_errno(), "setns")


def device(number):
    """Makes a machine, and returns the file of its network device."""
    name = NAME.format(number)
    ip("netns", "add", name)
    with open("/proc/self/ns/net") as own, open(f"/run/netns/{name}") as its:
        enter(its)
        try:
            file = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
            fcntl.ioctl(file, TUNSETIFF, struct.pack("16sH22x", b"net0", IFF_TUN | IFF_NO_PI))
        finally:
            enter(own)
    ip("-n", name, "address", "add", ADDRESS.format(number + 1) + "/24", "dev", "net0")
    ip("-n", name, "link", "set", "net0", "mtu", str(PACKET), "txqueuelen", "10000", "up")
    ip("-n", name, "link", "set", "lo", "up")
    return file


class Relay(threading.Thread):
    def __init__(self, devices, delay, rate):
        super().__init__(daemon=True)
        self.devices, self.delay, self.rate = devices, delay, rate
        self.packets = self.bytes = 0
        self.late = 0.0  # [s] most that a packet was delivered after its time

    def run(self):
        free = [0.0] * len(self.devices)  # when each machine may send again
        under_way = [collections.deque() for _ in self.devices]
        while True:
            now = time.monotonic()
            due = min((queue[0][0] for queue in under_way if queue), default=now + 1)
            readable, _, _ = select.select(self.devices, [], [], max(due - now, 0))
            now = time.monotonic()
            for sender, file in enumerate(self.devices):
                if file not in readable:
                    continue
                for _ in range(64):
                    try:
                        packet = os.read(file, 65536)
                    except BlockingIOError:
                        break
                    if packet[0] >> 4 != 4:
                        continue  # IPv6
                    free[sender] = max(free[sender], now) + len(packet) * 8 / self.rate
                    under_way[sender].append((free[sender] + self.delay, packet))
                    self.packets += 1
                    self.bytes += len(packet)
            now = time.monotonic()
            for queue in under_way:
                while queue and queue[0][0] <= now:
                    when, packet = queue.popleft()
                    self.late = max(self.late, now - when)
                    to = packet[19] - 1  # the last byte of the address
                    if 0 <= to < len(self.devices):
                        try:
                            os.write(self.devices[to], packet)
                        except BlockingIOError:
                            pass  # lost: TCP sends it again


def command_line(arguments, agent):
    hosts = ",".join(ADDRESS.format(i + 1) for i in range(arguments.n))
    network = ADDRESS.format(0) + "/24"
    return ["mpirun", "--allow-run-as-root", "--bind-to", "none", "-n", str(arguments.n), "--host", hosts, "--mca", "plm_rsh_agent", agent,
            "--mca", "btl", "tcp,self", "--mca", "btl_tcp_if_include", network, "--mca", "oob_tcp_if_include", network, *arguments.command]


def on_machine(number):
    """Runs a shell's command on a machine; its own name is that of the machine."""
    name = NAME.format(number)
    return ["ip", "netns", "exec", name, "unshare", "--uts", "sh", "-c", f'hostname {name}; exec "$@"', "sh"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--delay", type=float, default=1e-3, help="[s] each way")
    parser.add_argument("--rate", type=float, default=10e9, help="[bit/s]")
    parser.add_argument("-n", type=int, default=2, help="number of machines")
    parser.add_argument("command", nargs=argparse.REMAINDER)
    arguments = parser.parse_args()
    devices = []
    with tempfile.TemporaryDirectory() as folder:
        agent = pathlib.Path(folder) / "agent"
        # mpirun gives the host's address and a shell's command, as it would to ssh.
        agent.write_text(f"#!/bin/sh\nhost=$1; shift\nnumber=$((${{host##*.}} - 1))\n"
                         f"exec ip netns exec {NAME.format('$number')} unshare --uts sh -c \"hostname {NAME.format('$number')}; $*\"\n")
        agent.chmod(0o755)
        try:
            for number in range(arguments.n):
                devices.append(device(number))
            relay = Relay(devices, arguments.delay, arguments.rate)
            relay.start()
            done = subprocess.run([*on_machine(0), *command_line(arguments, str(agent))])
            print(f"{relay.packets} packets, {relay.bytes} bytes, the latest {relay.late * 1e3:.1f} ms after its time", file=sys.stderr)
        finally:
            for number in range(arguments.n):
                subprocess.run(["ip", "netns", "delete", NAME.format(number)], stderr=subprocess.DEVNULL)
    return done.returncode


if __name__ == "__main__":
    sys.exit(main())
