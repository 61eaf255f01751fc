#include "turns.h"

#include <fmt/format.h>

#include <cmath>

#include "etendue/describe/component.h"

namespace etendue::language {
namespace {

/// The only call of `rotate` among the factors of a transform; null: there is none, or there are several.
const Node* only_turn(const Node& node) {
  if (node.type == NodeType::call) return node.text == "rotate" && node.numbers ? &node : nullptr;
  if (node.type != NodeType::product) return nullptr;
  const Node* only = nullptr;
  for (const Node& factor : node.children) {
    const Node* turn = only_turn(factor);
    if (turn && only) return nullptr;
    if (turn) only = turn;
  }
  return only;
}

}  // namespace

// The numbers of the node become: the angle [deg], and the axis as a unit vector.
void note_turn(Node& rotate, const std::vector<Value>& arguments) {
  const auto* angle = arguments[0].as<Number>();
  if (!angle) return;
  const double degrees = angle->dimension == Dimension::angle ? angle->value * (180 / M_PI) : angle->value;
  std::vector<double> axis(3, 0);
  if (const auto* letter = arguments[1].as<std::string>()) {
    axis[size_t(letter->front() - 'x')] = 1;
  } else if (const auto* vector = arguments[1].as<Numbers>()) {
    axis = vector->values;
    const double norm = std::hypot(axis[0], axis[1], axis[2]);
    for (double& x : axis) x /= norm;
  }
  rotate.numbers = std::make_unique<Numbers>(Numbers{{degrees, axis[0], axis[1], axis[2]}, 1, Dimension::none});
}

bool warn_of_long_turns(const Node& keyframes) {
  bool warned = false;
  for (size_t i = 3; i < keyframes.children.size(); i += 2) {
    const Node *before = only_turn(keyframes.children[i - 2]), *after = only_turn(keyframes.children[i]);
    if (!before || !after) continue;
    const std::vector<double>&a = before->numbers->values, &b = after->numbers->values;
    const double cosine = a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
    if (std::abs(cosine) < 0.999999) continue;
    const double turn = std::copysign(b[0], b[0] * cosine) - a[0];
    if (std::abs(turn) <= 180 + 1e-4) continue;
    const double shorter = std::remainder(turn, 360.0);
    warn(fmt::format("the rotation of {:.6g} degrees from the previous key takes the shorter way, {:.6g} degrees: put keys "
                     "between them, at most 180 degrees apart",
                     turn, shorter),
         after->at);
    warned = true;
  }
  return warned;
}

}  // namespace etendue::language
