#include "lens_pupils.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "etendue/core/error.h"

namespace etendue {
namespace {

constexpr size_t rings = 64;  // of the film
constexpr int steps = 64;     // of a search, across and down

using Box = LensPupils::Box;

bool passes(const LensSystem& lens, double film, double x, double y) {
  const DoubleVector3 way{x - film, y, lens.rear()};
  LensRay ray{{film, 0, 0}, (1 / length(way)) * way};
  return lens.outwards(ray);
}

/// The bounding box of the points of a rectangle through which rays pass the lens, from the centres of n x n / 2 cells;
/// enlarged by a cell on all sides.
Box search(const LensSystem& lens, double film, const Box& within, int n) {
  const double dx = (within.high - within.low) / n, dy = within.half_height / (n / 2);
  Box found{within.high, within.low, -1};
  for (int j = 0; j < n / 2; ++j)
    for (int i = 0; i < n; ++i) {
      const double x = within.low + (i + 0.5) * dx, y = (j + 0.5) * dy;
      if (!passes(lens, film, x, y)) continue;
      found.low = std::min(found.low, x);
      found.high = std::max(found.high, x);
      found.half_height = std::max(found.half_height, y);
    }
  if (found.half_height < 0) return {};
  return {found.low - dx, found.high + dx, found.half_height + dy};
}

Box joined(const Box& a, const Box& b) {
  if (!(a.area() > 0)) return b;
  if (!(b.area() > 0)) return a;
  return {std::min(a.low, b.low), std::max(a.high, b.high), std::max(a.half_height, b.half_height)};
}

}  // namespace

void LensPupils::find(const LensSystem& lens, double film_radius) {
  film_radius_ = film_radius;
  // Rays may cross the vertex's plane farther from the axis than the rim, which lies on the curved surface.
  const double reach = 1.5 * lens.rear_radius();
  const Box everywhere{-reach, reach, reach};

  // From the middle of the film the pupil is a disc of radius rho. Its projected solid angle is pi sin^2(theta) with
  // tan(theta) = rho / rear.
  if (!passes(lens, 0, 0, 0)) throw Error("no light comes through the lens to the middle of the film");
  double inside = 0, outside = reach;
  for (int i = 1; i <= 4096 && outside == reach; ++i) {
    const double rho = reach * i / 4096;
    if (passes(lens, 0, rho, 0))
      inside = rho;
    else
      outside = rho;
  }
  for (int i = 0; i < 50; ++i) {
    const double middle = (inside + outside) / 2;
    (passes(lens, 0, middle, 0) ? inside : outside) = middle;
  }
  solid_angle_ = std::numbers::pi * inside * inside / (inside * inside + lens.rear() * lens.rear());
  if (!(solid_angle_ > 1e-25)) throw Error("the lens is open by too little to count with");

  // From the middle of the film outwards, each pupil is searched near the previous one and refined by a second search.
  std::vector<Box> at;
  Box last{-inside, inside, inside};
  constexpr size_t lines = 2 * rings + 1;
  for (size_t i = 0; i < lines; ++i) {
    const double film = film_radius * double(i) / double(lines - 1), middle = (last.low + last.high) / 2,
                 half = last.high - last.low;
    Box found;
    if (last.area() > 0) found = search(lens, film, {middle - half, middle + half, 2 * last.half_height}, steps);
    if (!(found.area() > 0)) found = search(lens, film, everywhere, last.area() > 0 ? 4 * steps : steps);
    if (found.area() > 0) found = search(lens, film, found, steps);
    at.push_back(found);
    last = found;
  }
  boxes_.clear();
  for (size_t i = 0; i < lines; i += 2)
    boxes_.push_back(joined(at[i], joined(at[i > 0 ? i - 1 : i], at[i + 1 < lines ? i + 1 : i])));
  find_disc(lens);
}

LensPupils::Box LensPupils::box(double film_distance) const {
  const double at = std::min(film_distance / film_radius_, 1.0) * rings;
  const size_t i = std::min(size_t(at), rings - 1);
  const Box &a = boxes_[i], &b = boxes_[i + 1];
  if (!(b.area() > 0)) return a;
  if (!(a.area() > 0)) return b;
  const double t = at - double(i);
  return {std::lerp(a.low, b.low, t), std::lerp(a.high, b.high, t), std::lerp(a.half_height, b.half_height, t)};
}

void LensPupils::find_disc(const LensSystem& lens) {
  constexpr int planes = 65, side = 24;
  std::vector<double> radii(planes, 0.0);
  const double front = lens.front();
  const auto plane = [&](int k) { return front * (1 - 4.0 * k / (planes - 1)); };  // from the front to behind the film
  for (size_t i = 0; i < rings; ++i) {
    const double film = film_radius_ * (double(i) + 0.5) / rings;
    const Box box = this->box(film);
    if (!(box.area() > 0)) continue;
    for (int k = 0; k < side * side / 2; ++k) {
      const DoubleVector3 way{box.low + (k % side + 0.5) / side * (box.high - box.low) - film,
                              (k / side + 0.5) / (side / 2.0) * box.half_height, lens.rear()};
      LensRay ray{{film, 0, 0}, (1 / length(way)) * way};
      if (!lens.outwards(ray)) continue;
      for (int p = 0; p < planes; ++p) {
        const DoublePoint3 at = ray.at(plane(p));
        radii[size_t(p)] = std::max(radii[size_t(p)], std::hypot(at.x, at.y));
      }
    }
  }
  const size_t best = size_t(std::ranges::min_element(radii) - radii.begin());
  disc_z_ = plane(int(best));
  disc_radius_ = 1.08 * radii[best];  // the rays that were traced end up to half a step inside of the pupil's edge
}

}  // namespace etendue
