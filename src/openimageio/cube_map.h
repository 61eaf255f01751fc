#pragma once
// Cubes of surroundings, as OpenEXR has them, in longitude and latitude.

#include <vector>

namespace etendue {

/// The six square faces of a cube below each other, +x, -x, +y, -y, +z and -z; each as OpenEXR turns it (ImfEnvmap.h). The
/// middles of the outermost pixels of a face lie on the cube's edges.
///
/// As a picture it is in longitude and latitude, as Environment's u and v go: its top is +y, its middle +z, its left and right
/// edges are -z, the middle of its left half is +x. It is four faces wide and two high, so that its texels at the horizon are
/// as large as those of the faces.
class CubeMap {
 public:
  CubeMap(std::vector<float> pixels, int side, int channels) : pixels_(std::move(pixels)), side_(side), channels_(channels) {}

  int width() const { return 4 * side_; }
  int height() const { return 2 * side_; }
  /// A row of the picture from the top: the means over its texels.
  void row(int y, float* out) const;

 private:
  /// Adds what is seen in a direction, times a weight.
  void add(double x, double y, double z, double weight, double* sum) const;

  std::vector<float> pixels_;
  int side_, channels_;
};

}  // namespace etendue
