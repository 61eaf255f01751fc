"""What whole processes take: the processor's time, and memory at its peak.

Linux counts the memory of a process from before it became another program, so one that is started by a large one would be said to be
as large (getrusage, ru_maxrss). Commands are therefore started by a small helper, which is started first.
"""
import dataclasses
import json
import subprocess
import sys

HELPER = """
import json, os, subprocess, sys, tempfile
for line in sys.stdin:
    with tempfile.TemporaryFile() as said:
        try:
            process = subprocess.Popen(json.loads(line), stdin=subprocess.DEVNULL, stdout=said, stderr=subprocess.STDOUT)
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = status
            answer = {"code": os.waitstatus_to_exitcode(status), "seconds": used.ru_utime + used.ru_stime,
                      "megabytes": used.ru_maxrss / 1024}
            said.seek(max(0, said.seek(0, 2) - 4000))
            answer["said"] = said.read().decode(errors="replace")
        except OSError as error:
            answer = {"code": 127, "said": str(error)}
    print(json.dumps(answer), flush=True)
"""
helper = None


@dataclasses.dataclass
class Used:
    seconds: float    # of the processor, user and system, of all threads
    megabytes: float  # of memory in use at the peak (resident), libraries included


def run(command):
    """Runs a command to its end. Raises RuntimeError with the end of what it said when it fails."""
    global helper
    if helper is None or helper.poll() is not None:
        helper = subprocess.Popen([sys.executable, "-S", "-E", "-c", HELPER], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    helper.stdin.write(json.dumps([str(part) for part in command]) + "\n")
    helper.stdin.flush()
    line = helper.stdout.readline()
    if not line:
        raise RuntimeError("the helper that runs commands has ended")
    answer = json.loads(line)
    if answer["code"]:
        raise RuntimeError(f"{' '.join(map(str, command))}\n{answer['said']}")
    return Used(answer["seconds"], answer["megabytes"])
