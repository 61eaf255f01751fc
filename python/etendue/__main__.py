"""python -m etendue: the program."""

import sys

from ._installation import run_program

run_program(sys.argv[1:])
