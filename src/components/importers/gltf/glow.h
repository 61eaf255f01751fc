#pragma once
// Decides whether the emissive surfaces of a model are strong enough to light it.

#include <vector>

#include "document.h"
#include "etendue/core/transform.h"

namespace etendue::gltf {

class Glow {
 public:
  explicit Glow(const Document& document) : document_(document) {}

  /// Adds an emissive primitive of the current mesh, with its mean luminance.
  void shine(size_t mesh, size_t primitive, double luminance);
  /// Area vectors of triangles, multiplied by their luminance.
  using Areas = std::vector<Vector3>;
  /// Those added since the last call, in the mesh's object space.
  Areas taken();
  /// Adds an instance of a mesh with these emissive areas.
  void stand(size_t mesh, const Transform&, const Areas&);
  /// Whether the total emission lights the model.
  bool lights() const;

 private:
  const Document& document_;
  Areas shining_;
  double sum_ = 0;
  std::vector<std::pair<size_t, Transform>> placed_;
};

}  // namespace etendue::gltf
