"""A render over four processes of which one is killed every few seconds, for some minutes."""

import threading

import clusters

import etendue


def test_one_is_killed_every_three_seconds(tmp_path):
    import etendue.distributed

    job = etendue.load(clusters.write_scene(tmp_path / "scene"))
    with etendue.Render(job) as render:
        job.renderer.samples = 150 * render.samples_per_step + 7
    expected = etendue.render(job)
    cluster, client = clusters.start(tmp_path / "workers")
    over = threading.Event()
    kills = []

    def kill():
        while not over.wait(3):
            kills.append(clusters.kill_a_worker(cluster))

    killer = threading.Thread(target=kill)
    killer.start()
    try:
        picture = etendue.distributed.render(job, client, part_seconds=1)
    finally:
        over.set()
        killer.join()
        client.close()
        cluster.close(timeout=60)
    assert sum(kills) >= 5
    assert clusters.same(picture, expected)
