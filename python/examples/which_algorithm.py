"""Which algorithm has the smaller error on a scene at equal time, and do they agree at all?

    ./etendue python python/examples/which_algorithm.py [SCENE]
"""

import sys

import etendue


def main(scene: str) -> None:
    job = etendue.load(scene)
    job.image.width, job.image.height = 64, 64
    renderers: list[etendue.Part] = [
        etendue.PathTracer(),
        etendue.PathTracer(next_event=False),
        etendue.BidirectionalPathTracer(),
    ]
    print(etendue.verify(job, renderers, samples=256))

    errors = etendue.compare(job, renderers, time=2, runs=4)
    print(errors)
    for row in errors:
        error = row.at_equal_time.relative_mean_square_error
        if error is not None:
            print(row.name, error.value, error.band)


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "scenes/cornell_box.etd")
