#include "virtual_light_tree.h"

#include <algorithm>
#include <numeric>

namespace etendue {
namespace {

double sum_of(const Spectrum& s) { return double(s.average()); }

}  // namespace

void VirtualLightTree::build(std::span<const VirtualLight> lights) {
  nodes_.clear();
  if (lights.empty()) return;
  nodes_.reserve(2 * lights.size());
  std::vector<std::uint32_t> order(lights.size());
  std::iota(order.begin(), order.end(), 0u);
  nodes_.emplace_back();
  build(0, order, lights);
}

void VirtualLightTree::build(std::uint32_t at, std::span<std::uint32_t> some, std::span<const VirtualLight> all) {
  Node node;
  node.low = node.high = all[some[0]].at.point.position;
  double power = 0;
  for (const std::uint32_t i : some) {
    const Point3& p = all[i].at.point.position;
    for (int axis = 0; axis < 3; ++axis) {
      node.low[axis] = std::min(node.low[axis], p[axis]);
      node.high[axis] = std::max(node.high[axis], p[axis]);
    }
    power += sum_of(all[i].at.throughput);
  }
  node.power = float(power);
  if (some.size() == 1) {
    node.light = some[0];
    nodes_[at] = node;
    return;
  }
  const Vector3 size = node.high - node.low;
  const int widest = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto middle = std::ptrdiff_t(some.size() / 2);
  std::ranges::nth_element(some, some.begin() + middle, [&](std::uint32_t a, std::uint32_t b) {
    const float x = all[a].at.point.position[widest], y = all[b].at.point.position[widest];
    return x != y ? x < y : a < b;
  });
  node.parts = std::uint32_t(nodes_.size());
  nodes_[at] = node;
  nodes_.resize(nodes_.size() + 2);
  build(node.parts, some.first(size_t(middle)), all);
  build(node.parts + 1, some.subspan(size_t(middle)), all);
}

VirtualLightTree::Place VirtualLightTree::place(const PathVertex& v, float nearest) {
  Place z{v.point.position, {}, nearest};
  if (v.on_surface() && v.scatter && !v.scatter->has(transmission_lobes)) z.normal = on_side(Vector3(v.point.normal), v.out);
  return z;
}

double VirtualLightTree::bound(const Node& node, const Place& z) {
  double squared = 0, above = 0;  // above: the largest dot(normal, corner - z) over the box's corners
  for (int axis = 0; axis < 3; ++axis) {
    const float below = node.low[axis] - z.position[axis], over = z.position[axis] - node.high[axis];
    const double apart = double(std::max({below, over, 0.0f}));
    squared += apart * apart;
    above += double(z.normal[axis]) * double(z.normal[axis] > 0 ? -over : below);
  }
  if (above < 0) return 0;
  return double(node.power) / std::max(squared, double(z.nearest) * double(z.nearest));
}

double VirtualLightTree::likely(const Node& node, const Place& z) {
  if (!(bound(node, z) > 0)) return 0;
  const Vector3 diagonal = node.high - node.low;
  const Point3 middle = node.low + 0.5f * diagonal;
  const double squared = double(length_squared(middle - z.position)) + 0.25 * double(length_squared(diagonal));
  return double(node.power) / std::max(squared, double(z.nearest) * double(z.nearest));
}

void VirtualLightTree::cut(const Place& z, size_t most, NumberStream& numbers, std::vector<Sample>& samples) const {
  struct Open {
    double bound;
    std::uint32_t node;
    bool operator<(const Open& other) const { return bound != other.bound ? bound < other.bound : node < other.node; }
  };
  samples.clear();
  if (nodes_.empty()) return;
  static thread_local std::vector<Open> open;
  static thread_local std::vector<std::uint32_t> chosen;
  open.assign(1, {bound(nodes_[0], z), 0});
  chosen.clear();
  while (!open.empty()) {
    std::pop_heap(open.begin(), open.end());
    const Open first = open.back();
    open.pop_back();
    if (!(first.bound > 0)) continue;
    const Node& node = nodes_[first.node];
    if (node.parts == 0 || open.size() + chosen.size() + 2 > most) {
      chosen.push_back(first.node);
      continue;
    }
    for (const std::uint32_t part : {node.parts, node.parts + 1}) {
      open.push_back({bound(nodes_[part], z), part});
      std::push_heap(open.begin(), open.end());
    }
  }
  for (std::uint32_t at : chosen) {
    Sample s{0, 1};
    while (nodes_[at].parts > 0 && s.probability > 0) {
      const std::uint32_t a = nodes_[at].parts;
      const double first = likely(nodes_[a], z), second = likely(nodes_[a + 1], z), sum = first + second;
      const bool second_part = sum > 0 && double(numbers.next()) * sum >= first;
      s.probability *= sum > 0 ? (second_part ? second : first) / sum : 0;
      at = a + second_part;
    }
    s.light = nodes_[at].light;
    if (s.probability > 0) samples.push_back(s);
  }
}

}  // namespace etendue
