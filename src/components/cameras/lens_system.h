#pragma once
// LensSystem: a lens of coaxial spherical surfaces, and ray tracing through it.

#include <string>
#include <vector>

#include "etendue/core/vector.h"

namespace etendue {

/// One of a lens's surfaces, as lens tables have them, from the front (the scene) to the rear (the film).
struct LensSurface {
  double radius = 0;     ///< of curvature, positive when its centre is towards the film [m]; 0: a plane
  double thickness = 0;  ///< distance to the next surface [m]; not used of the last surface
  double index = 1;      ///< index of refraction behind the surface, towards the film; 0, like 1, is air
  double diameter = 0;   ///< of the clear aperture [m]
};

/// Reads a lens table, text with four numbers for each surface, without units; `#` begins a comment. Throws Error with the
/// reason.
std::vector<double> read_lens_file(const std::string& path);
/// The surfaces given by such numbers, with lengths multiplied by `unit` [m]. Throws Error.
std::vector<LensSurface> lens_surfaces(const std::vector<double>& numbers, double unit);
/// Whether surface i is a stop: a plane with the same index on both sides, which has no other purpose.
bool is_stop(const std::vector<LensSurface>&, size_t i);

struct LensRay {
  DoublePoint3 origin;
  DoubleVector3 direction;  ///< unit

  /// The intersection with the plane perpendicular to the axis at z.
  DoublePoint3 at(double z) const { return origin + ((z - origin.z) / direction.z) * direction; }
};

/// In camera coordinates: the film is the plane z = 0, the scene lies towards +z.
class LensSystem {
 public:
  /// Throws Error if the surfaces do not form a lens that makes images.
  void set(const std::vector<LensSurface>&);
  /// Moves the lens so that a point at this distance from the film [m] is in focus. Throws Error if the distance is too small.
  void focus(double distance);

  double focal_length() const { return focal_length_; }      ///< [m]
  double back_focus() const { return back_focus_; }          ///< from the rear vertex to the rear focal point [m]
  double image_distance() const { return image_distance_; }  ///< from the rear principal plane to the film [m]
  double rear() const { return surfaces_.back().vertex; }    ///< z of the rear vertex
  double front() const { return surfaces_.front().vertex; }
  double rear_radius() const;  ///< of the clear aperture of the rear surface [m]

  /// Trace a ray from the film to the scene, and from the scene to the film. False: the ray is blocked by a rim or the stop, or
  /// totally reflected.
  bool outwards(LensRay& ray) const;
  bool inwards(LensRay& ray) const;

 private:
  struct Surface {
    double vertex = 0, radius = 0, open_squared = 0;
    double front_index = 1, rear_index = 1;
  };
  static bool pass(const Surface&, double from, double to, LensRay&);

  std::vector<Surface> surfaces_;  // from the front to the rear
  double focal_length_ = 0, back_focus_ = 0, front_focus_ = 0, length_ = 0, image_distance_ = 0;
};

}  // namespace etendue
