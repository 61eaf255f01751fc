#pragma once
// Where the nodes of a glTF file are at a time, and how much their morph targets weigh.

#include "document.h"
#include "etendue/core/transform.h"

namespace etendue::gltf {

/// All animations at once.
constexpr size_t every_animation = SIZE_MAX;
/// What of a file is shown: the time and the animation.
struct Moment {
  double time = 0;                  ///< [s]
  std::optional<size_t> animation;  ///< none: as the nodes say
  bool operator==(const Moment&) const = default;
};

class Pose {
 public:
  /// Throws Error when nodes are their own descendants or have two parents.
  Pose(const Document&, const Moment&);

  /// From a node's coordinates to the scene's.
  const Transform& global(size_t node) const { return globals_.at(node); }
  /// Of the mesh of a node.
  std::vector<double> weights(size_t node) const;
  /// Whether the animation changes weights of the node's mesh.
  bool morphs(size_t node) const { return animated_.at(node).weights.has_value(); }

 private:
  struct Animated {
    std::optional<std::array<double, 3>> translation, scale;
    std::optional<std::array<double, 4>> rotation;
    std::optional<std::vector<double>> weights;
  };
  void animate(const Json& animation, double time);
  Transform local(size_t node) const;

  const Document& document_;
  std::vector<Animated> animated_;
  std::vector<Transform> globals_;
};

/// Translation, rotation (a quaternion x y z w) and scale; the scale first.
Transform composed(const std::array<double, 3>& translation, std::array<double, 4> rotation,
                   const std::array<double, 3>& scale);

/// Whether nodes of the file can move at all.
bool has_animation(const Document&);

}  // namespace etendue::gltf
