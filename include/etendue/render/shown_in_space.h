#pragma once
// ShownInSpace: what a process holds of light that people can look at in space. A process that has something of the kind is one
// of these as well; whoever shows it asks for that, and for no class.

#include <cstddef>
#include <optional>
#include <vector>

#include "etendue/core/spectrum.h"
#include "etendue/core/vector.h"

namespace etendue {

/// Light that came to a place.
struct ShownPhoton {
  Point3 position;       ///< as the renderer counts
  Vector3 direction;     ///< unit, the way the light went
  Xyz power;             ///< its part of all light that left luminaires, as CIE XYZ of the flux (that of radiance times m^2 sr)
  int segments = 0;      ///< from the luminaire to it
  bool caustic = false;  ///< it came by specular scattering alone, once or more
  bool in_medium = false;
};

/// Some of what there is.
struct ShownPhotons {
  std::vector<ShownPhoton> some;
  size_t all = 0;
};

/// How likely directions are at a place, as a guide has learned it.
struct ShownLobes {
  static constexpr int rows = 32, columns = 64;
  /// [1/sr], the mean over each cell: rows by equal steps of z from 1 to -1, columns by equal steps of the angle from x
  /// towards y; so all cells have the same solid angle.
  std::vector<float> pdf;
  float share = 0;  ///< the probability with which the guide is asked, and not the surface; 0: nothing is learned yet
  /// The direction of the middle of a cell, or of another point of it, both coordinates in [0, 1].
  static Vector3 direction(int row, int column, float down = 0.5f, float along = 0.5f);
};

class ShownInSpace {
 public:
  /// At most so many of its photons, evenly chosen. None: it keeps none.
  virtual std::optional<ShownPhotons> photons(size_t /*most*/) const { return {}; }
  /// Of a surface, with its normal on the side that is looked at. None: it has no guide.
  virtual std::optional<ShownLobes> lobes(const Point3&, const Normal3&) const { return {}; }

 protected:
  ~ShownInSpace() = default;
};

}  // namespace etendue
