"""Parts written in Python are freed when nothing refers to them, and live as long as anything does."""

import gc
import resource
import weakref

import etendue
from etendue import member


class Leaf(etendue.ObjectMap):
    """A map."""

    level: float = member(0.5, text="the value")

    def scalar(self, point):
        return self.level


class Branch(etendue.ObjectMap):
    """A map of maps."""

    inner: etendue.ObjectMap = member(0.5, text="another map")
    more: list[etendue.ObjectMap] = member(text="more maps")

    def scalar(self, point):
        return point.scalar(self.inner)


def job_of(shader):
    """A job in which a shader is used twice."""
    return etendue.Job(
        camera=etendue.PerspectiveCamera(),
        scene=etendue.BvhScene(objects=[etendue.Sphere(shader=shader), etendue.Rectangle(shader=shader)]),
    )


def freed(part):
    seen = weakref.ref(part)
    del part
    return seen


def collected(seen):
    for _ in range(3):
        gc.collect()
    return seen() is None


def test_a_part_alone_is_freed():
    seen = weakref.ref(Leaf())
    assert collected(seen)


def test_a_part_that_the_library_uses_is_kept():
    shader = etendue.Lambertian(color=Leaf(level=0.25))
    gc.collect()
    assert type(shader.color) is Leaf and shader.color.level == 0.25
    shader.color._note = "mine"
    gc.collect()
    assert shader.color._note == "mine"
    seen = weakref.ref(shader.color)
    gc.collect()
    assert seen() is not None
    shader.color = 0.5
    assert collected(seen)


def test_a_part_goes_with_its_owner():
    shader = etendue.Lambertian(color=Leaf())
    seen = weakref.ref(shader.color)
    del shader
    assert collected(seen)


def test_a_part_that_keeps_its_job_is_freed_with_it():
    leaf = Leaf()
    job = job_of(etendue.Lambertian(color=leaf))
    leaf._job = job
    seen, job_seen = weakref.ref(leaf), weakref.ref(job)
    del leaf
    gc.collect()
    assert seen() is not None
    assert job["scene.objects[0].shader.color"] is seen()
    del job
    assert collected(seen) and collected(job_seen)


def test_a_kept_part_keeps_its_job():
    leaf = Leaf()
    leaf._job = job_of(etendue.Lambertian(color=leaf))
    for _ in range(3):
        gc.collect()
    assert leaf._job["scene.objects[1].shader.color"] is leaf
    seen = weakref.ref(leaf)
    del leaf
    assert collected(seen)


def test_parts_within_parts():
    outer = Branch(inner=Branch(inner=Leaf(), more=[Leaf(), 0.5]))
    seen = [weakref.ref(p) for p in (outer, outer.inner, outer.inner.inner, outer.inner.more[0])]
    for _ in range(3):
        gc.collect()
    assert all(s() is not None for s in seen)
    inner = outer.inner
    del outer
    assert collected(seen[0])
    assert inner.inner is seen[2]() and all(s() is not None for s in seen[1:])
    inner.inner._top = inner
    del inner
    assert all(collected(s) for s in seen)


def test_a_part_of_two_owners():
    leaf = Leaf()
    seen = weakref.ref(leaf)
    a, b = Branch(inner=leaf), Branch(inner=leaf)
    del leaf
    gc.collect()
    del a
    gc.collect()
    assert b.inner is seen()
    del b
    assert collected(seen)


def test_an_owner_that_is_gone_while_the_part_is_held_by_python():
    leaf = Leaf()
    job = job_of(etendue.Lambertian(color=leaf))
    holder = [job]
    holder.append(holder)  # a cycle that the collector must find
    del job, holder
    for _ in range(3):
        gc.collect()
    assert leaf.level == 0.5 and etendue.dumps(leaf) == "Leaf {}\n"


def test_a_part_below_a_component_that_python_holds():
    shader = etendue.Lambertian(color=Leaf())
    shader.color._note = "mine"
    holder = [job_of(shader)]
    holder.append(holder)
    del holder  # the job is garbage, and its shader is not
    for _ in range(3):
        gc.collect()
    assert shader.color._note == "mine"
    seen = weakref.ref(shader.color)
    del shader
    assert collected(seen)


def test_redefined_classes_and_their_objects():
    def define():
        class Passing(etendue.ObjectMap):
            """A map."""

            def scalar(self, point):
                return 1

        return weakref.ref(Passing())

    seen = [define() for _ in range(5)]
    assert all(collected(s) for s in seen)


def test_a_hundred_thousand_parts_take_no_memory():
    def some(count):
        for i in range(count):
            etendue.Lambertian(color=Branch(inner=Leaf()))

    some(2000)
    gc.collect()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    some(50_000)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 20_000  # kB
    for _ in range(3):  # a part within a part is freed one collection later
        gc.collect()
    assert sum(type(o) is Leaf for o in gc.get_objects()) == 0
