#pragma once
// Dye: a fluorescent substance, for surfaces (FluorescentShader) and media (the member `dye` of volumes).
//
// Of the power that a dye absorbs at the wavelength l', it emits at l, per nanometre,
//     y(l' -> l) = Q n(l) l' / l,    n(l) = E(l) l / int E(s) s ds     [1/nm]:
// of the photons absorbed the fraction Q (the quantum yield) is emitted again, whatever their wavelength was (Kasha's and
// Vavilov's rules), with the distribution n of photons over wavelengths that belongs to the emitted power E; and the energy of
// a photon is proportional to 1 / l. So y(l' -> l) = Q l' E(l) / int E(s) s ds.

#include "etendue/core/spectral_function.h"
#include "etendue/describe/bands.h"
#include "etendue/describe/color.h"
#include "etendue/describe/component.h"
#include "etendue/describe/description.h"
#include "etendue/reradiation.h"

namespace etendue {

class Dye final : public Component, public NeedsWavelengths {
 public:
  using Interface = Dye;
  using Parent = Component;
  static void describe(Description<Dye>&);

  void prepare() override;
  void refuse_bands() const override { fail({}, "fluorescence moves light from one wavelength to others"); }

  /// Absorption relative to its largest value: x in [0, 1].
  const SampledFunction& absorption() const { return absorption_; }
  Spectrum absorption_at(const Wavelengths& w) const {
    Spectrum x;
    for (int i = 0; i < spectrum_size; ++i) x.set(i, absorption_(w[i]));
    return x;
  }
  /// y [1/nm].
  float yield(float absorbed, float emitted) const { return absorbed * yield_(emitted); }
  /// The integral of x(l') y(l' -> l) over l' [1].
  float received(float emitted) const { return received_ * yield_(emitted); }
  /// The integral of y(l' -> l) over l [1]: the power emitted over the power absorbed.
  float given(float absorbed) const { return absorbed * yield_.integral(); }

  /// By default about those of pyranine, the yellow of highlighters.
  Color absorption_spectrum = table_spectrum({360, 380, 405, 425, 455, 475, 500}, {0.7f, 0.85f, 0.95f, 0.75f, 1, 0.5f, 0}),
        emission = table_spectrum({480, 500, 512, 530, 560, 600, 640}, {0, 0.7f, 1, 0.7f, 0.3f, 0.08f, 0});
  float quantum_yield = 0.9f;

 private:
  SampledFunction absorption_;  // x
  SampledFunction yield_;       // Q E(l) / int E s ds [1/nm^2]
  float received_ = 0;          // int x(l') l' dl' [nm^2]
};

}  // namespace etendue
