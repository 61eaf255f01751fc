// HenyeyGreensteinPhase: a single Henyey-Greenstein lobe.

#include "henyey_greenstein.h"

#include "etendue/phase_function.h"

namespace etendue {
namespace {

class HenyeyGreensteinPhase final : public PhaseFunction {
 public:
  static void describe(Description<HenyeyGreensteinPhase>& d) {
    d.summary("One lobe, straight on or back: what media have that state an anisotropy alone. A part of `BlendPhase`, too.",
              "Henyey & Greenstein 1941, Diffuse radiation in the galaxy")
        .member<&HenyeyGreensteinPhase::anisotropy>(
            "anisotropy", "1",
            "mean cosine of the angle light turns by: 1 is all straight on, and excluded; a lobe back may not be narrower than "
            "that of -0.95, as h there, near 2, is a coarse number",
            range(-0.95, 1));
  }
  void prepare() override {
    if (!(anisotropy < 1)) fail("anisotropy", "must be less than 1");
  }
  // A backward lobe is the same function of the angle to the backward direction.
  float value(float h) const override { return henyey_greenstein::value(std::abs(anisotropy), anisotropy < 0 ? 2 - h : h); }
  float sample(float u) const override {
    const float h = henyey_greenstein::sample(std::abs(anisotropy), u);
    return anisotropy < 0 ? 2 - h : h;
  }

  float anisotropy = 0;
};

const Register<HenyeyGreensteinPhase> registered;

}  // namespace
}  // namespace etendue
