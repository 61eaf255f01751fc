#include "etendue/tone_map.h"

namespace etendue {
namespace {

class NoToneMap final : public ToneMap {
 public:
  static void describe(Description<NoToneMap>& d) {
    d.summary("Changes nothing: only expresses the picture in the RGB space, encoded but not clipped.");
  }
  bool clips() const override { return false; }

 protected:
  void map(Image&) const override {}
};

static const Register<NoToneMap> registered;

}  // namespace
}  // namespace etendue
