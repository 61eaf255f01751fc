"""A scene as code: a red ball on a grey floor under a bright sky. Writes first_picture.png.

    ./etendue python python/examples/first_picture.py
"""

import etendue

ball = etendue.Sphere(radius=1, centre=(0, 0, 1), shader=etendue.Lambertian(color=etendue.rgb(0.8, 0.1, 0.05)))
floor = etendue.Rectangle(
    corner=(-10, -10, 0), edge_u=(20, 0, 0), edge_v=(0, 20, 0), shader=etendue.Lambertian(color=0.5)
)
sky = etendue.Environment(emission=etendue.DiffuseEmission(radiance=1))

job = etendue.Job(
    renderer=etendue.PathTracer(samples=64),
    camera=etendue.PerspectiveCamera(from_=(0, -6, 2), to=(0, 0, 0.8), fov="35 deg"),
    scene=etendue.BvhScene(objects=[ball, floor, sky]),
    image=etendue.ImageBuffer(width=320, height=240),
)

if __name__ == "__main__":
    etendue.render(job).save("first_picture.png")
