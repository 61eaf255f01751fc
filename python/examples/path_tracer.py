"""A path tracer in NumPy: the estimator of SimplePathTracer, for all pixels of a picture at once.

    python3 path_tracer.py scenes/cornell_box.etd --samples 16 --picture box.png

The throughput of a path is T_1 = 1, T_{k+1} = T_k f |cos| / p. The light that comes to its vertex x_k straight from luminaires is found
by sampling a point on one, with the pdf p_l [1/sr] as seen from x_k:
    direct(x_k) = f |cos| L_e V / p_l,    V = 1 if nothing lies between, else 0.
The path hits the same emitters itself, and their light must not be added twice. So L_e(x_k) is added at the first vertex alone, and
after specular scattering, where next event estimation finds nothing:
    L = sum over k of T_k ( [k = 1 or specular] L_e(x_k) + direct(x_k) ).
"""

import argparse

import numpy as np

import etendue


def radiance(scene, rays, wavelengths, random, max_depth):
    """An estimate of the radiance along each ray, shape (N, 8) [W m^-2 sr^-1 nm^-1]. Drops wavelengths where light disperses."""
    L = np.zeros(wavelengths.nm.shape)
    T = np.ones(wavelengths.nm.shape)
    path = np.arange(len(L))  # the rows of the paths that go on
    specular = np.ones(len(L), bool)  # the last scattering; the camera counts as a specular one
    for length in range(1, max_depth + 1):
        x = scene.nearest(rays)
        emitted = scene.emitted(x, wavelengths)
        L[path] += np.where(specular[:, None], T * emitted, 0)
        if length == max_depth or not len(path):
            return L

        out = -rays.direction
        light = scene.sample_light(x, random.random((len(path), 3)), wavelengths)
        f_cos = scene.scatter_evaluate(x, out, light.direction, wavelengths)
        seen = (light.pdf > 0) & f_cos.any(axis=1) & light.radiance.any(axis=1)
        seen[seen] = ~scene.occluded(light.shadow[seen])
        L[path[seen]] += (T * f_cos * light.radiance)[seen] / light.pdf[seen, None]

        next = scene.scatter_sample(x, out, wavelengths, random.random((len(path), 3)))
        T = T * next.weight * wavelengths.drop_secondary(next.dispersive)
        on = (next.pdf > 0) & ~next.subsurface
        specular, path, T = next.specular[on], path[on], T[on]
        wavelengths, rays = wavelengths[on], x[on].leave(next[on])
    return L


def render(job, samples, max_depth, seed=1):
    """The mean colour X, Y, Z of each pixel and its standard error, shape (height, width, 3)."""
    random = np.random.default_rng(seed)
    width, height = job.film_size()
    corners = np.stack(np.meshgrid(np.arange(width), np.arange(height)), axis=-1).reshape(-1, 2)
    total, squares = np.zeros((len(corners), 3)), np.zeros((len(corners), 3))
    for _ in range(samples):
        wavelengths = job.wavelengths.sample(random.random(len(corners)))
        camera = job.sample_rays(corners + random.random(corners.shape), wavelengths, lens=random.random(corners.shape))
        weight = camera.weight * wavelengths.drop_secondary(camera.dispersed)
        L = radiance(job.scene, camera.rays, wavelengths, random, max_depth)
        color = wavelengths.to_xyz(weight * L)
        total += color
        squares += color**2
    mean = total / samples
    error = np.sqrt(np.maximum(squares / samples - mean**2, 0) / max(samples - 1, 1))
    return mean.reshape(height, width, 3), error.reshape(height, width, 3)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene")
    parser.add_argument("--samples", type=int, default=16, help="per pixel")
    parser.add_argument("--picture", default="picture.npy", help="a NumPy file for the linear colours R, G, B")
    given = parser.parse_args()
    job = etendue.load(given.scene)
    xyz, error = render(job, given.samples, job.renderer.max_depth)
    np.save(given.picture, etendue.xyz_to_rgb(xyz).astype(np.float32))
    print(f"mean Y {xyz[..., 1].mean():.6g}, standard error {np.sqrt((error[..., 1] ** 2).sum()) / error[..., 1].size:.2g}")
