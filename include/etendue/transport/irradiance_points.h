#pragma once
// Irradiance found beforehand where photons lie (Christensen 1999, "Faster photon map global illumination"): a final gathering
// then looks up one point in place of many photons.

#include "etendue/transport/photons.h"

namespace etendue {

class IrradiancePoints {
 public:
  /// Which photons an estimate takes: the `nearest` ones of those within `farthest` [m].
  struct Estimate {
    size_t nearest = 0;
    float farthest = 0;
    double walks = 1;  ///< n
    float time = 0;    ///< [s]
  };
  /// At every fourth photon on a surface.
  static constexpr size_t every = 4;
  void find(const Scene&, const PhotonMap&, const Estimate&);

  /// Irradiance [W/(m^2 nm)] at the point nearest to a vertex whose surface is turned as the vertex's on the side of `out`;
  /// null: there is none within `farthest`.
  const Spectrum* at(const PathVertex&) const;

 private:
  struct Point {
    Point3 position;
    Vector3 normal;  ///< on the side it counts for
    Spectrum value;
  };
  PointTree tree_;
  std::vector<Point> points_;
  float farthest_ = 0;
  const Scene* scene_ = nullptr;
};

}  // namespace etendue
