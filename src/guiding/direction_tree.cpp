#include "etendue/guiding/direction_tree.h"

#include <algorithm>
#include <cmath>

#include "etendue/core/warp.h"
#include "guiding/saved_bytes.h"

namespace etendue {
namespace {

Point2 to_square(const Vector3& d) {
  const float turn = std::atan2(d.y, d.x) * (inverse_pi / 2);
  return {clamp((d.z + 1) / 2, 0, one_minus_epsilon), clamp(turn < 0 ? turn + 1 : turn, 0, one_minus_epsilon)};
}

Vector3 to_direction(const Point2& p) {
  const float z = 2 * p.x - 1, r = safe_sqrt((1 - z) * (1 + z));
  float sine = 0, cosine = 0;
  sin_cos_turn(p.y, sine, cosine);
  return {r * cosine, r * sine, z};
}

/// Which of four cells a point lies in, and the point within it.
int enter_cell(Point2& p) {
  const int right = p.x >= 0.5f, upper = p.y >= 0.5f;
  p = {2 * p.x - float(right), 2 * p.y - float(upper)};
  return right + 2 * upper;
}

}  // namespace

float DirectionTree::density(const Vector3& direction) const {
  Point2 p = to_square(direction);
  float density = warp::sphere_density;
  for (std::uint32_t node = 0;;) {
    const Node& n = nodes_[node];
    const int cell = enter_cell(p);
    density *= n.weight[cell];
    node = n.child[cell];
    if (node == 0 || density == 0) return density;
  }
}

Vector3 DirectionTree::sample(Point2 u, float& density) const {
  Point2 low{0, 0};
  float side = 1;
  density = warp::sphere_density;
  // Chooses one of two by their weights and makes the number fresh again.
  const auto choose = [](float first, float second, float& number) {
    const float q = first / (first + second);
    const bool other = !(number < q);
    number = clamp(other ? (number - q) / (1 - q) : number / q, 0, one_minus_epsilon);
    return int(other);
  };
  for (std::uint32_t node = 0;;) {
    const Node& n = nodes_[node];
    const int right = choose(n.weight[0] + n.weight[2], n.weight[1] + n.weight[3], u.x);
    const int upper = choose(n.weight[right], n.weight[right + 2], u.y);
    side /= 2;
    low = {low.x + float(right) * side, low.y + float(upper) * side};
    density *= n.weight[right + 2 * upper];
    node = n.child[right + 2 * upper];
    if (node == 0) break;
  }
  return to_direction({low.x + u.x * side, low.y + u.y * side});
}

void DirectionTree::add(const Vector3& direction, double value, Point2 jitter) {
  if (!(value > 0) || !std::isfinite(value)) return;
  const Point2 at = to_square(direction);
  float side = 1;
  Point2 p = at;
  for (std::uint32_t node = 0;;) {
    side /= 2;
    node = nodes_[node].child[enter_cell(p)];
    if (node == 0) break;
  }
  // Round the axis it goes on; at the poles it comes back.
  float x = at.x + (jitter.x - 0.5f) * side, y = at.y + (jitter.y - 0.5f) * side;
  x = x < 0 ? -x : x > 1 ? 2 - x : x;
  y -= std::floor(y);
  p = {std::min(x, one_minus_epsilon), std::min(y, one_minus_epsilon)};
  for (std::uint32_t node = 0;;) {
    Node& n = nodes_[node];
    const int cell = enter_cell(p);
    node = n.child[cell];
    if (node == 0) {
      n.sum[cell] += value;
      return;
    }
  }
}

bool DirectionTree::refine(GuideTarget target, float fraction, size_t most_nodes) {
  // What each cell weighs, from the leaves up: children come after their parents.
  std::vector<double> area(nodes_.size(), 0.25);  // of a node's cells
  for (size_t i = 0; i < nodes_.size(); ++i)
    for (const std::uint32_t child : nodes_[i].child)
      if (child) area[child] = area[i] / 4;
  std::vector<double> whole(nodes_.size(), 0);
  for (size_t i = nodes_.size(); i-- > 0;)
    for (int c = 0; c < 4; ++c) {
      double& w = nodes_[i].sum[c];
      w = nodes_[i].child[c] ? whole[nodes_[i].child[c]] : target == GuideTarget::second_moment ? std::sqrt(w * area[i]) : w;
      whole[i] += w;
    }
  if (!(whole[0] > 0)) return false;

  // The new tree, level by level, so that where memory ends it is the finest cells that are left out. A cell that was not
  // divided before is the same everywhere within.
  struct Part {
    std::uint32_t old;  // nobody: even
    double weight;      // of the whole
    int depth;
  };
  static constexpr std::uint32_t nobody = ~0u;
  std::vector<Node> made(1);
  std::vector<Part> parts{{0, 1, 1}};
  for (size_t i = 0; i < parts.size(); ++i) {
    const Part part = parts[i];
    for (int c = 0; c < 4; ++c) {
      const Node* old = part.old == nobody ? nullptr : &nodes_[part.old];
      const double relative = old ? 4 * old->sum[c] / whole[part.old] : 1, weight = part.weight * relative / 4;
      made[i].weight[c] = float(relative);
      if (weight > double(fraction) && part.depth < deepest && made.size() < most_nodes) {
        made[i].child[c] = std::uint32_t(made.size());
        made.emplace_back();
        parts.push_back({old && old->child[c] ? old->child[c] : nobody, weight, part.depth + 1});
      }
    }
  }
  made.shrink_to_fit();
  nodes_ = std::move(made);
  return true;
}

void DirectionTree::save(std::vector<std::byte>& to) const { append_all(to, nodes_); }

void DirectionTree::load(std::span<const std::byte>& from) {
  std::vector<Node> read = take_all<Node>(from);
  for (size_t i = 0; i < read.size(); ++i)
    for (int c = 0; c < 4; ++c) {
      const Node& n = read[i];
      const bool ahead = n.child[c] == 0 || (n.child[c] > i && n.child[c] < read.size());
      if (!ahead || !(n.weight[c] >= 0 && n.weight[c] <= 4) || !(n.sum[c] >= 0) || !std::isfinite(n.sum[c]))
        throw Error("a guide's directions are damaged");
    }
  if (read.empty()) throw Error("a guide's directions are damaged");
  nodes_ = std::move(read);
}

}  // namespace etendue
