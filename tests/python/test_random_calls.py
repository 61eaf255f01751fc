"""Random calls, a few thousand (random_calls.py runs as many as one likes)."""

import pathlib
import subprocess
import sys

import pytest

DRIVER = pathlib.Path(__file__).with_name("random_calls.py")


@pytest.mark.parametrize("threads", [1, 8])
def test_random_calls_raise_only_errors(threads):
    words = [sys.executable, "-X", "faulthandler", DRIVER, "--calls", "3000", "--threads", str(threads)]
    done = subprocess.run(words, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0 and "3000 calls" in done.stdout, done.stderr[-4000:]
