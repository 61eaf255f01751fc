#pragma once
// The transforms of a glTF file's nodes at a time, and the weights of their morph targets.

#include "document.h"
#include "etendue/core/transform.h"

namespace etendue::gltf {

/// Plays all animations together.
constexpr size_t every_animation = SIZE_MAX;
/// The displayed state of a file: time and animation.
struct Moment {
  double time = 0;                  ///< [s]
  std::optional<size_t> animation;  ///< none: the nodes' own transforms
  bool operator==(const Moment&) const = default;
};

class Pose {
 public:
  /// Throws Error if a node is its own descendant or has two parents.
  Pose(const Document&, const Moment&);

  /// From a node's space to that of the scene.
  const Transform& global(size_t node) const { return globals_.at(node); }
  /// Morph target weights of a node's mesh.
  std::vector<double> weights(size_t node) const;
  /// Whether the animation changes the weights of the node's mesh.
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

/// The transform of translation, rotation (a quaternion x y z w) and scale; the scale is applied first.
Transform composed(const std::array<double, 3>& translation, std::array<double, 4> rotation,
                   const std::array<double, 3>& scale);

/// Whether the file has any animation.
bool has_animation(const Document&);

}  // namespace etendue::gltf
