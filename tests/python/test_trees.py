"""Trees of parts that only Python can build: parts of themselves, and very deep ones."""

import pytest

import etendue


def test_no_part_of_itself():
    scene = etendue.BvhScene()
    with pytest.raises(etendue.Error, match="part of itself"):
        scene.objects = [scene]
    inner = etendue.BvhScene(objects=[etendue.Sphere()])
    scene.objects = [etendue.Sphere(), inner]
    with pytest.raises(etendue.Error, match="part of itself"):
        inner.objects.append(etendue.Instance(scene=scene))
    assert len(inner.objects) == 1


def test_a_long_list_grows_quickly():
    scene = etendue.BvhScene()
    for _ in range(300):
        scene.objects.append(etendue.Sphere())
    assert len(scene.objects) == 300


def deep(levels, downwards):
    top = at = etendue.BumpShader(shader=etendue.Lambertian())
    for _ in range(levels):
        if downwards:
            inner = etendue.BumpShader(shader=etendue.Lambertian())
            at.shader = inner
            at = inner
        else:
            top = etendue.BumpShader(shader=top)
    return top


@pytest.mark.parametrize("downwards", [True, False])
def test_deep_trees_are_refused_and_dropped(downwards):
    top = deep(100_000 if downwards else 3000, downwards)
    for use in (etendue.dumps, etendue.copy, lambda t: etendue.equal(t, t), etendue.to_dict):
        with pytest.raises((etendue.Error, RecursionError)):
            use(top)
    del top  # without recursion: a hundred thousand destructors within one another would overflow the stack
