#pragma once
// Splitting: where camera walks are split into branches at specular glass, so that several terms of a sum are followed instead
// of one at random.

namespace etendue {

/// A walk is split at surfaces that have no lobes but specular reflection and refraction. There
///     L(lambda) = R L_reflected + (1 - R) L_refracted,
/// is a plain sum of two terms at each of the path's N wavelengths. Both terms may be followed, instead of one at random. Where
/// refraction is dispersive, n of the N wavelengths may be followed, each by a branch whose throughput is N / n times that of
/// its wavelength, instead of the hero alone with N times its own: each wavelength has the distribution of the hero (Wilkie et
/// al. 2014, "Hero wavelength spectral sampling"), so the mean over N estimates the same integral.
///
/// Branches of different wavelengths use the same primary samples. Their paths stay close to each other and gather nearly the
/// same amount of light, so the light has the colour of the n wavelengths together, not of one; noise in colour comes from the
/// points where the branches diverge. docs/decisions/004 measures it.
struct Splitting {
  int reflect_and_refract = 0;  ///< how often a walk that has met only such surfaces is split into reflection and refraction
  int wavelengths = 1;          ///< n; 1: the hero alone (Wavelengths::drop_secondary)
};

}  // namespace etendue
