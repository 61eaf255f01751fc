#pragma once
// Fluorescence: light that is absorbed at one wavelength and emitted at another, or Reradiation for short.
//
// A surface that fluoresces scatters the radiance
//     L(out, l) = int f(out, in, l) |cos| L(in, l) d(in)                                elastic scattering: Shader::bind
//               + int int Phi(l' -> l) r(out, in) |cos| L(in, l') d(in) dl'             FluorescentSurface
// with the reradiation matrix Phi [1/nm] of Donaldson (1954, "Spectrophotometry of fluorescent pigments"): the power emitted at
// l per nanometre over the power that arrives at l'. r [1/sr] is the distribution of the emitted directions, with the albedo 1.
//
// Phi is not symmetric. Power is conserved where f's albedo at l' and int Phi(l' -> l) dl together are at most 1. Reciprocity
// holds for the directions alone, r(out, in) = r(in, out): exchanging source and detector of light exchanges their
// wavelengths, too, so that the adjoint of the operator above, which scatters importance, has the transposed matrix,
//     W(in, l') = int int Phi(l' -> l) r(out, in) |cos| W(out, l) d(out) dl.
// A walk from the camera therefore goes from l to l', a walk from a luminaire from l' to l, and both count Phi(l' -> l).
// transport/fluorescence.h has the estimators.

#include <array>

#include "etendue/core/spectrum.h"
#include "etendue/shader.h"
#include "etendue/volume_shader.h"

namespace etendue {

/// Values at whole nanometres from 360 to 830 nm, linear between them, none negative; and wavelengths sampled in proportion to
/// the mean value in each nanometre.
class SampledFunction {
 public:
  static constexpr int size = int(wavelength_high - wavelength_low) + 1;

  SampledFunction() = default;
  explicit SampledFunction(const std::array<float, size>& values);

  /// The value at a wavelength [nm]; 0 outside of the range.
  float operator()(float wavelength) const;
  /// The integral over all wavelengths [nm].
  float integral() const { return integral_; }
  float largest() const;
  /// A wavelength [nm] for u in [0, 1), and its pdf [1/nm]. The integral must not be 0.
  float sample(float u, float& pdf) const;

 private:
  std::array<float, size> values_{}, cdf_{};  // cdf_[k]: of all below 360 nm + k
  float integral_ = 0;
};

/// Reradiation at a point.
class Reradiation {
 public:
  /// Phi [1/nm] for light that is absorbed at one wavelength and emitted at another [nm].
  virtual float value(float absorbed, float emitted) const = 0;
  /// The integral of Phi over all absorbed wavelengths [1]. 0 only if Phi is 0 for all of them.
  virtual float received(float emitted) const = 0;
  /// The integral of Phi over all emitted wavelengths [1]. 0 only if Phi is 0 for all of them.
  virtual float given(float absorbed) const = 0;
  /// Samples the absorbed wavelength for an emitted one, with its pdf [1/nm], which is more than 0 wherever Phi is.
  virtual float sample_absorbed(float emitted, float u, float& pdf) const = 0;

  /// r |cos|, whose albedo is 1 at all wavelengths.
  const Scatter& directions() const { return directions_; }

 protected:
  explicit Reradiation(const Scatter& directions) : directions_(directions) {}
  ~Reradiation() = default;

 private:
  const Scatter& directions_;
};

/// What a shader of a fluorescent surface is besides a Shader. Its function `bind` returns the elastic scattering alone. It
/// must be the shader of an object itself, and not stand within other shaders.
class FluorescentSurface {
 public:
  /// The reradiation at a point, allocated in the arena. Null: there is none.
  virtual const Reradiation* bind_reradiation(const SurfacePoint&, Arena&) const = 0;

 protected:
  ~FluorescentSurface() = default;
};

class Dye;

/// What a medium with a fluorescent dye is besides a VolumeShader. The dye's absorption is part of the medium's coefficients.
class DyedVolume {
 public:
  /// Null: there is no dye.
  virtual const Dye* dye() const = 0;
  /// The absorption coefficient of the dye at a point, at the wavelength where it absorbs most [1/m]. Points are those of
  /// VolumeShader.
  virtual float dye_amount(const Point3&, float time) const = 0;
  /// An upper bound of it; in a homogeneous medium the amount itself.
  virtual float most_dye() const = 0;

 protected:
  ~DyedVolume() = default;
};

/// Null: the shader does not fluoresce.
inline const FluorescentSurface* fluorescent(const Shader* shader) { return dynamic_cast<const FluorescentSurface*>(shader); }
/// Null: the medium has no dye.
inline const DyedVolume* dyed(const VolumeShader* volume) {
  const auto* with_dye = dynamic_cast<const DyedVolume*>(volume);
  return with_dye && with_dye->dye() ? with_dye : nullptr;
}

}  // namespace etendue
