// A plugin that misbehaves in the way that the environment variable ETENDUE_HOSTILE names; without the variable it is
// well-behaved.

#include <unistd.h>

#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include "etendue/describe/color.h"
#include "etendue/describe/description.h"
#include "etendue/object_map.h"
#include "etendue/scatter_model.h"

using namespace etendue;

namespace {

/// Throws, crashes or hangs if ETENDUE_HOSTILE requests that for this place.
void misbehave(std::string_view place) {
  const char* text = std::getenv("ETENDUE_HOSTILE");
  const std::string_view asked = text ? text : "";
  if (!asked.starts_with(place) || asked.size() <= place.size() || asked[place.size()] != ' ') return;
  const std::string_view what = asked.substr(place.size() + 1);
  if (what == "int") throw 42;
  if (what == "runtime") throw std::runtime_error("boom");
  if (what == "error") throw Error("bang");
  if (what == "crash") *static_cast<volatile int*>(nullptr) = 1;
  if (what == "abort") std::abort();
  if (what == "exit") ::_exit(0);
  if (what == "hang")
    for (;;) ::pause();
}

struct Opening {
  Opening() { misbehave("open"); }
} opening;

class HalfScatter final : public ScatterModel<HalfScatter> {
 public:
  explicit HalfScatter(const SurfacePoint& p) : ScatterModel(p, diffuse_reflection) {}

  Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes) const {
    return out.z * in.z > 0 ? Spectrum(0.5f * inverse_pi) : Spectrum();
  }
  float local_pdf(const Vector3& out, const Vector3& in, Lobes) const {
    return out.z * in.z > 0 ? std::abs(in.z) * inverse_pi : 0;
  }
  bool local_sample(const Vector3& out, float, Point2 u, Lobes lobes, LocalSample& s) const {
    const float r = std::sqrt(u.x), phi = 2 * pi * u.y, z = safe_sqrt(1 - u.x);
    s.in = {r * std::cos(phi), r * std::sin(phi), std::copysign(z, out.z)};
    s.lobe = diffuse_reflection;
    s.pdf = local_pdf(out, s.in, lobes);
    s.value = Spectrum(0.5f) * s.pdf;
    return true;
  }
  Spectrum local_albedo(const Vector3&, Lobes) const { return Spectrum(0.5f); }
};

}  // namespace

class HostileShader final : public Shader {
  float purity = 1;

 public:
  HostileShader() { misbehave("construct"); }
  static void describe(Description<HostileShader>& d) {
    misbehave("describe");
    d.summary("Grey.").member<&HostileShader::purity>("purity", "1", "nothing", range(0, 1));
  }
  void prepare() override { misbehave("prepare"); }
  const Scatter* bind(const SurfacePoint& p, const Wavelengths&, Arena& arena) const override {
    misbehave("bind");
    return arena.make<HalfScatter>(p);
  }
  Lobes possible_lobes() const override { return diffuse_reflection; }
};
static const Register<HostileShader> registered_shader;

class HostileMap final : public ObjectMap {
 public:
  static void describe(Description<HostileMap>& d) { d.summary("Grey."); }
  Spectrum color(const SurfacePoint&, const Wavelengths&, ColorUse) const override {
    misbehave("color");
    return Spectrum(0.5f);
  }
  float scalar(const SurfacePoint&) const override { return 0.5f; }
};
static const Register<HostileMap> registered_map;
