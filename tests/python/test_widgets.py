"""Widgets: self-contained HTML of the right pictures, and what a notebook shows of a running render."""

import base64
import html.parser
import io
import re
import sys
import types

import numpy as np
import pytest

import etendue
from etendue import _progress, _widgets

RENDERED = """
Job {
    renderer: PathTracer { samples: 4, max_depth: 3 }
    camera: PerspectiveCamera { from: [0, 0, -5] m, to: [0, 0, 0] m, fov: 40 deg }
    image: ImageBuffer { width: 16, height: 12, filter: BoxFilter {} }
    scene: BvhScene { objects: [
        Sphere { shader: Lambertian { color: 0.5 } }
        Sphere { centre: [0, 3, 0] m, radius: 0.5 m, emission: DiffuseEmission { radiance: 5 } }
    ] }
}
"""


@pytest.fixture(scope="module")
def image():
    return etendue.render(etendue.loads(RENDERED))


class Checked(html.parser.HTMLParser):
    """Refuses wrongly nested elements and references to other files."""

    empty = {"img", "input", "br", "meta"}

    def __init__(self, text):
        super().__init__()
        self.open, self.images, self.text = [], [], ""
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attributes):
        if tag not in self.empty:
            self.open.append(tag)
        for name, value in attributes:
            if name in ("src", "href"):
                assert value.startswith("data:image/png;base64,")
                self.images.append(base64.b64decode(value.partition(",")[2]))

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if "style" not in self.open:
            self.text += data


def pixels_of(png):
    return np.asarray(pytest.importorskip("PIL.Image").open(io.BytesIO(png)))


def test_show(image):
    widget = etendue.show(image, title="a <title>")
    page = Checked(widget._repr_html_())
    assert "a <title>" in page.text and len(page.images) == 9
    means = [pixels_of(png).mean() for png in page.images]
    assert means == sorted(means) and means[0] < means[8]
    assert (pixels_of(page.images[4]) == image.to_uint8()).all(), "the middle is the picture itself"
    assert len(Checked(etendue.show(image, exposure=False)._repr_html_()).images) == 1
    assert "http" not in widget._repr_html_() and "title" in repr(widget)
    # A picture without a tone map is exposed by its values.
    plain = etendue.Image.from_array(np.full((4, 4), 0.1))
    shown = Checked(etendue.show(plain)._repr_html_())
    assert (pixels_of(shown.images[6]) == etendue.Image.from_array(np.full((4, 4), 0.4)).to_uint8()).all()
    # Two widgets on one page do not share their names.
    assert len(set(re.findall(r'id="([^"]+)"', widget._repr_html_() + etendue.show(image)._repr_html_()))) == 2


def test_save(image, tmp_path):
    file = tmp_path / "page.html"
    etendue.show(image).save(file)
    text = file.read_text()
    assert text.startswith("<!DOCTYPE html>") and 'content="light dark"' in text


def test_side_by_side(image, tmp_path):
    brighter = image.with_pixels(4 * image.pixels)
    page = Checked(etendue.side_by_side(image, brighter, labels=["<left>", "right"])._repr_html_())
    assert "<left>" in page.text and len(page.images) == 2
    left, right = map(pixels_of, page.images)
    # Both have the exposure of the first one: an automatic exposure would hide the difference.
    assert np.abs(left.astype(int) - image.to_uint8().astype(int)).max() <= 1
    assert right.mean() > 1.3 * left.mean()
    image.save(tmp_path / "b.npy")
    three = Checked(etendue.side_by_side(image, brighter, tmp_path / "b.npy")._repr_html_())
    assert len(three.images) == 5 and "b.npy" in three.text
    with pytest.raises(etendue.Error, match="differ in size"):
        etendue.side_by_side(image, etendue.Image.from_array(np.ones((2, 2))))
    with pytest.raises(etendue.Error, match="at least two"):
        etendue.side_by_side(image)
    with pytest.raises(etendue.Error, match="1 labels"):
        etendue.side_by_side(image, image, labels=["a"])


def test_difference(image):
    b = etendue.Image.from_array(np.full((8, 8), 1.0))
    values = np.full((8, 8), 1.0)
    values[0, 0], values[0, 1] = 1.5, 0.5
    a = etendue.Image.from_array(values)
    page = Checked(etendue.difference(a, b, limit=0.5, relative=False)._repr_html_())
    shown = pixels_of(page.images[0])
    ends = np.floor(255 * _widgets._DIVERGING + 0.5)
    assert (shown[0, 0] == ends[4]).all() and (shown[0, 1] == ends[0]).all() and (shown[1:] == ends[2]).all()
    assert "+0.5" in page.text and "−0.25" in page.text and "root mean square error" in page.text
    relative = Checked(etendue.difference(a, b)._repr_html_()).text
    assert "+50 %" in relative and "relative difference of luminance, a − b" in relative
    tiles = pixels_of(Checked(etendue.difference(a, b, tile=3, relative=False, limit=1)._repr_html_()).images[0])
    assert tiles.shape == (8, 8, 3) and (tiles[:3, :3] == tiles[0, 0]).all()
    equal = Checked(etendue.difference(image, image)._repr_html_()).text
    assert "all values are equal" in equal
    bad = etendue.Image.from_array(np.where(values == 1.5, np.nan, values), allow_not_finite=True)
    page = Checked(etendue.difference(bad, b)._repr_html_())
    assert (pixels_of(page.images[0])[0, 0] == [255, 0, 255]).all() and "not finite" in page.text
    with pytest.raises(etendue.Error, match="limit"):
        etendue.difference(a, b, limit=0)
    with pytest.raises(etendue.Error, match="differ in size"):
        etendue.difference(a, image)


def test_a_notebook_shows_the_picture_so_far(monkeypatch):
    shown = []
    ipython = types.ModuleType("IPython")
    ipython.get_ipython = lambda: types.SimpleNamespace(kernel=object())
    ipython.display = types.ModuleType("IPython.display")

    class Handle:
        def update(self, content):
            shown.append(content)

    ipython.display.HTML = lambda text: text
    ipython.display.display = lambda content, display_id: shown.append(content) or Handle()
    monkeypatch.setitem(sys.modules, "IPython", ipython)
    monkeypatch.setitem(sys.modules, "IPython.display", ipython.display)
    assert _progress.in_notebook()
    job = etendue.loads(RENDERED)
    with etendue.Render(job) as render:
        render.run(seconds=1.2)
        assert len(shown) >= 2 and shown[-1] == ""
        page = Checked(shown[0])
        assert len(page.images) == 1 and "samples" in page.text
        count = len(shown)
        render.run(seconds=0.3, progress=False)
        assert len(shown) == count
    monkeypatch.setitem(sys.modules, "IPython", None)
    assert not _progress.in_notebook()
