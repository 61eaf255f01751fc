#pragma once
// Base classes of maps that mix two other maps by a number computed from the point.

#include "components/maps/footprint.h"
#include "components/maps/noise.h"
#include "components/volumes/bounded_map.h"
#include "etendue/object_map.h"

namespace etendue {

/// (1 - fraction) first + fraction second: of the spectra, or of the numbers.
class BlendMap : public ObjectMap, public BoundedMap {
 public:
  void prepare() override {
    if (!first) fail(first_name(), "a map is needed");
    if (!second) fail(second_name(), "a map is needed");
  }
  Spectrum color(const SurfacePoint& p, const Wavelengths& w, ColorUse use) const final {
    const float t = fraction(p);
    if (t <= 0) return first->color(p, w, use);
    if (t >= 1) return second->color(p, w, use);
    return (1 - t) * first->color(p, w, use) + t * second->color(p, w, use);
  }
  float scalar(const SurfacePoint& p) const final {
    const float t = fraction(p);
    if (t <= 0) return first->scalar(p);
    if (t >= 1) return second->scalar(p);
    return (1 - t) * first->scalar(p) + t * second->scalar(p);
  }
  float bound() const final { return std::max(bound_of(*first), bound_of(*second)); }

  Ref<ObjectMap> first, second;

 protected:
  BlendMap(float a, float b) : first(etendue::constant(a)), second(etendue::constant(b)) {}
  /// The weight of the second map in [0, 1], averaged over the footprint.
  virtual float fraction(const SurfacePoint&) const = 0;
  virtual const char* first_name() const { return "first"; }
  virtual const char* second_name() const { return "second"; }
};

/// A solid texture: a function of the position in space.
class SolidMap : public BlendMap {
 public:
  float size = 1;
  MapSpace space = MapSpace::object;
  std::uint32_t seed = 0;

 protected:
  SolidMap() : BlendMap(0, 1) {}
  virtual float fraction(const SolidPoint&) const = 0;

 private:
  float fraction(const SurfacePoint& p) const final { return clamp(fraction(solid_point(p, space, size)), 0, 1); }
};

template <class Map>
Description<Map>& describe_solid(Description<Map>& d, const char* size) {
  return d.group("Colours")
      .template member<&Map::first>("first", "1", "the map where the texture is 0")
      .template member<&Map::second>("second", "1", "the map where it is 1")
      .group("Place")
      .template member<&Map::size>("size", "m", std::string(size) + "; in the space uv, of the surface coordinates",
                                   more_than(0), soft(0.01, 100), logarithmic)
      .template member<&Map::space>("space", "", "what coordinates it is cut out of", choices("object", "world", "uv"))
      .template member<&Map::seed>("seed", "1", "chooses one of many textures of the same kind");
}

/// A solid texture that is or uses a sum of octaves of noise.
class FractalMap : public SolidMap {
 public:
  void prepare() override {
    SolidMap::prepare();
    noise_ = {octaves, lacunarity, gain, seed};
  }

  int octaves = 8;
  float lacunarity = 2, gain = 0.5f;

 protected:
  const Octaves& noise() const { return noise_; }

 private:
  Octaves noise_;
};

template <class Map>
Description<Map>& describe_fractal(Description<Map>& d, const char* size) {
  return describe_solid(d, size)
      .group("Noise")
      .template member<&Map::octaves>("octaves", "1", "how many sizes of features are added", range(1, 24), soft(1, 12))
      .template member<&Map::lacunarity>("lacunarity", "1", "how much finer each size is than the one before", range(1, 16),
                                         soft(1, 4), unless("octaves", 1))
      .template member<&Map::gain>("gain", "1", "how much weaker each size is than the one before", range(0, 1),
                                   unless("octaves", 1));
}

inline constexpr const char* noise_source = "Perlin 1985, \"An image synthesizer\"; Perlin 2002, \"Improving noise\"";

}  // namespace etendue
