#include "osl_surface.h"

#include "osl_part.h"

namespace etendue::osl {

namespace {

/// The origin of surface coordinates on a plane, seen along the normal.
SurfacePoint flat_point() {
  SurfacePoint p;
  p.normal = p.shading_normal = Normal3{0, 0, 1};
  p.dpdu = {1, 0, 0};
  p.dpdv = {0, 1, 0};
  p.ray_direction = {0, 0, -1};
  return p;
}

}  // namespace

// The index of the body is a property of the object, not of the point: that of the closure at the origin of surface
// coordinates, seen along the normal.
void GroupSurface::build_surface(const Component& self, Network network, const std::string& last) {
  build_group(self, std::move(network), last, {});
  index_ = 1;
  find_exits();
  refracts_ = (possible_lobes() & specular_transmission) != 0;
  if (!transmits()) return;
  const Wavelengths w;
  index_ = refracting_index(Run(*this, flat_point(), &w).Ci());
}

Lobes GroupSurface::possible_lobes() const {
  constexpr Lobes into_the_body = specular_transmission | glossy_transmission | null_scattering;
  Lobes lobes = uses().lobes;
  if (uses().interior && !network().lets_in()) lobes &= Lobes(~into_the_body);
  return exits_ ? Lobes(lobes | specular_transmission) : lobes;
}

/// Light enters bodies of subsurface scattering and leaves them in a way of its own, which excludes refraction by the same
/// shader. Materials that name both (a general one, with weights) have one of them or none in most scenes: what they have is
/// looked for at points spread over the surface coordinates.
void GroupSurface::find_exits() {
  exits_ = false;
  if (!uses().bodies) return;
  constexpr int side = 8;
  const Wavelengths w;
  for (int i = 0; i < side * side; ++i) {
    SurfacePoint p = flat_point();
    p.uv = {(float(i % side) + 0.5f) / side, (float(i / side) + 0.5f) / side};
    p.position = p.object_position = {p.uv.x, p.uv.y, 0};
    const Run run(*this, p, &w);
    exits_ |= has_body(run.Ci());
    if (lets_through(run.Ci())) {
      exits_ = false;
      return;
    }
  }
}

ClosurePlace GroupSurface::place_at(const Run& run, const SurfacePoint& p, const Wavelengths& w, Arena& arena) const {
  return {p, w, arena, space(), run.from_behind(), name(), refracts_, exits_};
}

const Scatter* GroupSurface::bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const {
  const Run run(*this, p, &w);
  return run.Ci() ? scatter_of(run.Ci(), place_at(run, p, w, arena)) : nullptr;
}

std::optional<SubsurfaceExit> GroupSurface::sample_exit(const SurfacePoint& p, const Scene& scene, const Wavelengths& w,
                                                        NumberStream& random, Arena& arena) const {
  const Run run(*this, p, &w);
  return exit_of(run.Ci(), place_at(run, p, w, arena), scene, random);
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
