// The same colour everywhere.

#include "etendue/object_map.h"

namespace etendue {
namespace {

class ConstantMap final : public ObjectMap {
 public:
  ConstantMap() = default;
  explicit ConstantMap(float all) : value(flat_spectrum(all)), mean_(all) {}

  static void describe(Description<ConstantMap>& d) {
    d.summary("The same colour everywhere.")
        .member<&ConstantMap::value>("value", "1", "the colour, in the unit of whatever asks for it")
        .literal("value");
  }

  void prepare() override {
    if (!value) fail("value", "a colour is needed");
    // The mean over the visible range, by the midpoint rule with steps of 5 nm.
    constexpr int steps = 94;
    double sum = 0;
    for (int i = 0; i < steps; ++i) sum += value->at(wavelength_low + 5 * (float(i) + 0.5f), ColorUse::coefficient);
    mean_ = float(sum / steps);
    if (!value->varies()) mean_ = value->at(550, ColorUse::coefficient);  // exactly the number that was written
  }

  Spectrum color(const SurfacePoint&, const Wavelengths& w, ColorUse use) const override { return value->evaluate(w, use); }
  float scalar(const SurfacePoint&) const override { return mean_; }
  Color constant() const override { return value; }

  Color value = flat_spectrum(0.5f);

 private:
  float mean_ = 0.5f;
};

const Register<ConstantMap> registered;

}  // namespace

Ref<ObjectMap> constant(float value) { return make<ConstantMap>(value); }

}  // namespace etendue
