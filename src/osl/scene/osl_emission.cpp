#include "osl_emission.h"

#include "components/emission/any_radiance.h"
#include "osl_part.h"

namespace etendue::osl {

Spectrum GroupEmission::radiance(const SurfacePoint& p, const Vector3& direction, const Wavelengths& w) const {
  if (!emits(p, direction)) return {};
  SurfacePoint seen = p;
  seen.ray_direction = -direction;
  const Run run(*this, seen, &w);
  return light_of(run.Ci(), space(), w);
}

DirectionSample GroupEmission::sample(const SurfacePoint& p, Point2 u) const { return any_radiance::sample(*this, p, u); }

float GroupEmission::pdf(const SurfacePoint& p, const Vector3& direction) const {
  return any_radiance::pdf(*this, p, direction);
}

Spectrum GroupEmission::power(const SceneObject& object, const Wavelengths& w) const {
  constexpr int runs = 1024;
  return any_radiance::power(*this, object, w, runs);
}

namespace {

/// Light of one shader, and of the maps that its members are.
class OslEmission final : public GroupEmission, public OslPart {
 public:
  explicit OslEmission(const ClassInfo& info) : OslPart(info) {}
  const ClassInfo& class_info() const override { return info(); }
  const Component& component() const override { return *this; }
  void prepare() override {
    Network network;
    const std::string layer = network.add(*this);
    build_group(*this, std::move(network), layer, {});
  }
};

}  // namespace

Ref<etendue::Component> make_emission(const ClassInfo& info) {
  return Ref<etendue::Component>(etendue::make<OslEmission>(info));
}

}  // namespace etendue::osl
