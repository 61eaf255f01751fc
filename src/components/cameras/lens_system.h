#pragma once
// A lens: spherical surfaces on one axis, and the paths of rays through them.

#include <string>
#include <vector>

#include "etendue/core/vector.h"

namespace etendue {

/// One of a lens's surfaces, as lens tables have them, from the front (the scene) to the rear (the film).
struct LensSurface {
  double radius = 0;     ///< of curvature, positive when its centre is towards the film [m]; 0: a plane
  double thickness = 0;  ///< to the next surface [m]; of the last it does not count
  double index = 1;      ///< of refraction of what lies behind it, towards the film; 0 as 1: air
  double diameter = 0;   ///< of what lets light through [m]
};

/// Numbers in fours as text, without units; `#` begins a comment. Throws Error with the reason.
std::vector<double> read_lens_file(const std::string& path);
/// Such numbers, times `unit` [m]. Throws Error.
std::vector<LensSurface> lens_surfaces(const std::vector<double>& numbers, double unit);
/// Where its stop is: planes with the same on both sides, which nothing but a stop can be.
bool is_stop(const std::vector<LensSurface>&, size_t i);

struct LensRay {
  DoublePoint3 origin;
  DoubleVector3 direction;  ///< unit

  /// Where it meets a plane across the axis.
  DoublePoint3 at(double z) const { return origin + ((z - origin.z) / direction.z) * direction; }
};

/// Coordinates are those of a camera: the film is the plane z = 0, the scene towards +z.
class LensSystem {
 public:
  /// Throws Error when what it is given is no lens that makes images.
  void set(const std::vector<LensSurface>&);
  /// Moves it so that a point so far from the film is sharp on it [m]. Throws Error when that is too near.
  void focus(double distance);

  double focal_length() const { return focal_length_; }      ///< [m]
  double back_focus() const { return back_focus_; }          ///< from the rear vertex to the rear focal point [m]
  double image_distance() const { return image_distance_; }  ///< from the rear principal plane to the film [m]
  double rear() const { return surfaces_.back().vertex; }    ///< z of the rear vertex
  double front() const { return surfaces_.front().vertex; }
  double rear_radius() const;  ///< of what lets light through at the rear

  /// From the film to the scene, and back. False: it is held back by a rim or the stop, or reflected totally.
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
