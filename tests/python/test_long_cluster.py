"""`etendue cluster submit` with a real Slurm, all of which runs on this machine: a job array, requeued tasks, the merged picture; a job
whose processes render together by MPI."""

import getpass
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import time

import pytest

PROGRAM = pathlib.Path(os.environ.get("ETENDUE_PROGRAM", "build/etendue")).resolve()
SCENE = pathlib.Path(__file__).resolve().parents[2] / "scenes" / "cornell_box.etd"

pytestmark = [
    pytest.mark.skipif(not all(map(shutil.which, ("slurmctld", "slurmd", "sbatch"))), reason="needs Slurm: Debian's slurm-wlm"),
    pytest.mark.skipif(not PROGRAM.exists(), reason="needs the program"),
]

CONFIGURATION = """
ClusterName=one
SlurmctldHost={host}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/none
AuthInfo=cred_expire=5
CredType=cred/none
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
SlurmctldPort={controller_port}
SlurmdPort={node_port}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
SchedulerParameters=batch_sched_delay=0,sched_interval=2
ReturnToService=2
NodeName={host} CPUs=2 State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def free_port():
    with socket.socket() as s:
        s.bind(("", 0))
        return s.getsockname()[1]


def wait_for(what, seconds=400):
    deadline = time.monotonic() + seconds
    while not (found := what()):
        assert time.monotonic() < deadline
        time.sleep(0.2)
    return found


@pytest.fixture
def slurm(tmp_path, monkeypatch):
    """Runs a command of Slurm and returns what it prints."""
    folder = tmp_path / "slurm"
    for name in ("state", "spool"):
        (folder / name).mkdir(parents=True)
    file = folder / "slurm.conf"
    file.write_text(
        CONFIGURATION.format(
            host=socket.gethostname().partition(".")[0],
            user=getpass.getuser(),
            folder=folder,
            controller_port=free_port(),
            node_port=free_port(),
        )
    )
    monkeypatch.setenv("SLURM_CONF", str(file))
    daemons = [subprocess.Popen([shutil.which(name), "-D", "-f", file], stderr=subprocess.DEVNULL) for name in ("slurmctld", "slurmd")]

    def run(*command):
        return subprocess.run(command, capture_output=True, text=True).stdout

    try:
        wait_for(lambda: "idle" in run("sinfo", "--noheader", "--format=%T"))
        yield run
    finally:
        run("scancel", "--user", getpass.getuser())
        for daemon in reversed(daemons):
            daemon.send_signal(signal.SIGTERM)
            try:
                daemon.wait(120)
            finally:
                daemon.kill()


def test_requeued_tasks_and_the_merged_picture(slurm, tmp_path):
    picture = [SCENE, "--samples", "200", "--size", "128x128"]
    subprocess.run([PROGRAM, "render", *picture, "-o", tmp_path / "one.npy", "--quiet"], check=True)
    submit = [PROGRAM, "cluster", "submit", *picture, "--parts", "2", "-o", "merged.npy", "--wait", "--slurm=--time=30"]
    submitted = subprocess.Popen(submit, cwd=tmp_path, stdout=subprocess.PIPE, text=True)

    def states():
        lines = slurm("squeue", "--noheader", "--array", "--format=%i %T %j").splitlines()
        return {words[0]: words[1] for words in map(str.split, lines) if not words[2].endswith(".merge")}

    def restarts(task):
        text = slurm("scontrol", "show", "job", task)
        return int(text.partition("Restarts=")[2].split()[0]) if "Restarts=" in text else 0

    first = wait_for(lambda: [task for task, state in states().items() if state == "RUNNING"])[0]
    time.sleep(1)
    # As when the time is almost up: the task saves its part and requeues itself.
    slurm("scancel", "--batch", "--signal=USR1", first)
    wait_for(lambda: restarts(first) == 1)
    wait_for(lambda: states().get(first) == "RUNNING")
    time.sleep(1)
    # As an administrator, or preemption, does it.
    slurm("scontrol", "requeue", first)
    wait_for(lambda: restarts(first) == 2)

    printed, _ = submitted.communicate(timeout=1000)
    assert submitted.returncode == 0, printed
    assert (tmp_path / "merged.npy").read_bytes() == (tmp_path / "one.npy").read_bytes()


@pytest.mark.skipif(not (PROGRAM.parent / "libetendue_mpi.so").exists(), reason="built without MPI")
def test_a_job_whose_processes_render_together_and_which_is_requeued(slurm, tmp_path):
    if "pmix" not in subprocess.run(["srun", "--mpi=list"], capture_output=True, text=True).stderr.split() and not list(
        pathlib.Path("/usr/lib").glob("*/slurm*/mpi_pmix.so")
    ):
        pytest.skip("this Slurm has no pmix")
    picture = [SCENE, "--samples", "400", "--size", "128x128"]
    subprocess.run([PROGRAM, "render", *picture, "-o", tmp_path / "one.npy", "--quiet"], check=True)
    options = ["--nodes", "1", "-o", "together.npy", "--wait"]
    for option in ("--time=30", "--ntasks-per-node=2", "--cpus-per-task=1"):
        options.append("--slurm=" + option)
    submitted = subprocess.Popen([PROGRAM, "cluster", "submit", *picture, *options], cwd=tmp_path, stdout=subprocess.PIPE, text=True)
    job = wait_for(lambda: slurm("squeue", "--noheader", "--states=RUNNING", "--format=%i").strip())
    time.sleep(2)
    # As when the time is almost up: the leader saves, and the job requeues itself.
    slurm("scancel", "--signal=USR1", job)
    printed, _ = submitted.communicate(timeout=1000)
    log = (tmp_path / "cornell_box.log").read_text()
    assert submitted.returncode == 0, printed + log
    assert ", interrupted\n" in log
    assert (tmp_path / "together.npy").read_bytes() == (tmp_path / "one.npy").read_bytes()
