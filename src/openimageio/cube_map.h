#pragma once
// Resamples OpenEXR's cube maps to longitude and latitude.

#include <vector>

namespace etendue {

/// The six square faces of a cube below each other, +x, -x, +y, -y, +z and -z, each oriented as in OpenEXR (ImfEnvmap.h). The
/// centres of a face's outermost pixels lie on the edges of the cube.
///
/// The resulting image is in longitude and latitude, with the u and v of Environment: its top is +y, its centre +z, its left
/// and right edges are -z, the centre of its left half is +x. It is four faces wide and two high, so that its texels at the
/// horizon are as large as those of the faces.
class CubeMap {
 public:
  CubeMap(std::vector<float> pixels, int side, int channels) : pixels_(std::move(pixels)), side_(side), channels_(channels) {}

  int width() const { return 4 * side_; }
  int height() const { return 2 * side_; }
  /// A row of the image, from the top: the means over its texels.
  void row(int y, float* out) const;

 private:
  /// Adds the radiance from a direction, multiplied by a weight.
  void add(double x, double y, double z, double weight, double* sum) const;

  std::vector<float> pixels_;
  int side_, channels_;
};

}  // namespace etendue
