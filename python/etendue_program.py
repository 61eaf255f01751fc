#!python
# The command `etendue` of the package. It starts the program without importing the package.
import importlib.util
import os
import runpy
import sys

package = importlib.util.find_spec("etendue")
if package is None or not package.submodule_search_locations:
    sys.exit(f"etendue: the Python package etendue is not installed for {sys.executable}")
runpy.run_path(os.path.join(package.submodule_search_locations[0], "_installation.py"), run_name="__main__")
