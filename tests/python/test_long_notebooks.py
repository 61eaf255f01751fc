"""The notebooks of docs/notebooks that take up to minutes, as they are. What they assert is checked on the way."""

import pytest
from notebooks import run


@pytest.mark.parametrize("name", ["a-bsdf-under-the-microscope", "a-path-tracer-of-ones-own", "an-animation", "which-algorithm"])
def test_notebook(name):
    run(name)
