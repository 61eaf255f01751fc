"""A hundred thousand random calls."""

import pathlib
import subprocess
import sys

DRIVER = pathlib.Path(__file__).with_name("random_calls.py")


def test_a_hundred_thousand_random_calls():
    words = [sys.executable, "-X", "faulthandler", DRIVER, "--calls", "100000", "--seed", "2"]
    done = subprocess.run(words, capture_output=True, text=True, timeout=1400)
    assert done.returncode == 0, done.stderr[-4000:]
