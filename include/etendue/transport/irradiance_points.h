#pragma once
// IrradiancePoints: irradiance precomputed at photons, for final gathering (Christensen 1999, "Faster photon map global
// illumination"). A final gather ray then looks up one point, with the estimate
//     E = sum_p alpha_p / (n pi r^2)   [W/(m^2 nm)]
// (Jensen 2001, section 7.1; photons.h), in place of many photons.

#include "etendue/transport/photons.h"

namespace etendue {

class IrradiancePoints {
 public:
  struct Point {
    Point3 position;
    Vector3 normal;  ///< on the side that the irradiance arrives at
    Spectrum value;
  };
  /// Computes the irradiance at every fourth photon, if it is on a surface: work for Schedule::collect<Point>(work.items(),
  /// work). An estimate is of the `nearest` photons within the distance `farthest`.
  struct Work {
    const Scene& scene;
    const PhotonMap& map;
    size_t nearest = 0;
    float farthest = 0;  ///< [m]
    double walks = 1;    ///< n, the number of light subpaths
    float time = 0;      ///< [s]

    static constexpr size_t every = 4;
    std::uint64_t items() const;
    void operator()(std::uint64_t item, std::vector<Point>&, Arena&) const;
  };
  void build(const Work&, std::vector<Point>&&);

  /// The irradiance [W/(m^2 nm)] at the point nearest to a vertex whose normal agrees with that of the vertex on the side of
  /// `out`; null: there is none within `farthest`.
  const Spectrum* at(const PathVertex&) const;

 private:
  PointTree tree_;
  std::vector<Point> points_;
  float farthest_ = 0;
  const Scene* scene_ = nullptr;
};

}  // namespace etendue
