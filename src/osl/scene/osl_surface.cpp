#include "osl_surface.h"

#include "osl_part.h"

namespace etendue::osl {

// The index of the body is a property of the object, not of the point: that of the closure at the origin of surface
// coordinates, seen along the normal.
void GroupSurface::build_surface(const Component& self, Network network, const std::string& last) {
  build_group(self, std::move(network), last, {});
  index_ = 1;
  if (!uses().interior) return;
  SurfacePoint p;
  p.normal = p.shading_normal = Normal3{0, 0, 1};
  p.dpdu = {1, 0, 0};
  p.dpdv = {0, 1, 0};
  p.ray_direction = {0, 0, -1};
  const Wavelengths w;
  index_ = refracting_index(Run(*this, p, &w).Ci());
}

const Scatter* GroupSurface::bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const {
  const Run run(*this, p, &w);
  if (!run.Ci()) return nullptr;
  SurfacePoint with = p;
  with.dpdu = {run.globals().dPdu.value.x, run.globals().dPdu.value.y, run.globals().dPdu.value.z};
  const bool refracts = (uses().lobes & specular_transmission) != 0;
  const ClosurePlace place{with, w, arena, space(), run.from_behind(), name(), refracts};
  return scatter_of(run.Ci(), place);
}

namespace {

/// A surface of one shader, and of the maps that its members are.
class OslSurface final : public GroupSurface, public OslPart {
 public:
  explicit OslSurface(const ClassInfo& info) : OslPart(info) {}
  const ClassInfo& class_info() const override { return info(); }
  const Component& component() const override { return *this; }
  void prepare() override {
    Network network;
    const std::string layer = network.add(*this);
    build_surface(*this, std::move(network), layer);
  }
};

}  // namespace

Ref<etendue::Component> make_surface(const ClassInfo& info) { return Ref<etendue::Component>(etendue::make<OslSurface>(info)); }

}  // namespace etendue::osl
