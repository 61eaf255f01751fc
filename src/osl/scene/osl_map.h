#pragma once
// GroupMap: a map of the description whose value is an output of a group of shaders, or the displacement along the normal.

#include "components/maps/rgb_source.h"
#include "etendue/object_map.h"
#include "group_run.h"

namespace etendue::osl {

class GroupMap : public ObjectMap, public RgbSource, public RunsGroup {
 public:
  Spectrum color(const SurfacePoint&, const Wavelengths&, ColorUse) const final;
  float scalar(const SurfacePoint&) const final;
  bool has_rgb() const final { return !single(); }
  void rgb(const SurfacePoint&, float out[3]) const final;

 protected:
  /// `wanted`: "layer.output"; empty: the displacement that the last layer makes.
  void build_map(const Component& self, Network, const std::string& last, const std::string& wanted);

 private:
  bool single() const { return displaces_ || !output().type.is_triple(); }
  Triple value(const Run&) const;
  Triple value_at(const SurfacePoint&, const Wavelengths*) const;

  bool displaces_ = false;
  std::string no_value_;  ///< why the map has none; empty: it has
  Location place_;
};

}  // namespace etendue::osl
