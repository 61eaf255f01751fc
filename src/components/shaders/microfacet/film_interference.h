#pragma once
// Interference in one thin film (Born & Wolf 1999, Principles of Optics, section 1.6.4).

#include <complex>

#include "etendue/core/math.h"

namespace etendue {

/// Reflectance and transmittance of a boundary coated with one film, for unpolarized light. What a conductor transmits is
/// absorbed in it.
struct FilmFractions {
  float reflected = 0, transmitted = 0;
};

// Light reflected at the film's front and light reflected any number of times inside it add up in amplitude. With r01 and r12
// Fresnel's amplitude coefficients at both faces, and 2 beta = 4 pi n1 d cos(theta1) / lambda the phase lag of each round trip,
//     r = (r01 + r12 e^(2 i beta)) / (1 + r01 r12 e^(2 i beta)),   t = t01 t12 e^(i beta) / (1 + r01 r12 e^(2 i beta))
// (eqs. 55 to 57; Airy's sum), for each polarization. The reflectance is R = |r|^2. The transmittance contains the ratio of the
// power that a unit of amplitude carries across the face: T = |t|^2 Re(n2 cos2) / (n0 cos0) for s, |t|^2 Re(n2* cos2) / (n0
// cos0) for p. Cosines follow from Snell's law for complex numbers, so the same formulas cover total reflection, and light that
// tunnels through a film in which it cannot propagate (frustrated total reflection). The time dependence is e^(-i w t): a
// conductor's index is n + i k, and waves decay where the imaginary part of n cos is positive.
namespace film {

using Complex = std::complex<float>;

/// The product without std::complex's handling of infinities, which costs more than the rest.
inline Complex times(Complex a, Complex b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}
inline Complex over(Complex a, Complex b) { return times(a, std::conj(b)) / std::norm(b); }
/// The square root with Im >= 0; if it is real, the positive one.
inline Complex root(Complex z) {
  const float m = std::sqrt(std::norm(z)), a = z.real();
  if (!(m > 0)) return 0;
  if (a >= 0) {
    const float re = std::sqrt((m + a) / 2), im = z.imag() / (2 * re);
    return im < 0 ? Complex(-re, -im) : Complex(re, im);
  }
  const float im = std::sqrt((m - a) / 2);
  return {z.imag() / (2 * im), im};
}

}  // namespace film

/// `cosine` > 0 is that of the angle of incidence in the medium of index n0. The film has index n1 and thickness d, in
/// wavelengths in vacuum; the base has index n2, complex if it is a conductor.
inline FilmFractions film_fractions(float cosine, float n0, float n1, std::complex<float> n2, float d) {
  using namespace film;
  const float c0 = clamp(cosine, 1e-4f, 1), a2 = square(n0) * (1 - c0) * (1 + c0);  // (n0 sin0)^2
  // q = n cos, the relative wave number perpendicular to the faces: q^2 = n^2 - (n0 sin0)^2. At the film's critical angle,
  // where light would travel along the film, r01 = -r12 = 1 and all sums are 0 / 0: |q1^2| is kept slightly above 0.
  const float q0 = n0 * c0, e1 = square(n1), e1_a2 = std::copysign(std::max(std::abs(e1 - a2), 1e-6f * e1), e1 - a2);
  const Complex q1 = e1_a2 >= 0 ? Complex(std::sqrt(e1_a2), 0) : Complex(0, std::sqrt(-e1_a2));
  const Complex e2 = times(n2, n2), q2 = root(e2 - a2);
  // e^(2 i beta); 1 for no film.
  const float turns = 2 * q1.real() * d, decay = std::exp(-4 * pi * q1.imag() * d);
  const float angle = 2 * pi * (turns - std::floor(turns));
  const Complex lag = decay * Complex(std::cos(angle), std::sin(angle));

  FilmFractions sum;
  // Amplitude coefficients from admittances y: q for s, q / n^2 for p.
  const auto add = [&](float y0, Complex y1, Complex y2) {
    const Complex r01 = over(y0 - y1, y0 + y1), r12 = over(y1 - y2, y1 + y2);
    const Complex bounce = times(r12, lag), denominator = 1.0f + times(r01, bounce);
    const float r = std::norm(over(r01 + bounce, denominator));
    // Squared transmission coefficients of both faces, for the same amplitudes: t = 2 y / (y + y').
    const float t01 = 4 * y0 * y0 / std::norm(y0 + y1), t12 = 4 * std::norm(y1) / std::norm(y1 + y2);
    sum.reflected += 0.5f * std::min(r, 1.0f);
    sum.transmitted += 0.5f * t01 * t12 * decay * y2.real() / (y0 * std::norm(denominator));
  };
  add(q0, q1, q2);
  add(q0 / square(n0), q1 / e1, over(q2, e2));
  return sum;
}

/// The amplitudes of the same film, for each polarization, with the time dependence e^(-i w t): of transmitted light up to a
/// factor that both have in common, such that the squares are in proportion to the power.
struct FilmAmplitudes {
  film::Complex reflected_s, reflected_p, transmitted_s, transmitted_p;
};
inline FilmAmplitudes film_amplitudes(float cosine, float n0, float n1, std::complex<float> n2, float d) {
  using film::Complex;
  const float c0 = clamp(cosine, 1e-4f, 1), a2 = square(n0) * (1 - c0) * (1 + c0), q0 = n0 * c0;
  Complex e1 = square(n1), q1 = film::root(e1 - a2), e2 = n2 * n2, q2 = film::root(e2 - a2);
  if (std::norm(q1) < 1e-12f * std::norm(e1)) q1 = 1e-3f * n1;  // at the film's critical angle, where all sums are 0 / 0
  const Complex one_way = std::exp(Complex(0, 2 * pi * d) * q1), lag = one_way * one_way;
  const auto amplitudes = [&](Complex y0, Complex y1, Complex y2, Complex& reflected, Complex& transmitted) {
    const Complex r01 = (y0 - y1) / (y0 + y1), r12 = (y1 - y2) / (y1 + y2), all = 1.0f + r01 * r12 * lag;
    reflected = (r01 + r12 * lag) / all;
    transmitted = 4.0f * y0 * y1 / ((y0 + y1) * (y1 + y2) * all) * std::sqrt(std::max(y2.real() / y0.real(), 0.0f));
  };
  FilmAmplitudes a;
  amplitudes(q0, q1, q2, a.reflected_s, a.transmitted_s);
  amplitudes(q0 / square(n0), q1 / e1, q2 / e2, a.reflected_p, a.transmitted_p);
  return a;
}

}  // namespace etendue
