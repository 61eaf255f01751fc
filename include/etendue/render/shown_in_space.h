#pragma once
// ShownInSpace: the parts of a process's light that a viewer can display in space (photons, guide lobes). A process that has
// such data also derives from this class; viewers test for this interface, not for a class of process.

#include <cstddef>
#include <optional>
#include <vector>

#include "etendue/core/spectrum.h"
#include "etendue/core/vector.h"

namespace etendue {

/// A photon for display.
struct ShownPhoton {
  Point3 position;       ///< in rendering coordinates
  Vector3 direction;     ///< unit, the way the light went
  Xyz power;             ///< the flux it represents, as CIE XYZ (the units of radiance times m^2 sr)
  int segments = 0;      ///< from the emitter to it
  bool caustic = false;  ///< it came by a specular chain of one vertex or more
  bool in_medium = false;
};

/// A subset of the photons, and how many there are.
struct ShownPhotons {
  std::vector<ShownPhoton> some;
  size_t all = 0;
};

/// The pdf of directions at a point, as a guide has learned it.
struct ShownLobes {
  static constexpr int rows = 32, columns = 64;
  /// [1/sr], the mean over each cell: rows by equal steps of z from 1 to -1, columns by equal steps of the angle from x
  /// towards y; so all cells have the same solid angle.
  std::vector<float> pdf;
  float share = 0;  ///< the probability with which the guide is sampled instead of the BSDF; 0: nothing is learned yet
  /// The direction at a point of a cell, by default its middle; both coordinates in [0, 1].
  static Vector3 direction(int row, int column, float down = 0.5f, float along = 0.5f);
};

class ShownInSpace {
 public:
  /// At most so many of its photons, evenly chosen. Nothing: the process stores no photons.
  virtual std::optional<ShownPhotons> photons(size_t /*most*/) const { return {}; }
  /// At a point of a surface, with the normal on the viewed side. Nothing: the process has no guide.
  virtual std::optional<ShownLobes> lobes(const Point3&, const Normal3&) const { return {}; }

 protected:
  ~ShownInSpace() = default;
};

}  // namespace etendue
