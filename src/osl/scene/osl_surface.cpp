// Surfaces written in the language: a Shader of the description whose scattering is the closure Ci.

#include "osl_part.h"

namespace etendue::osl {

namespace {

class OslSurface final : public etendue::Shader, public OslPart {
 public:
  explicit OslSurface(const ClassInfo& info) : OslPart(info) {}
  const ClassInfo& class_info() const override { return info(); }

  void prepare() override {
    build_group(*this, {});
    // The index of the body is a property of the object, not of the point: that of the closure at the origin of surface
    // coordinates, seen along the normal.
    index_ = 1;
    opaque_ = all_set(osl_class().opaque);
    if (transmits()) {
      SurfacePoint p;
      p.normal = p.shading_normal = Normal3{0, 0, 1};
      p.dpdu = {1, 0, 0};
      p.dpdv = {0, 1, 0};
      p.ray_direction = {0, 0, -1};
      const Wavelengths w;
      index_ = refracting_index(Run(*this, p, &w).Ci());
    }
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    const Run run(*this, p, &w);
    if (!run.Ci()) return nullptr;
    SurfacePoint with = p;
    with.dpdu = {run.globals().dPdu.value.x, run.globals().dPdu.value.y, run.globals().dPdu.value.z};
    const bool refracts = (possible_lobes() & specular_transmission) != 0;
    const ClosurePlace place{with, w, arena, space(), run.from_behind(), info().name, refracts};
    return scatter_of(run.Ci(), place);
  }

  Lobes possible_lobes() const override {
    constexpr Lobes into_the_body = specular_transmission | glossy_transmission | null_scattering;
    return opaque_ ? Lobes(osl_class().uses.lobes & ~into_the_body) : osl_class().uses.lobes;
  }
  Spectrum interior_index(const Wavelengths&) const override { return Spectrum(index_); }
  bool transmits() const override { return osl_class().uses.interior && !opaque_; }
  /// A shader may depend on the direction of view, and layer() does.
  bool reciprocal() const override { return !osl_class().uses.layers && !osl_class().shader->globals[size_t(Global::I)]; }
  float albedo_error() const override { return 0.3f; }

 private:
  float index_ = 1;
  bool opaque_ = false;  ///< its members say that it lets no light through
};

}  // namespace

Ref<etendue::Component> make_surface(const ClassInfo& info) { return Ref<etendue::Component>(etendue::make<OslSurface>(info)); }

}  // namespace etendue::osl
