#!/usr/bin/env python3
"""Runs the notebooks of docs/notebooks and keeps their outputs in the files.

    python3 tools/run_notebooks.py first-picture a-lens      # these; without names all

Needs the packages of python/requirements-notebooks.txt and the package etendue. A notebook that fails stays as it was.
"""

import json
import os
import pathlib
import sys
import tempfile

FOLDER = pathlib.Path(__file__).resolve().parent.parent / "docs" / "notebooks"
ALL = sorted(file.stem for file in FOLDER.glob("*.ipynb"))


def file_of(name):
    return FOLDER / f"{name}.ipynb"


def execute(notebook, seconds=3600):
    """Runs all cells in a new kernel, in the notebook's folder. Raises CellExecutionError if one fails."""
    import nbclient

    with tempfile.TemporaryDirectory() as profile:
        os.environ["IPYTHONDIR"] = profile  # the user's own start-up files are no part of a notebook
        client = nbclient.NotebookClient(
            notebook, timeout=seconds, kernel_name="python3", resources={"metadata": {"path": str(FOLDER)}}, record_timing=False
        )
        client.execute()


def set_parameters(notebook, **values):
    """Assigns other values at the end of the cell with the tag "parameters"."""
    for cell in notebook.cells:
        if "parameters" in cell.metadata.get("tags", []):
            cell.source += "".join(f"\n{name} = {value!r}" for name, value in values.items())
            return
    raise ValueError("the notebook has no cell with the tag 'parameters'")


def without_empty_outputs(outputs):
    """The outputs without those of progress displays, which are empty when the run is over."""
    return [o for o in outputs if o.get("data", {}).get("text/html") != ""]


def run_and_keep(name):
    import nbformat

    notebook = nbformat.read(file_of(name), as_version=4)
    execute(notebook)
    for cell in notebook.cells:
        if cell.cell_type == "code":
            cell.outputs = without_empty_outputs(cell.outputs)
            cell.metadata.pop("execution", None)
    # The version of the interpreter that ran a notebook is no part of it.
    notebook.metadata = {
        "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
        "language_info": {"name": "python"},
    }
    text = json.dumps(notebook, indent=1, ensure_ascii=False, sort_keys=True)
    file_of(name).write_text(text + "\n", encoding="utf-8")
    print(f"{name}: {len(text) / 1e6:.2f} MB")


if __name__ == "__main__":
    for chosen in sys.argv[1:] or ALL:
        run_and_keep(chosen)
