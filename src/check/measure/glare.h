#pragma once
// Discomfort glare from a picture of what an eye sees: its sources, UGR and DGP. The formulas stand in glare.cpp.

#include <string>
#include <vector>

#include "etendue/core/image.h"

namespace etendue::measure {

/// How directions lie in a picture. The view direction is in its middle, up is upwards.
enum class FisheyeMapping : std::uint8_t {
  equirectangular,  ///< of a SphericalCamera: the whole sphere by longitude and latitude, twice as wide as high
  equal_area,       ///< of a SphericalCamera: the whole sphere in a square
  angular,          ///< the distance from the middle is proportional to the angle (equidistant fisheye; Radiance's -vta)
  hemispherical,    ///< the distance from the middle is the sine of the angle (orthographic fisheye; Radiance's -vth)
};

struct GlareOptions {
  FisheyeMapping mapping = FisheyeMapping::equirectangular;
  double angle = 180;    ///< across an angular picture [deg]
  double threshold = 0;  ///< luminance from which a pixel belongs to a source [cd/m2]; 0: `factor` decides
  double factor = 5;     ///< the threshold as a multiple of the mean luminance in front of the eye
  double peak = 50000;   ///< luminance from which pixels are sources of their own within others [cd/m2]; 0: none are
  double yaw = 0;        ///< turns the view to the right of the picture's middle [deg]
  double pitch = 0;      ///< and upwards [deg]
  double luminance_of =
      0;  ///< cd/m2 of Y = 1; 0: as in pictures of this program, 683 lm/W times the integral of the observer's y
};

/// Adjacent pixels above the threshold.
struct GlareSource {
  int pixels = 0;
  double luminance = 0;               ///< the mean over its solid angle [cd/m2]
  double maximum = 0;                 ///< of its pixels [cd/m2]
  double solid_angle = 0;             ///< [sr]
  double illuminance = 0;             ///< that it gives on the plane of the eye [lx]
  double azimuth = 0, elevation = 0;  ///< of its centre of light: to the right of the view direction, and above [deg]
  double position_index = 1;          ///< at that centre
};

struct Glare {
  double illuminance = 0;  ///< on the plane of the eye, from everything in front of it [lx]
  double background = 0;   ///< luminance of the background: illuminance without that of the sources, over pi [cd/m2]
  double mean = 0;         ///< luminance, over the solid angle of what is in front of the eye [cd/m2]
  double threshold = 0;    ///< that was used [cd/m2]
  double covered = 0;      ///< solid angle of the picture in front of the eye [sr]; 2 pi is all
  double ugr = 0;          ///< -infinity without sources, +infinity before a black background
  double dgp = 0;
  std::vector<GlareSource> sources;  ///< by falling share in the sum of both formulas, L^2 w / P^2
  std::vector<std::string> notes;    ///< where a formula is used outside of the range that it was made for
};

/// The position index of a source seen `azimuth` to the right and `elevation` above the view direction [deg].
double position_index(double azimuth, double elevation);

/// Throws Error if the picture has not the shape of its mapping, a pixel is not finite, or the picture is black.
Glare glare_of(const Image&, const GlareOptions&);

/// A table for people, and JSON.
std::string glare_text(const Glare&);
std::string glare_json(const Glare&);

}  // namespace etendue::measure
