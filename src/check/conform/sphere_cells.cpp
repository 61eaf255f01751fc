#include "sphere_cells.h"

#include <algorithm>

namespace etendue::conform {

SphereCells::SphereCells(const std::vector<Vector3>& samples, size_t wanted) {
  for (const Vector3& v : samples) places_.push_back(place(v));
  const auto middle = std::partition(places_.begin(), places_.end(), [](const Place& p) { return !p.back; });
  const size_t most = std::max<size_t>(places_.size() / std::max<size_t>(wanted, 1), 1),
               front = size_t(middle - places_.begin());
  roots_[0] = divide({false, -1, 1, -1, 1}, 0, front, most, no_cell);
  roots_[1] = divide({true, -1, 1, -1, 1}, front, places_.size(), most, no_cell);
}

bool SphereCells::gap(const Box& box, const Place* begin, const Place* end, int& axis, double& at) {
  double low[2] = {box.x1, box.y1}, high[2] = {box.x0, box.y0};
  for (const Place* p = begin; p != end; ++p) {
    low[0] = std::min(low[0], p->x);
    low[1] = std::min(low[1], p->y);
    high[0] = std::max(high[0], p->x);
    high[1] = std::max(high[1], p->y);
  }
  const double begins[2] = {box.x0, box.y0}, ends[2] = {box.x1, box.y1};
  // A margin as wide as the extent of all samples: beyond it a sharp peak has decayed.
  const double margin = std::max({high[0] - low[0], high[1] - low[1], 1e-6});
  for (axis = 0; axis < 2; ++axis) {
    const double least = std::max(2 * margin, 0.25 * (ends[axis] - begins[axis]));
    if (low[axis] - begins[axis] > least) return at = low[axis] - margin, true;
    if (ends[axis] - high[axis] > least) return at = high[axis] + margin, true;
  }
  return false;
}

size_t SphereCells::divide(const Box& box, size_t begin, size_t end, size_t most, size_t cell) {
  const size_t node = nodes_.size();
  nodes_.emplace_back();
  if (cell == no_cell && end - begin <= most) {
    cell = cells_.size();
    cells_.push_back(box);
  }
  const double width = box.x1 - box.x0, height = box.y1 - box.y0;
  constexpr double narrowest = 1e-6;  // a few units in the last place of a float
  int axis = 0;
  double at = 0;
  bool cut = end - begin > 1 && gap(box, places_.data() + begin, places_.data() + end, axis, at);
  if (!cut && end - begin > patch_samples && std::max(width, height) > narrowest) {
    cut = true;
    axis = width >= height ? 0 : 1;
    const auto along = [axis](const Place& p) { return axis == 0 ? p.x : p.y; };
    const size_t half = begin + (end - begin) / 2;
    std::nth_element(places_.begin() + long(begin), places_.begin() + long(half), places_.begin() + long(end),
                     [&](const Place& a, const Place& b) { return along(a) < along(b); });
    const double low = axis == 0 ? box.x0 : box.y0, high = axis == 0 ? box.x1 : box.y1;
    // Away from the ends of the box, so that boxes stay compact and recursion ends for equal samples.
    at = std::clamp(along(places_[half]), low + (high - low) / 16, high - (high - low) / 16);
  }
  if (!cut) {
    if (cell == no_cell) {
      cell = cells_.size();
      cells_.push_back(box);
    }
    nodes_[node].low = cell;
    patches_.push_back({box, cell, begin, end});
    return node;
  }
  const auto split = std::partition(places_.begin() + long(begin), places_.begin() + long(end),
                                    [&](const Place& p) { return (axis == 0 ? p.x : p.y) < at; });
  const auto middle = size_t(split - places_.begin());
  Box below = box, above = box;
  (axis == 0 ? below.x1 : below.y1) = at;
  (axis == 0 ? above.x0 : above.y0) = at;
  const size_t first = divide(below, begin, middle, most, cell), second = divide(above, middle, end, most, cell);
  nodes_[node] = {axis, at, first, second};
  return node;
}

size_t SphereCells::cell_of(const Vector3& local) const {
  const Place p = place(local);
  const Node* node = &nodes_[roots_[p.back]];
  while (node->axis >= 0) node = &nodes_[(node->axis == 0 ? p.x : p.y) < node->at ? node->low : node->high];
  return node->low;
}

SphereCells::Place SphereCells::place(const Vector3& v) {
  const double r2 = (double(v.x) * double(v.x) + double(v.y) * double(v.y)) / (1 + std::abs(double(v.z)));
  const double r = std::sqrt(std::min(r2, 1.0));
  double phi = std::atan2(double(v.y), double(v.x));
  constexpr double quarter = M_PI / 4;
  if (phi < -quarter) phi += 2 * M_PI;
  Place p{std::signbit(v.z), 0, 0};
  if (phi < quarter) {
    p.x = r;
    p.y = phi * r / quarter;
  } else if (phi < 3 * quarter) {
    p.y = r;
    p.x = -(phi - 2 * quarter) * r / quarter;
  } else if (phi < 5 * quarter) {
    p.x = -r;
    p.y = (phi - 4 * quarter) * p.x / quarter;
  } else {
    p.y = -r;
    p.x = -(phi - 6 * quarter) * p.y / quarter;
  }
  return p;
}

Vector3 SphereCells::direction(bool back, double x, double y) {
  double r = 0, phi = 0;
  if (std::abs(x) > std::abs(y)) {
    r = x;
    phi = M_PI / 4 * (y / x);
  } else if (y != 0) {
    r = y;
    phi = M_PI / 2 - M_PI / 4 * (x / y);
  }
  const double across = r * std::sqrt(2 - r * r), z = 1 - r * r;
  return {float(across * std::cos(phi)), float(across * std::sin(phi)), float(back ? -z : z)};
}

}  // namespace etendue::conform
