// BlendPhase: a mixture of two phase functions, as of two kinds of particles.

#include <algorithm>

#include "etendue/core/math.h"
#include "etendue/polarizing_scatter.h"

namespace etendue {
namespace {

// p = (1 - w) p_1 + w p_2. One random number chooses the function and samples it: numbers below w are rescaled to [0, 1) for
// the second function, the others for the first.
class BlendPhase final : public PhaseFunction, public PolarizingPhase {
 public:
  static void describe(Description<BlendPhase>& d) {
    d.summary(
         "Two phase functions in a fixed ratio, as of a medium with two kinds of particles, or of two lobes, one of them back. "
         "A "
         "part may be a blend itself.")
        .member<&BlendPhase::first>("first", "", "where light goes when `amount` is 0", required)
        .member<&BlendPhase::second>("second", "", "where light goes when `amount` is 1", required)
        .member<&BlendPhase::amount>("amount", "1", "how much of what is scattered goes by the second", range(0, 1));
  }
  float value(float h) const override { return lerp(amount, first->value(h), second->value(h)); }
  float sample(float u) const override {
    constexpr float below_one = 0x1.fffffep-1f;
    if (u < amount) return second->sample(std::min(u / amount, below_one));
    return first->sample(std::min((u - amount) / (1 - amount), below_one));
  }

  bool polarization(float h, Mueller& m) const override {
    const float all = value(h), parts[2] = {(1 - amount) * first->value(h), amount * second->value(h)};
    m = Mueller();
    for (int k = 0; k < 2; ++k) {
      Mueller part;
      if (!polarization_of(*(k == 0 ? first : second), h, part)) part = Mueller::depolarizer();
      part *= Spectrum(all > 0 ? parts[k] / all : 0.5f);
      m += part;
    }
    return true;
  }

  Ref<PhaseFunction> first, second;
  float amount = 0.5f;
};

const Register<BlendPhase> registered;

}  // namespace
}  // namespace etendue
