#!/usr/bin/env python3
"""Makes files of measured materials from a model that is known exactly, to test readers with.

    tools/make_measured_files.py FOLDER

writes ggx.binary (MERL), ggx_isotropic.bsdf, ggx_anisotropic.bsdf (RGL, spectral) and ggx_rgb.bsdf (RGL, linear sRGB). All
hold rough conductors: GGX normals, Smith's shadowing with correlated heights, Schlick's Fresnel reflectance

    f(a, b) = D(m) G(a, b) F(a . m) / (4 cos(a) cos(b)),     F(c) = F0 + (1 - F0) (1 - c)^5,

with F0 = (0.9, 0.6, 0.3) in the colours and F0 = 0.3 + 0.6 (lambda - 360 nm) / 470 nm in the spectra. Needs NumPy.
"""
import pathlib
import struct
import sys

import numpy as np

COLOR = np.array([0.9, 0.6, 0.3])
WAVELENGTHS = np.linspace(360, 830, 48)
SPECTRUM = 0.3 + 0.6 * (WAVELENGTHS - 360) / 470


def spherical(theta, phi):
    theta, phi = np.broadcast_arrays(theta, phi)
    return np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], -1)


def dot(a, b):
    return np.sum(a * b, -1)


class Ggx:
    """Roughness along x and along y (Heitz 2014, "Understanding the masking-shadowing function")."""

    def __init__(self, x, y):
        self.roughness = np.array([x, y, 1.0])

    def normals(self, m):
        """D(m) [1/sr]"""
        ax, ay, _ = self.roughness
        return np.where(m[..., 2] > 0, 1 / (np.pi * ax * ay * dot(m / self.roughness, m / self.roughness) ** 2), 0)

    def area(self, w):
        """Projected area of the microsurface, cos (1 + Lambda), as seen from w."""
        stretched = w * self.roughness
        return (w[..., 2] + np.sqrt(dot(stretched, stretched))) / 2

    def value(self, a, b, f0):
        """f [1/sr], with an axis for f0 behind the others."""
        m = a + b
        m = m / np.linalg.norm(m, axis=-1, keepdims=True)
        return self.normals(m)[..., None] * self.rest(a, b, m, f0) / (4 * self.area(a)[..., None])

    def rest(self, a, b, m, f0):
        """4 f sigma(a) / D(m): finite even where b is at the horizon. With A = sigma / cos - 1 = Lambda,
        G = 1 / (1 + Lambda(a) + Lambda(b)) makes it F sigma(a) / (cos(a) cos(b) (1 + Lambda(a) + Lambda(b)))."""
        ca, cb = a[..., 2], np.maximum(b[..., 2], 1e-6)
        b = np.concatenate([b[..., :2], cb[..., None]], -1)
        shape = self.area(a) / (self.area(a) * cb + self.area(b) * ca - ca * cb)
        fresnel = f0 + (1 - f0) * ((1 - np.clip(dot(a, m), 0, 1)) ** 5)[..., None]
        return shape[..., None] * fresnel


# ---- MERL -----------------------------------------------------------------------------------------------------------


def write_merl(path, model, cells=(90, 90, 180)):
    n_h, n_d, n_p = cells
    theta_h = np.pi / 2 * ((np.arange(n_h) + 0.5) / n_h) ** 2
    theta_d = np.pi / 2 * (np.arange(n_d) + 0.5) / n_d
    phi_d = np.pi * (np.arange(n_p) + 0.5) / n_p
    h, d, p = np.meshgrid(theta_h, theta_d, phi_d, indexing="ij")
    across, along = spherical(d, p), np.stack([np.cos(h), np.zeros_like(h), np.sin(h)], -1)

    def around_half(v):  # from the frame of the half vector to that of the surface: turned about y by theta_h
        cos, sin = along[..., 0], along[..., 2]
        return np.stack([cos * v[..., 0] + sin * v[..., 2], v[..., 1], cos * v[..., 2] - sin * v[..., 0]], -1)

    a, b = around_half(across), around_half(across * np.array([-1, -1, 1]))
    visible = (a[..., 2] > 0) & (b[..., 2] > 0)
    safe = np.array([0, 0, 1.0])
    f = model.value(np.where(visible[..., None], a, safe), np.where(visible[..., None], b, safe), COLOR)
    with open(path, "wb") as file:
        file.write(struct.pack("<3i", n_h, n_d, n_p))
        for channel, scale in enumerate((1 / 1500, 1.15 / 1500, 1.66 / 1500)):
            file.write(np.where(visible, f[..., channel] / scale, -1).astype("<f8").tobytes())


# ---- RGL ------------------------------------------------------------------------------------------------------------

TYPES = {np.dtype(np.uint8): 1, np.dtype(np.float32): 10}


def write_tensors(path, fields):
    arrays = {name: np.ascontiguousarray(value) for name, value in fields.items()}
    size = 18 + sum(2 + len(n) + 2 + 1 + 8 + 8 * a.ndim for n, a in arrays.items())
    header, body = struct.pack("<12sBBI", b"tensor_file\0", 1, 0, len(arrays)), b""
    for name, a in arrays.items():
        body += b"\0" * (-(size + len(body)) % 8)
        header += struct.pack(f"<H{len(name)}sHBQ{a.ndim}Q", len(name), name.encode(), a.ndim, TYPES[a.dtype],
                              size + len(body), *a.shape)
        body += a.tobytes()
    pathlib.Path(path).write_bytes(header + body)


def solve(integral, a, b):
    """t up to which a function that goes linearly from a to b has an integral."""
    divisor = a + np.sqrt(np.maximum(a * a + 2 * integral * (b - a), 0))
    return np.clip(np.where(divisor > 0, 2 * integral / np.where(divisor > 0, divisor, 1), 0), 0, 1)


def warp(values, s):
    """Points s = (x, y) warped to the density of a table, bilinear between its points; and the density there."""
    h, w = values.shape
    left = np.concatenate([np.zeros((h, 1)), np.cumsum((values[:, 1:] + values[:, :-1]) / 2, 1)], 1) / (w - 1)
    below = np.concatenate([[0], np.cumsum((left[1:, -1] + left[:-1, -1]) / 2)]) / (h - 1)
    values, left, below = values / below[-1], left / below[-1], below / below[-1]
    row = np.clip(np.searchsorted(below, s[..., 1], "right") - 1, 0, h - 2)
    t = solve((s[..., 1] - below[row]) * (h - 1), left[row, -1], left[row + 1, -1])
    sums = left[row] * (1 - t[..., None]) + left[row + 1] * t[..., None]
    wanted = s[..., 0] * sums[..., -1]
    column = np.clip(np.sum(sums <= wanted[..., None], -1) - 1, 0, w - 2)

    def between(table, k):
        return table[row, k] * (1 - t) + table[row + 1, k] * t

    v0, v1 = between(values, column), between(values, column + 1)
    x = solve((wanted - between(left, column)) * (w - 1), v0, v1)
    return np.stack([(column + x) / (w - 1), (row + t) / (h - 1)], -1), v0 * (1 - x) + v1 * x


def unit_grid(width, height):
    return np.stack(np.meshgrid(np.linspace(0, 1, width), np.linspace(0, 1, height)), -1)


def write_rgl(path, model, phi_i, theta_i, vndf_size, size, f0, wavelengths=None):
    """Tables of vndf_size = (height, width) and size x size. The spectra are 4 f cos(b) sigma(a) / D(m)."""
    isotropic = len(phi_i) == 1
    height, width = vndf_size
    u = unit_grid(width, height)
    theta_m, phi_m = np.pi / 2 * u[..., 0] ** 2, (2 * u[..., 1] - 1) * np.pi
    stretch = 2 * np.pi ** 2 * u[..., 0] * np.sin(theta_m)
    vndf = np.zeros((len(phi_i), len(theta_i), height, width))
    luminance = np.zeros((len(phi_i), len(theta_i), size, size))
    spectra = np.zeros((len(phi_i), len(theta_i), len(f0), size, size))
    for i, phi in enumerate(phi_i):
        for k, theta in enumerate(theta_i):
            a = spherical(theta, phi)
            turn = phi if isotropic else 0
            m = spherical(theta_m, phi_m + turn)
            vndf[i, k] = model.normals(m) * np.maximum(dot(a, m), 0) / model.area(a) * stretch
            at, density = warp(vndf[i, k], unit_grid(size, size))
            m = spherical(np.pi / 2 * at[..., 0] ** 2, (2 * at[..., 1] - 1) * np.pi + turn)
            b = 2 * dot(a, m)[..., None] * m - a
            a_all = np.broadcast_to(a, b.shape)
            rest = model.rest(a_all, b, m, f0)
            spectra[i, k] = np.moveaxis(rest * np.maximum(b[..., 2], 0)[..., None], -1, 0)
            luminance[i, k] = np.mean(spectra[i, k], 0)
    u_i = unit_grid(64, 64) if not isotropic else unit_grid(256, 2)
    theta, phi = np.pi / 2 * u_i[..., 0] ** 2, (2 * u_i[..., 1] - 1) * np.pi
    fields = {
        "description": np.frombuffer(b"A rough conductor, computed", dtype=np.uint8),
        "jacobian": np.array([1], dtype=np.uint8),
        "phi_i": phi_i.astype(np.float32),
        "theta_i": theta_i.astype(np.float32),
        "ndf": model.normals(spherical(theta, phi)).astype(np.float32),
        "sigma": model.area(spherical(theta, phi)).astype(np.float32),
        "vndf": vndf.astype(np.float32),
        "luminance": luminance.astype(np.float32),
    }
    if wavelengths is None:
        fields["rgb"] = spectra.astype(np.float32)
    else:
        fields["wavelengths"] = wavelengths.astype(np.float32)
        fields["spectra"] = spectra.astype(np.float32)
    write_tensors(path, fields)


def main(folder):
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    theta = np.linspace(0, np.pi / 2 * 0.97, 24)
    quarter = np.linspace(-np.pi, -np.pi / 2, 9)
    write_merl(folder / "ggx.binary", Ggx(0.3, 0.3))
    write_rgl(folder / "ggx_isotropic.bsdf", Ggx(0.3, 0.3), np.array([0.0]), theta, (64, 64), 32, SPECTRUM, WAVELENGTHS)
    write_rgl(folder / "ggx_anisotropic.bsdf", Ggx(0.15, 0.45), quarter, theta[::2], (64, 48), 24, SPECTRUM[::3], WAVELENGTHS[::3])
    write_rgl(folder / "ggx_rgb.bsdf", Ggx(0.3, 0.3), np.array([0.0]), theta, (64, 64), 32, COLOR)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
