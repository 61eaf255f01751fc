"""The notebooks of docs/notebooks: the kept files are whole, and the quick ones run, with less work than in the kept files."""

import json

import pytest
from notebooks import ROOT, run, run_notebooks


@pytest.mark.parametrize("name", run_notebooks.ALL)
def test_the_kept_file_is_whole(name):
    file = run_notebooks.file_of(name)
    assert file.stat().st_size < 1.5e6
    text = file.read_text(encoding="utf-8")
    assert "/tmp/" not in text and str(ROOT) not in text, "a path of the machine that ran it"
    notebook = json.loads(text)
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    assert [cell["execution_count"] for cell in cells] == list(range(1, len(cells) + 1)), "cells were not run once, in order"
    outputs = [output for cell in cells for output in cell["outputs"]]
    assert any("image/png" in output.get("data", {}) for output in outputs)
    assert not [o for o in outputs if o["output_type"] == "error" or o.get("name") == "stderr"]


def test_every_notebook_is_listed():
    page = (ROOT / "docs" / "notebooks.md").read_text(encoding="utf-8")
    assert len(run_notebooks.ALL) >= 6
    for name in run_notebooks.ALL:
        assert f"(notebooks/{name}.ipynb)" in page


def test_first_picture():
    run("first-picture", samples=1, counts=[1, 2])


def test_a_lens():
    run("a-lens", samples=1, rays=500)


def test_a_mistake_in_a_notebook_fails():
    nbclient = pytest.importorskip("nbclient")
    nbformat = pytest.importorskip("nbformat")
    pytest.importorskip("ipykernel")
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell("import etendue; etendue.Sphere(radius=-1)")])
    with pytest.raises(nbclient.exceptions.CellExecutionError, match="radius must be more than 0"):
        run_notebooks.execute(notebook)
