#pragma once
// ColoredVolume: base class of media whose coefficients at density 1 are the same everywhere, given as colours; the density may
// vary.

#include "etendue/core/spectral_function.h"
#include "etendue/dye.h"
#include "phased_volume.h"

namespace etendue {

class ColoredVolume : public PhasedVolume, public DyedVolume {
 public:
  bool emits() const final { return emits_; }
  const Dye* dye() const final { return dissolved.get(); }

  Color absorption = flat_spectrum(0), scattering = flat_spectrum(0), extinction, albedo = flat_spectrum(0.75f),
        emission = flat_spectrum(0);
  Ref<Dye> dissolved;
  float dye_absorption = 1;

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
                                       Meaning::radiance, soft(0.001, 1000), logarithmic);
    d.group("Fluorescence")
        .template member<&T::dissolved>("dye", "", "a fluorescent dye in the medium; none: nothing fluoresces")
        .template member<&T::dye_absorption>("dye_absorption", "1/m",
                                             "absorption coefficient of the dye at the wavelength where it absorbs most" +
                                                 where + ", in addition to `absorption`",
                                             at_least(0), soft(0.001, 1000), logarithmic, when("dye"));
    describe_phase(d);
  }

  /// Checks all of these members.
  void prepare_colors();

  /// The absorption of the dye at density 1, which is part of `colors`.
  Spectrum dye_coefficient(const Wavelengths& w) const {
    return dissolved ? dye_absorption * dissolved->absorption_at(w) : Spectrum();
  }
  /// The coefficients at density 1.
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
    if (dissolved) c.absorption += dye_coefficient(w);
    if (emits_) c.emission = emission->evaluate(w, ColorUse::radiance);
    return c;
  }

 private:
  bool check(const char* member, const Color&, ColorUse) const;

  bool emits_ = false;
};

}  // namespace etendue
