#pragma once
// Fresnel's amplitudes, and the Mueller matrices that follow from them (Collett 2005, Field guide to polarization; Born & Wolf
// 1999, sections 1.5.2 and 14.2).
//
// The reference direction of the light that arrives and of that which leaves is s, the normal of the plane of incidence. With p
// = d x s for either direction of travel d, amplitudes a_s and a_p multiply the field's components, and
//     S0' + S1' = |a_s|^2 (S0 + S1),   S0' - S1' = |a_p|^2 (S0 - S1),   S2' + i S3' = a_p a_s* (S2 + i S3).
// The amplitudes below are those of the time dependence e^(-i w t), for which a conductor's index is n + i k; Stokes vectors
// are defined with e^(i w t) (mueller.h), so the product is that of the conjugates, a_p* a_s.

#include <complex>

#include "etendue/polarizing_scatter.h"

namespace etendue::polarized {

using Complex = std::complex<float>;

struct Amplitudes {
  Complex s, p;
};

/// Sets the matrix of one wavelength, over its first element.
inline void set_mueller(Mueller& m, int lane, float s_power, float p_power, Complex product) {
  const float sum = s_power + p_power, scale = sum > 0 ? 1 / sum : 0;
  m(0, 0).set(lane, 1);
  m(1, 1).set(lane, 1);
  m(0, 1).set(lane, (s_power - p_power) * scale);
  m(1, 0).set(lane, (s_power - p_power) * scale);
  m(2, 2).set(lane, 2 * product.real() * scale);
  m(3, 3).set(lane, 2 * product.real() * scale);
  m(2, 3).set(lane, -2 * product.imag() * scale);
  m(3, 2).set(lane, 2 * product.imag() * scale);
}
inline void set_mueller(Mueller& m, int lane, const Amplitudes& a) {
  set_mueller(m, lane, std::norm(a.s), std::norm(a.p), std::conj(a.p) * a.s);
}

/// Of light that a boundary reflects; `index` behind it over that in front, complex for a conductor. With N = n + i k and
/// q = N cos_t = sqrt(N^2 - sin^2), Im q >= 0:
///     a_s = (cos - q) / (cos + q),   a_p = (N^2 cos - q) / (N^2 cos + q).
/// Under total internal reflection q is imaginary and both have modulus 1, with different phases.
inline Amplitudes reflected(float cosine, Complex index) {
  const Complex n2 = index * index;
  Complex q = std::sqrt(n2 - Complex(1 - cosine * cosine));
  if (q.imag() < 0) q = -q;
  return {(cosine - q) / (cosine + q), (n2 * cosine - q) / (n2 * cosine + q)};
}

/// Light reflected from `in` to `out` by a facet that is perpendicular to their half-vector: the angle of incidence is half of
/// the angle between them. `amplitudes(lane, cosine)`.
template <class At>
Polarization reflection(const Vector3& out, const Vector3& in, const At& amplitudes) {
  const Vector3 s = common_perpendicular(out, in);
  Polarization event{{}, s, s};
  const float cosine = std::min(0.5f * length(out + in), 1.0f);
  for (int lane = 0; lane < spectrum_size; ++lane) set_mueller(event.mueller, lane, amplitudes(lane, cosine));
  return event;
}

/// Light refracted from `in` to `out`; `eta` is the index on the side of `in` over that on the side of `out`, per wavelength.
/// The facet that does it is perpendicular to out + eta in, one for each wavelength. Up to a common factor
///     a_s = 1 / (cos_out + eta cos_in),   a_p = 1 / (eta cos_out + cos_in).
inline Polarization refraction(const Vector3& out, const Vector3& in, const Spectrum& eta) {
  const Vector3 s = common_perpendicular(out, in);
  Polarization event{{}, s, s};
  for (int lane = 0; lane < spectrum_size; ++lane) {
    const Vector3 m = out + eta[lane] * in;
    const float across = length(m);
    const float c_out = std::abs(dot(out, m)), c_in = std::abs(dot(in, m));
    if (across > 1e-6f && c_out + c_in > 0)
      set_mueller(event.mueller, lane, {1 / (c_out + eta[lane] * c_in), 1 / (eta[lane] * c_out + c_in)});
    else
      set_mueller(event.mueller, lane, {1, 1});
  }
  return event;
}

/// Light at the boundary of a dielectric, reflected or refracted by a facet; `eta`: the index behind it over that on the side
/// of `out`.
inline Polarization at_dielectric(const Vector3& out, const Vector3& in, const Spectrum& eta, Lobes lobes) {
  if (lobes & transmission_lobes) return refraction(out, in, eta);
  return reflection(out, in, [&](int lane, float cosine) { return reflected(cosine, eta[lane]); });
}

/// Light that is scattered inside of a body, until it is unpolarized, and goes through its smooth boundary on the way in and on
/// the way out. Of light at an angle to the normal n the boundary lets other fractions T_s and T_p through; with
/// d = (T_s - T_p) / (T_s + T_p) at either direction, the matrix is (1, d_out, 0, 0)^T (1, d_in, 0, 0) (Baek et al. 2018,
/// Simultaneous acquisition of polarimetric SVBRDF and normals).
inline Polarization through_boundary_twice(const Vector3& out, const Vector3& in, const Normal3& n, float eta) {
  const auto diattenuation = [&](const Vector3& v) {
    const float c = std::abs(dot(n, v)), c_behind = safe_sqrt(1 - (1 - c * c) / (eta * eta));
    const float s = 1 / square(c + eta * c_behind), p = 1 / square(eta * c + c_behind);
    return (s - p) / (s + p);
  };
  Polarization event{{}, common_perpendicular(Vector3(n), in), common_perpendicular(Vector3(n), out)};
  const float d_out = diattenuation(out), d_in = diattenuation(in);
  event.mueller(0, 0) = Spectrum(1.0f);
  event.mueller(0, 1) = Spectrum(d_in);
  event.mueller(1, 0) = Spectrum(d_out);
  event.mueller(1, 1) = Spectrum(d_in * d_out);
  return event;
}

}  // namespace etendue::polarized
