// Wavelength samplers with one fault each, and an interface of the plugin's own: what `etendue conform` must find.

#include "etendue/check/conform/trial.h"
#include "etendue/wavelength_sampler.h"

namespace etendue {
namespace {

Wavelengths spread(float u, float low, float high, float pdf) {
  Wavelengths w;
  for (int i = 0; i < spectrum_size; ++i) {
    float v = u + float(i) / spectrum_size;
    if (v >= 1) v -= 1;
    w.place(i, low + v * (high - low), pdf);
  }
  return w;
}

class UltravioletWavelengths final : public WavelengthSampler {
 public:
  static void describe(Description<UltravioletWavelengths>& d) { d.summary("Goes beyond what is seen."); }
  Wavelengths sample(SampleKey, float u) const override { return spread(u, 300, 900, 1.0f / 600); }
};
const Register<UltravioletWavelengths> ultraviolet;

class OverstatedWavelengths final : public WavelengthSampler {
 public:
  static void describe(Description<OverstatedWavelengths>& d) { d.summary("Says a density that integrates to 1.02."); }
  Wavelengths sample(SampleKey, float u) const override { return spread(u, 400, 700, 1.02f / 300); }
};
const Register<OverstatedWavelengths> overstated;

class ReddishWavelengths final : public WavelengthSampler {
 public:
  static void describe(Description<ReddishWavelengths>& d) { d.summary("Draws more of the long ones than it says."); }
  Wavelengths sample(SampleKey, float u) const override {
    Wavelengths w;
    for (int i = 0; i < spectrum_size; ++i) {
      float v = u + float(i) / spectrum_size;
      if (v >= 1) v -= 1;
      w.place(i, 360 + 470 * std::pow(v, 0.9f), 1.0f / 470);
    }
    return w;
  }
};
const Register<ReddishWavelengths> reddish;

// ---- an interface of the plugin's own ------------------------------------------------------------------------------------

class Knob : public Component {
 public:
  using Interface = Knob;
  using Parent = Component;
  static void describe(Description<Knob>& d) { d.summary("Turns."); }
  virtual float turned(float by) const = 0;
};
const Register<Knob> knob;

/// An interface without any implementation.
class Handle : public Component {
 public:
  using Interface = Handle;
  using Parent = Component;
  static void describe(Description<Handle>& d) { d.summary("Is pulled."); }
  virtual void pull() = 0;
};
const Register<Handle> handle;

class LooseKnob final : public Knob {
 public:
  static void describe(Description<LooseKnob>& d) { d.summary("Turns back by less."); }
  float turned(float by) const override { return by < 0 ? by / 2 : by; }
};
const Register<LooseKnob> loose;

void check_knob(conform::Trial& trial) {
  const Knob& part = trial.part<Knob>();
  const float by = trial.uniform();
  trial.expect(part.turned(by) + part.turned(-by) == 0, "a knob turns back as far as it turned");
}
const conform::RegisterCheck<Knob> checked_knob(check_knob);

}  // namespace
}  // namespace etendue
