#include "light_tree.h"

#include <algorithm>

namespace etendue {
namespace {

/// A cone that contains two cones.
NormalCone around(const NormalCone& a, const NormalCone& b) {
  if (a.cosine <= -1 || b.cosine <= -1) return {};
  const float angle_a = std::acos(clamp(a.cosine, -1, 1)), angle_b = std::acos(clamp(b.cosine, -1, 1));
  const float between = std::acos(clamp(dot(a.axis, b.axis), -1, 1));
  if (between + angle_b <= angle_a) return a;
  if (between + angle_a <= angle_b) return b;
  const float angle = 0.5f * (angle_a + between + angle_b) + 1e-5f;
  if (angle >= pi) return {};
  // The axis of a, rotated towards the axis of b.
  const Vector3 across = b.axis - dot(a.axis, b.axis) * a.axis;
  const float l = length(across);
  if (!(l > 1e-6f)) return dot(a.axis, b.axis) > 0 ? NormalCone{a.axis, std::cos(angle)} : NormalCone{};
  const float turn = angle - angle_a;
  return {std::cos(turn) * a.axis + (std::sin(turn) / l) * across, std::cos(angle)};
}

/// The solid angle into which the cluster emits, weighted by the cosine (Conty Estevez & Kulla 2018, eq. 1, with 90 degrees of
/// emission).
float emission_measure(const NormalCone& cone) {
  const float o = std::acos(clamp(cone.cosine, -1, 1)), w = std::min(o + pi / 2, pi);
  return 2 * pi * (1 - std::cos(o)) + pi / 2 * (2 * w * std::sin(o) - std::cos(o - 2 * w) - 2 * o * std::sin(o) + std::cos(o));
}

float surface_area(const Vector3& d) { return 2 * (d.x * d.y + d.y * d.z + d.z * d.x); }

/// The cost of a node with these emitters: the surface area orientation heuristic (Conty Estevez & Kulla 2018, eq. 2).
float cost(const LightBounds& l) {
  if (l.empty()) return 0;
  const Vector3 d = l.bounds.diagonal();
  const float longest = std::max({d.x, d.y, d.z});
  // The squared longest side keeps the cost of a flat or thin box above zero.
  return l.power * emission_measure(l.normals) * (surface_area(d) + 1e-3f * longest * longest);
}

/// cos(max(a - b, 0)) from the sines and cosines of a and b.
float cosine_of_rest(float sin_a, float cos_a, float sin_b, float cos_b) {
  return cos_a > cos_b ? 1 : cos_a * cos_b + sin_a * sin_b;
}
float sine_of_rest(float sin_a, float cos_a, float sin_b, float cos_b) {
  return cos_a > cos_b ? 0 : sin_a * cos_b - cos_a * sin_b;
}

}  // namespace

void LightBounds::add(const LightBounds& l) {
  if (l.empty()) return;
  if (empty()) {
    *this = l;
    return;
  }
  bounds.add(l.bounds);
  normals = around(normals, l.normals);
  both_sides |= l.both_sides;
  power += l.power;
}

void LightTree::build(std::span<const LightBounds> lights) {
  nodes_.clear();
  leaves_.assign(lights.size(), 0);
  if (lights.empty()) return;
  std::vector<Item> items;
  items.reserve(lights.size());
  for (size_t i = 0; i < lights.size(); ++i) items.push_back({lights[i], std::uint32_t(i)});
  nodes_.reserve(2 * items.size());
  split(items, 0, 0);
}

void LightTree::place(Node& node, const LightBounds& l) const {
  node.centre = l.bounds.centre();
  node.half = 0.5f * l.bounds.diagonal();
  node.axis = l.normals.axis;
  node.cosine = l.normals.cosine;
  node.power = l.power;
  node.both_sides = l.both_sides;
}

LightBounds LightTree::split(std::span<Item> items, std::uint32_t parent, int depth) {
  const std::uint32_t self = std::uint32_t(nodes_.size());
  nodes_.emplace_back().parent = parent;
  LightBounds all;
  if (items.size() == 1) {
    all = items[0].light;
    nodes_[self].leaf = true;
    nodes_[self].right = items[0].emitter;
    leaves_[items[0].emitter] = self;
  } else {
    const size_t middle = partition(items, depth);
    all = split(items.subspan(0, middle), self, depth + 1);
    nodes_[self].right = std::uint32_t(nodes_.size());
    all.add(split(items.subspan(middle), self, depth + 1));
  }
  place(nodes_[self], all);
  return all;
}

size_t LightTree::partition(std::span<Item> items, int depth) {
  constexpr int bins = 12, deepest = 64;
  Bounds3 centres;
  for (const Item& i : items) centres.add(i.light.bounds.centre());
  const Vector3 extent = centres.diagonal();
  const float longest = std::max({extent.x, extent.y, extent.z});
  const auto bin_of = [&](const Item& i, int axis) {
    const float x = (i.light.bounds.centre()[axis] - centres.low[axis]) / extent[axis];
    return std::min(int(x * bins), bins - 1);
  };
  float best = infinity;
  int best_axis = -1, best_bin = 0;
  for (int axis = 0; axis < 3 && depth < deepest; ++axis) {
    if (!(extent[axis] > 0)) continue;
    LightBounds bin[bins], below[bins];
    for (const Item& i : items) bin[bin_of(i, axis)].add(i.light);
    LightBounds sum;
    for (int k = 0; k < bins; ++k) {
      sum.add(bin[k]);
      below[k] = sum;
    }
    sum = {};
    for (int k = bins - 1; k > 0; --k) {
      sum.add(bin[k]);
      if (sum.empty() || below[k - 1].empty()) continue;
      // Splitting across the longest side is preferred.
      const float c = longest / extent[axis] * (cost(below[k - 1]) + cost(sum));
      if (c < best) {
        best = c;
        best_axis = axis;
        best_bin = k;
      }
    }
  }
  if (best_axis >= 0) {
    const auto middle =
        std::partition(items.begin(), items.end(), [&](const Item& i) { return bin_of(i, best_axis) < best_bin; });
    const size_t n = size_t(middle - items.begin());
    if (n > 0 && n < items.size()) return n;
  }
  return items.size() / 2;
}

float LightTree::importance(const Node& node, const Point3& point, const Normal3& normal) {
  const float value = mean(node, point, normal);
  if (!(value > 0)) return 1e-3f * bound(node, point, normal);
  // A cluster whose emission the quadrature points nearly miss keeps a minimum importance.
  return value + 1e-3f * node.power / (distance_squared(point, node.centre) + length_squared(node.half) + 1e-30f);
}

float LightTree::mean(const Node& node, const Point3& point, const Normal3& normal) {
  using Floats = float __attribute__((vector_size(8 * sizeof(float))));
  constexpr float g = 0.57735027f;  // 1 / sqrt(3)
  const Floats sx = {-g, g, -g, g, -g, g, -g, g}, sy = {-g, -g, g, g, -g, -g, g, g}, sz = {-g, -g, -g, -g, g, g, g, g};
  const Vector3 d = point - node.centre;
  const Floats x = d.x - sx * node.half.x, y = d.y - sy * node.half.y, z = d.z - sz * node.half.z;
  const Floats d2 = x * x + y * y + z * z;
  // A quadrature point represents an eighth of the box: distances below that octant's size are clamped.
  const float least = 0.25f * length_squared(node.half) + 1e-30f;
  const Floats distance2 = d2 > least ? d2 : Floats{} + least;

  // The product of the cosines times distance, and the power of the distance by which it is divided.
  Floats product = Floats{} + 1;
  int powers = 2;
  if (normal != Normal3{}) {
    const Floats c = normal.x * x + normal.y * y + normal.z * z;
    product = c < 0 ? -c : c;
    ++powers;
  }
  float scale = node.power / 8;
  if (node.cosine > -1) {
    Floats c = node.axis.x * x + node.axis.y * y + node.axis.z * z;
    if (node.cosine < 1 - 1e-5f) {
      // d cos(theta -+ theta_o), with d sin(theta) = sqrt(d^2 - (d cos(theta))^2).
      const float sine = safe_sqrt(1 - node.cosine * node.cosine);
      float root[8];
      for (int i = 0; i < 8; ++i) root[i] = std::sqrt(std::max(distance2[i] - c[i] * c[i], 0.0f));
      Floats across, length;
      for (int i = 0; i < 8; ++i) across[i] = root[i];
      for (int i = 0; i < 8; ++i) root[i] = std::sqrt(distance2[i]);
      for (int i = 0; i < 8; ++i) length[i] = root[i];
      const Floats high = c > node.cosine * length ? length : c * node.cosine + across * sine;
      const Floats low = c < -node.cosine * length ? -length : c * node.cosine - across * sine;
      const Floats front = high > 0 ? high : Floats{}, back = low < 0 ? low : Floats{};
      const Floats spread = 2 * (high - low) + 1e-12f * length;
      const Floats crossing = (front * front + (node.both_sides ? back * back : Floats{})) / spread;
      const Floats middle = 0.5f * (high + low);
      c = low >= 0 ? middle : high <= 0 ? (node.both_sides ? -middle : Floats{}) : crossing;
    } else if (node.both_sides) {
      c = c < 0 ? -c : c;
    } else {
      c = c > 0 ? c : Floats{};
    }
    if (node.both_sides) scale /= 2;
    product *= c;
    ++powers;
  } else {
    scale /= 4;
  }
  Floats below = distance2;
  if (powers == 4) {
    below *= distance2;
  } else if (powers == 3) {
    float root[8];
    for (int i = 0; i < 8; ++i) root[i] = std::sqrt(distance2[i]);
    for (int i = 0; i < 8; ++i) below[i] *= root[i];
  }
  product /= below;
  float sum = 0;
  for (int i = 0; i < 8; ++i) sum += product[i];
  return scale * sum;
}

float LightTree::bound(const Node& node, const Point3& point, const Normal3& normal) {
  const Vector3 towards = point - node.centre;
  const float distance2 = length_squared(towards), radius2 = length_squared(node.half);
  float value = node.power / std::max(std::max(distance2, radius2), 1e-30f);
  if (distance2 <= radius2) return value;  // inside the bounding sphere any angle is possible
  const Vector3 direction = towards / std::sqrt(distance2);
  const float sin_b = std::sqrt(radius2 / distance2), cos_b = safe_sqrt(1 - radius2 / distance2);
  if (node.cosine > -1) {
    float cos_theta = dot(node.axis, direction);
    if (node.both_sides) cos_theta = std::abs(cos_theta);
    const float sin_theta = safe_sqrt(1 - cos_theta * cos_theta), sin_o = safe_sqrt(1 - node.cosine * node.cosine);
    const float cos_x = cosine_of_rest(sin_theta, cos_theta, sin_o, node.cosine);
    const float sin_x = sine_of_rest(sin_theta, cos_theta, sin_o, node.cosine);
    const float cos_rest = cosine_of_rest(sin_x, cos_x, sin_b, cos_b);
    if (!(cos_rest > -1e-6f)) return 0;  // the whole cluster faces away, by more than rounding errors
    value *= std::max(cos_rest, 1e-4f);
  }
  if (normal != Normal3{}) {
    const float cos_i = std::abs(dot(normal, direction));
    value *= std::max(cosine_of_rest(safe_sqrt(1 - cos_i * cos_i), cos_i, sin_b, cos_b), 1e-4f);
  }
  return value;
}

LightTree::Choice LightTree::sample(const Point3& point, const Normal3& normal, double& u) const {
  if (nodes_.empty()) return {};
  std::uint32_t at = 0;
  double probability = importance(nodes_[0], point, normal) > 0 ? 1 : 0;
  while (probability > 0 && !nodes_[at].leaf) {
    const std::uint32_t left = at + 1, right = nodes_[at].right;
    const double a = double(importance(nodes_[left], point, normal)), b = double(importance(nodes_[right], point, normal));
    if (!(a + b > 0)) return {};
    const double share = a / (a + b);
    if (u < share) {
      u /= share;
      probability *= share;
      at = left;
    } else {
      u = (u - share) / (1 - share);
      probability *= 1 - share;
      at = right;
    }
    u = std::min(u, 1 - 0x1p-53);
  }
  return {nodes_[at].right, float(probability)};
}

float LightTree::probability(const Point3& point, const Normal3& normal, std::uint32_t emitter) const {
  if (emitter >= leaves_.size() || !(importance(nodes_[0], point, normal) > 0)) return 0;
  double probability = 1;
  for (std::uint32_t at = leaves_[emitter]; at != 0; at = nodes_[at].parent) {
    const Node& parent = nodes_[nodes_[at].parent];
    const std::uint32_t left = nodes_[at].parent + 1, other = at == left ? parent.right : left;
    const double mine = double(importance(nodes_[at], point, normal)), its = double(importance(nodes_[other], point, normal));
    if (!(mine > 0)) return 0;
    probability *= mine / (mine + its);
  }
  return float(probability);
}

}  // namespace etendue
