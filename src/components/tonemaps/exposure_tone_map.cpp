#include "etendue/exposed_tone_map.h"

namespace etendue {
namespace {

class ExposureToneMap final : public ExposedToneMap {
 public:
  ExposureToneMap() { exposure = Exposure::fixed; }
  static void describe(Description<ExposureToneMap>& d) {
    d.summary("Multiplies by a power of two, as a camera's exposure does; what exceeds white is clipped.");
  }

 protected:
  void develop(Image&) const override {}
};

static const Register<ExposureToneMap> registered;

}  // namespace
}  // namespace etendue
