"""The notebooks of docs/notebooks: where they are, and how tests run them."""

import importlib.util
import pathlib

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
NEEDED = ("nbclient", "nbformat", "ipykernel", "matplotlib", "PIL")

spec = importlib.util.spec_from_file_location("run_notebooks", ROOT / "tools" / "run_notebooks.py")
run_notebooks = importlib.util.module_from_spec(spec)
spec.loader.exec_module(run_notebooks)


def run(name, **parameters):
    """Runs a notebook as a reader would, with other values in its cell of parameters; the file stays as it is."""
    missing = [package for package in NEEDED if importlib.util.find_spec(package) is None]
    if missing:
        pytest.skip(f"needs {', '.join(missing)}: pip install -r python/requirements-notebooks.txt")
    import nbformat

    notebook = nbformat.read(str(run_notebooks.file_of(name)), as_version=4)
    if parameters:
        run_notebooks.set_parameters(notebook, **parameters)
    run_notebooks.execute(notebook)
