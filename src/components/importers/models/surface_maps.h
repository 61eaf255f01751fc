#pragma once
// SurfaceMaps: converts the numbers and colours of a Surface to maps.

#include "surface.h"

namespace etendue {

class SurfaceMaps {
 public:
  SurfaceMaps(Importing& importing, Location at) : importing_(importing), at_(at) {}

  /// Null: the value is constant.
  Ref<Component> color(const SurfaceColor&) const;
  Ref<Component> number(const SurfaceNumber&) const;
  /// The map of a surface's opacity, thresholded if there is a cutoff.
  Ref<Component> opacity(const Surface&) const;
  /// The opacity where it is constant.
  static double same_opacity(const Surface&);
  /// The emitted radiance, the colour times the opacity; null: constant.
  Ref<Component> emitted(const SurfaceColor&, const Ref<Component>& opacity) const;
  /// A channel of an image, or its colours (channel "").
  Ref<Component> image(const SurfaceTexture&, const std::string& channel, bool linear) const;

 private:
  Ref<Component> part(const char* class_name) const { return importing_.make(class_name, at_); }
  void put(Component& to, std::string_view member, const Ref<Component>& value) const { set(to, member, Value(value, at_)); }
  Ref<Component> product(const Ref<Component>& first, const Value& second) const;
  std::string channel_there(const std::string& file, const std::string& channel) const;

  Importing& importing_;
  Location at_;
};

}  // namespace etendue
