#include "osl_volume.h"

#include <fmt/format.h>

#include "components/volumes/phased_volume.h"
#include "osl/closures/media.h"
#include "osl_part.h"

namespace etendue::osl {

namespace {

/// A point in a medium, as shaders see it: without a surface, in the object's coordinates.
SurfacePoint inside(const Point3& point, float time) {
  SurfacePoint p;
  p.position = p.object_position = point;
  p.normal = p.shading_normal = p.object_normal = {0, 0, 1};
  p.time = time;
  return p;
}

}  // namespace

// Delta tracking needs a majorant of the extinction. A shader that does not depend on the place has its extinction as one. Of
// others it is the member `bound`, or what the shader says at the origin in an output of that name, which may depend on its
// parameters. An extinction above it is reduced to it, so that it holds for any shader.
void GroupVolume::build_volume(const Component& self, Network network, const std::string& last, float bound) {
  if (!(bound >= 0 && bound <= most_extinction)) self.fail(bound_name, fmt::format(too_dense, bound));
  const Symbol* says = network.shader_of(last)->find_parameter(bound_name);
  const bool output = says && says->role == Symbol::Role::output && says->type.is_float();
  build_group(self, std::move(network), last, {}, output ? last + "." + bound_name : std::string());
  bound_ = bound;
  told_ = false;
  if (bound > 0 || homogeneous()) return;
  if (output) bound_ = *reinterpret_cast<const float*>(Run(*this, inside({0, 0, 0}, 0), nullptr).output());
  if (!output)
    self.fail("", fmt::format("how dense the medium may become is not known: set `{0}`, or let the shader say it in an output "
                              "`float {0}`",
                              bound_name));
  if (!(bound_ >= 0 && bound_ <= most_extinction))
    self.fail("", fmt::format("the shader's output `{}` is {} at the origin, and must be positive", bound_name, bound_));
}

VolumeCoefficients GroupVolume::unbounded(const SurfacePoint& p, const Wavelengths& w) const {
  return medium_of(Run(*this, p, &w).Ci(), space(), w);
}

VolumeCoefficients GroupVolume::coefficients(const Point3& point, float time, const Wavelengths& w) const {
  VolumeCoefficients c = unbounded(inside(point, time), w);
  if (homogeneous() && !(bound_ > 0)) return c;
  const Spectrum extinction = c.extinction();
  if (!(extinction.maximum() > bound_)) return c;
  if (!told_.exchange(true, std::memory_order_relaxed))
    warn(
        fmt::format("{}: the extinction is {:.4g}/m at ({:.4g}, {:.4g}, {:.4g}) of the object, more than `{}`, {:.4g}/m: the "
                    "medium is made thinner there",
                    name(), extinction.maximum(), point.x, point.y, point.z, bound_name, bound_));
  const Spectrum left = map(extinction, [this](float s) { return s > bound_ ? bound_ / s : 1.0f; });
  c.absorption *= left;
  c.scattering *= left;
  return c;
}

Spectrum GroupVolume::majorant(const Wavelengths& w) const {
  if (homogeneous()) return coefficients({0, 0, 0}, 0, w).extinction();
  return Spectrum(bound_ * 1.00001f);
}

float GroupVolume::phase(const Point3& point, const Vector3& out, const Vector3& in) const {
  const Wavelengths w;
  return PhaseMixture(Run(*this, inside(point, 0), &w).Ci()).value(out, in);
}

Vector3 GroupVolume::sample_phase(const Point3& point, const Vector3& out, Point2 u, float& pdf) const {
  const Wavelengths w;
  return PhaseMixture(Run(*this, inside(point, 0), &w).Ci()).sample(out, u, pdf);
}

namespace {

/// A medium of one shader, and of the maps that its members are.
class OslVolume final : public GroupVolume, public OslPart {
 public:
  explicit OslVolume(const ClassInfo& info) : OslPart(info) {}
  const ClassInfo& class_info() const override { return info(); }
  const Component& component() const override { return *this; }
  void prepare() override {
    Network network;
    const std::string layer = network.add(*this);
    float bound = 0;
    if (const auto given = declared_values.find(std::string_view(bound_name)); given != declared_values.end())
      if (const auto* n = given->second.as<Number>()) bound = float(n->value);
    build_volume(*this, std::move(network), layer, bound);
  }
};

}  // namespace

Ref<etendue::Component> make_volume(const ClassInfo& info) { return Ref<etendue::Component>(etendue::make<OslVolume>(info)); }

}  // namespace etendue::osl
