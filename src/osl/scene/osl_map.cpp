// Maps written in the language: an output of a shader, or the displacement along the normal.

#include "etendue/object_map.h"
#include "osl_part.h"

namespace etendue::osl {

namespace {

class OslMap final : public ObjectMap, public OslPart {
 public:
  explicit OslMap(const ClassInfo& info) : OslPart(info) {}
  const ClassInfo& class_info() const override { return info(); }

  void prepare() override {
    std::string wanted = osl_class().outputs.front();
    if (const auto given = declared_values.find("output"); given != declared_values.end())
      if (const auto* text = given->second.as<std::string>()) wanted = *text;
    displaces_ = osl_class().shader->kind == Shader::Kind::displacement && wanted == "displacement";
    build_group(*this, displaces_ ? std::vector<std::string>{} : std::vector{wanted});
  }

  Spectrum color(const SurfacePoint& p, const Wavelengths& w, ColorUse use) const override {
    const Run run(*this, p, &w);
    const Triple c = finite(value(run));
    if (single()) return Spectrum(use == ColorUse::reflectance ? clamp(c.x, 0, 1) : c.x);
    return rgb_spectrum(space(), positive(c.x), positive(c.y), positive(c.z), use, w);
  }
  float scalar(const SurfacePoint& p) const override {
    const Run run(*this, p, nullptr);
    const Triple c = finite(value(run));
    return single() ? c.x : (c.x + c.y + c.z) / 3;
  }

 private:
  static float positive(float x) { return x > 0 ? x : 0; }
  /// What a shader computes without a number, of points far away for example, is 0.
  static Triple finite(Triple c) {
    for (int i = 0; i < 3; ++i)
      if (!std::isfinite(c[i])) c[i] = 0;
    return c;
  }
  bool single() const { return displaces_ || !output().type.is_triple(); }

  Triple value(const Run& run) const {
    if (displaces_) {
      // P was seen from the front or from behind, and so was N; the displacement is that along the front's normal.
      const Globals& b = run.globals_before();
      const float d = dot(run.globals().P.value - b.P.value, b.N.value);
      return Triple(run.from_behind() ? -d : d);
    }
    if (output().type.is_triple()) return *reinterpret_cast<const Triple*>(run.output());
    if (output().type.is_int()) return Triple(float(*reinterpret_cast<const int*>(run.output())));
    return Triple(*reinterpret_cast<const float*>(run.output()));
  }

  bool displaces_ = false;
};

}  // namespace

Ref<etendue::Component> make_map(const ClassInfo& info) { return Ref<etendue::Component>(etendue::make<OslMap>(info)); }

}  // namespace etendue::osl
