#pragma once
// Whether what shines in a model lights it.

#include <vector>

#include "document.h"
#include "etendue/core/transform.h"

namespace etendue::gltf {

class Glow {
 public:
  explicit Glow(const Document& document) : document_(document) {}

  /// A primitive of the mesh that is being made shines, with a mean luminance.
  void shine(size_t mesh, size_t primitive, double luminance);
  /// Area vectors of triangles times their luminances.
  using Areas = std::vector<Vector3>;
  /// Of the primitives that shone since then, in the mesh's own coordinates.
  Areas taken();
  /// A mesh of which that shines stands somewhere.
  void stand(size_t mesh, const Transform&, const Areas&);
  /// Whether all of it makes lamps of them.
  bool lights() const;

 private:
  const Document& document_;
  Areas shining_;
  double sum_ = 0;
  std::vector<std::pair<size_t, Transform>> placed_;
};

}  // namespace etendue::gltf
