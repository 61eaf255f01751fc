#pragma once
// ColoredVolume: what media have in common whose colours are the same everywhere, however dense they are: how their
// coefficients are said, and the phase function.

#include "etendue/core/spectral_function.h"
#include "etendue/phase_function.h"
#include "etendue/volume_shader.h"

namespace etendue {

class ColoredVolume : public VolumeShader {
 public:
  bool emits() const final { return emits_; }
  float phase(const Point3&, const Vector3& out, const Vector3& in) const final;
  Vector3 sample_phase(const Point3&, const Vector3& out, Point2 u, float& density) const final;

  Color absorption = flat_spectrum(0), scattering = flat_spectrum(0), extinction, albedo = flat_spectrum(0.75f),
        emission = flat_spectrum(0);
  Ref<PhaseFunction> phase_function;
  float anisotropy = 0;

 protected:
  /// `where`: " where the density is 1", or nothing.
  template <class T>
  static void describe_colors(Description<T>& d, const std::string& where = {}) {
    d.group("Coefficients")
        .template member<&T::absorption>("absorption", "1/m", "absorption coefficient, per wavelength" + where,
                                         Meaning::coefficient, soft(0.001, 1000), logarithmic, unless("extinction"))
        .template member<&T::scattering>("scattering", "1/m", "scattering coefficient, per wavelength" + where,
                                         Meaning::coefficient, soft(0.001, 1000), logarithmic, unless("extinction"))
        .template member<&T::extinction>("extinction", "1/m",
                                         "instead of these, both together, per wavelength" + where +
                                             "; `albedo` says how much of it scatters; none: they are used",
                                         Meaning::coefficient)
        .template member<&T::albedo>("albedo", "1", "the part of the extinction that scatters, per wavelength",
                                     Meaning::reflectance, when("extinction"))
        .template member<&T::emission>("emission", "W m^-3 sr^-1 nm^-1",
                                       "radiance the medium adds per distance" + where + ", whatever it absorbs",
                                       Meaning::radiance, soft(0.001, 1000), logarithmic)
        .group("Phase function")
        .template member<&T::phase_function>(
            "phase", "", "where scattered light goes; none: Henyey's and Greenstein's function with `anisotropy`")
        .template member<&T::anisotropy>("anisotropy", "1",
                                         "mean cosine of the angle light turns by, between -1 (all back) and 1 (all straight "
                                         "on), both excluded; 0 scatters alike in all directions",
                                         range(-1, 1), unless("phase"));
  }

  /// Checks all of that.
  void prepare_colors();

  /// At density 1.
  VolumeCoefficients colors(const Wavelengths& w) const {
    VolumeCoefficients c;
    if (extinction) {
      const Spectrum whole = extinction->evaluate(w, ColorUse::coefficient), part = albedo->evaluate(w, ColorUse::reflectance);
      c.scattering = whole * part;
      c.absorption = whole - c.scattering;
    } else {
      c.absorption = absorption->evaluate(w, ColorUse::coefficient);
      c.scattering = scattering->evaluate(w, ColorUse::coefficient);
    }
    if (emits_) c.emission = emission->evaluate(w, ColorUse::radiance);
    return c;
  }

 private:
  /// Where most of the light goes that came from `out`: straight on, or back.
  Vector3 peak(const Vector3& out) const { return anisotropy < 0 ? out : -out; }
  bool check(const char* member, const Color&, ColorUse) const;

  bool emits_ = false;
};

}  // namespace etendue
