"""The notebooks of docs/notebooks that take up to minutes, as they are. What they assert is checked on the way."""

import pytest
from notebooks import run


LONG = ["a-bsdf-under-the-microscope", "a-path-tracer-of-ones-own", "an-animation", "which-algorithm"]


@pytest.mark.parametrize("name", LONG)
def test_notebook(name):
    run(name)
