"""Questions about parts that are being rendered, and about parts that are written in Python."""

import threading

import numpy as np
import pytest

import etendue

NM = [450, 550, 650]


def job_of(ball):
    scene = etendue.BvhScene(objects=[ball, etendue.Environment(emission=etendue.DiffuseEmission(radiance=1))])
    camera = etendue.PerspectiveCamera(**{"from": (0, 0, -5), "to": (0, 0, 0)})
    return etendue.Job(scene=scene, camera=camera, image=etendue.ImageBuffer(width=16, height=16))


def test_questions_while_a_render_lives():
    ball = etendue.Sphere(shader=etendue.Lambertian(color=0.5))
    job = job_of(ball)
    expected = np.asarray(etendue.render(etendue.copy(job), samples=4).xyz())
    with etendue.Render(job) as render:
        assert job.scene.nearest([0, 0, -3], [0, 0, 1]).distance == pytest.approx(2)
        render.edit({"scene.objects[0].radius": 0.5})
        assert job.scene.nearest([0, 0, -3], [0, 0, 1]).distance == pytest.approx(2.5)
        ball.radius = 1
        assert job.scene.nearest([0, 0, -3], [0, 0, 1]).distance == pytest.approx(2)
        render.run(samples=4)
        assert np.array_equal(np.asarray(render.snapshot().xyz()), expected)  # what was asked did not touch what is rendered


def test_questions_beside_a_run_and_its_edits():
    ball = etendue.Sphere(shader=etendue.Lambertian(color=0.5))
    job = job_of(ball)
    wrong = []
    with etendue.Render(job) as render:
        runner = threading.Thread(target=lambda: render.run(seconds=1.5))
        runner.start()
        for i in range(20):
            ball.radius = 0.5 + 0.5 * (i % 2)
            distance = job.scene.nearest([0, 0, -3], [0, 0, 1]).distance[0]
            if abs(distance - (3 - ball.radius)) > 1e-5:
                wrong.append((i, distance))
        render.stop()
        runner.join()
    assert not wrong


class QuestionStripes(etendue.ObjectMap):
    """Stripes, with a table that the object keeps for itself."""

    count: float = etendue.member(8, range=(0, None), text="pairs of stripes over u")

    def __init__(self, **members):
        super().__init__(**members)
        self._values = (0.25, 0.75)

    def scalar(self, point):
        return self._values[int(self.count * point.uv[0] * 2) % 2]


def test_a_map_in_python_is_asked_by_the_function_of_its_interface():
    stripes = QuestionStripes(count=2)
    uv = [[0.1, 0], [0.3, 0], [0.6, 0]]
    assert etendue.ObjectMap.scalar(stripes, uv).tolist() == [0.25, 0.75, 0.25]
    shader = etendue.Lambertian(color=stripes)
    assert np.allclose(shader.albedo(uv, [0, 0, 1], NM)[:, 1], [0.25, 0.75, 0.25])
    stripes.count = 1
    assert etendue.ObjectMap.scalar(stripes, uv).tolist() == [0.25, 0.25, 0.75]


def test_a_member_in_python_cannot_have_the_name_of_a_question():
    with pytest.raises(etendue.Error, match="cannot have the name of a question"):

        class QuestionClash(etendue.Shader):
            """A shader with a member that hides a question."""

            albedo: float = etendue.member(1.0, text="no good name")

            def evaluate(self, point, wavelengths, out, incident, lobes):
                return 0.0
