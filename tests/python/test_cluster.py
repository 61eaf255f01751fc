"""`etendue cluster submit` with an sbatch that runs what it is given at once: the batch files, what is refused."""

import os
import pathlib
import subprocess

import clusters
import pytest

PROGRAM = pathlib.Path(os.environ.get("ETENDUE_PROGRAM", "build/etendue")).resolve()

pytestmark = pytest.mark.skipif(not PROGRAM.exists(), reason="needs the program")

SBATCH = """#!/bin/sh
echo "$*" >> submitted
for script; do :; done
tasks=$(sed -n 's/^#SBATCH --array=0-//p' "$script")
for task in $(seq 0 "${tasks:-0}"); do
  SLURM_ARRAY_JOB_ID=17 SLURM_ARRAY_TASK_ID=$task SLURM_CPUS_ON_NODE=1 sh "$script" >&2 || exit 1
done
echo 17
"""


@pytest.fixture
def submit(tmp_path):
    clusters.write_scene(tmp_path)
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "sbatch").write_text(SBATCH)
    (tmp_path / "bin" / "sbatch").chmod(0o755)

    def run(*arguments, slurm=True):
        path = f"{tmp_path / 'bin'}:" * slurm + "/usr/bin:/bin"
        command = [PROGRAM, "cluster", "submit", "small.etd", *arguments]
        return subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, env={**os.environ, "PATH": path})

    return run


def test_parts_are_rendered_and_merged(submit, tmp_path):
    passes = ["--size", "512x512", "--samples", "5"]  # of 2 samples each
    done = submit(*passes, "--parts", "2", "-o", "merged.npy", "--slurm=--partition=fast")
    assert done.returncode == 0, done.stderr
    assert "3 passes in 2 parts\njob 17: the parts\njob 17: the picture" in done.stdout
    assert (tmp_path / "submitted").read_text().splitlines() == [
        "--parsable small.render.sbatch",
        "--parsable --dependency=afterok:17 --kill-on-invalid-dep=yes small.merge.sbatch",
    ]
    for script in ("small.render.sbatch", "small.merge.sbatch"):
        assert "\n#SBATCH --partition=fast\n" in (tmp_path / script).read_text()
    subprocess.run([PROGRAM, "render", "small.etd", *passes, "-o", "one.npy", "--quiet"], cwd=tmp_path, check=True)
    assert (tmp_path / "merged.npy").read_bytes() == (tmp_path / "one.npy").read_bytes()


def test_a_dry_run_submits_nothing(submit, tmp_path):
    done = submit("--parts", "99", "--dry-run")
    assert done.returncode == 0, done.stderr
    assert "1 pass in 1 part\n" in done.stdout
    assert (tmp_path / "small.render.sbatch").exists() and not (tmp_path / "submitted").exists()


@pytest.mark.parametrize(
    "arguments, reason",
    [
        (["--set", "renderer=GuidedPathTracer {}"], "GuidedPathTracer: learns from one pass to the next"),
        (["--set", "time_limit=5 s"], "a limit of time or error would end each part by itself"),
        (["-o", "small.etd"], "no format has the ending '.etd'"),
    ],
)
def test_what_cannot_be_divided_is_refused(submit, tmp_path, arguments, reason):
    done = submit("--parts", "2", *arguments)
    assert done.returncode == 2 and reason in done.stderr, done.stderr
    assert not (tmp_path / "small.render.sbatch").exists()


def test_a_job_that_renders_by_mpi(submit, tmp_path):
    (tmp_path / "bin" / "srun").write_text('#!/bin/sh\necho "$1 $2" > srun_options\nshift 2\nexec "$@"\n')
    (tmp_path / "bin" / "srun").chmod(0o755)
    done = submit("--nodes", "3", "--set", "renderer=GuidedPathTracer { samples: 4 }", "-o", "a b.npy", "--slurm=--partition=fast")
    assert done.returncode == 0, done.stderr
    assert done.stdout == "small.render.sbatch\njob 17: the picture\n"
    script = (tmp_path / "small.render.sbatch").read_text()
    assert "\n#SBATCH --nodes=3\n" in script and "\n#SBATCH --partition=fast\n" in script
    assert (tmp_path / "srun_options").read_text() == "--mpi=pmix --cpus-per-task=1\n"
    assert (tmp_path / "a b.npy").exists() and (tmp_path / "small.checkpoint").exists()
    for both in (["--nodes", "2", "--parts", "2"], []):
        assert submit(*both).returncode == 2


def test_where_there_is_no_slurm(submit):
    done = submit("--parts", "2", slurm=False)
    if not pathlib.Path("/usr/bin/sbatch").exists():
        assert done.returncode != 0 and "there is no command sbatch" in done.stderr
