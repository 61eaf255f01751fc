#pragma once
// GroupSurface: a Shader of the description whose scattering is the closure Ci that a group of shaders makes.

#include "etendue/shader.h"
#include "group_run.h"

namespace etendue::osl {

class GroupSurface : public etendue::Shader, public RunsGroup {
 public:
  const Scatter* bind(const SurfacePoint&, const Wavelengths&, Arena&) const final;
  Lobes possible_lobes() const final;
  Spectrum interior_index(const Wavelengths&) const final { return Spectrum(index_); }
  bool transmits() const final { return network().lets_in() && !exits_; }
  /// A shader may depend on the direction of view, and layer() does.
  bool reciprocal() const final { return uses().reciprocal && !network().depends_on_view(); }
  float albedo_error() const final { return uses().albedo_error; }
  bool has_subsurface_exit() const final { return exits_; }
  std::optional<SubsurfaceExit> sample_exit(const SurfacePoint&, const Scene&, const Wavelengths&, NumberStream&,
                                            Arena&) const final;

 protected:
  void build_surface(const Component& self, Network, const std::string& last);

 private:
  ClosurePlace place_at(const Run&, const SurfacePoint&, const Wavelengths&, Arena&) const;
  void find_exits();

  float index_ = 1;
  bool exits_ = false, refracts_ = false;  ///< see ClosurePlace
};

}  // namespace etendue::osl
