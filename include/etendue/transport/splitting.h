#pragma once
// How camera walks are divided at perfectly smooth glass.

namespace etendue {

/// Where a walk is divided into branches, at surfaces that do nothing but reflect and refract without blur. There
///     L(lambda) = R L_reflected + (1 - R) L_refracted,
/// each term at each of the path's N wavelengths, is a plain sum. Both terms may be followed, instead of one by chance. Where
/// refraction sends every wavelength its own way, n of the N may be followed, each by a branch whose throughput is N / n times
/// the wavelength's, instead of the hero alone with N times its own: each wavelength has the hero's distribution (Wilkie et al.
/// 2014, "Hero wavelength spectral sampling"), so the mean over N estimates the same.
///
/// Branches of wavelengths take the same numbers. So they stay near each other and bring nearly the same amount of light, and
/// its colour is that of the n together, not of one; what differs is where they part for good. docs/decisions/004 measures it.
struct Splitting {
  int reflect_and_refract = 0;  ///< so many times a walk that met nothing else before is both reflected and refracted
  int wavelengths = 1;          ///< n; 1: the hero alone (Wavelengths::drop_secondary)
};

}  // namespace etendue
