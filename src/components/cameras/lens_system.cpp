// Ray tracing through spherical lens surfaces (Kolb, Mitchell & Hanrahan 1995, section 3.1), and focusing.

#include "lens_system.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "etendue/core/error.h"
#include "files/regular_file.h"

namespace etendue {
namespace {

constexpr std::uint64_t largest_file = 1u << 20;  // bytes; real ones have 1 kB
constexpr size_t most_surfaces = 1000;

}  // namespace

std::vector<double> read_lens_file(const std::string& path) {
  std::string text;
  try {
    text = read_regular_file(path, largest_file);
  } catch (const Error& e) {
    throw Error(fmt::format("cannot read '{}': {}", path, e.what()));
  }
  std::vector<double> numbers;
  int line = 1;
  for (size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == '#') {
      i = std::min(text.find('\n', i), text.size());
    } else if (c == ' ' || c == '\t' || c == '\r' || c == '\n') {
      line += c == '\n';
      ++i;
    } else {
      const size_t end = std::min(text.find_first_of(" \t\r\n#", i), text.size());
      const char* first = text.data() + i + (c == '+' ? 1 : 0);
      double value = 0;
      const auto [stop, error] = std::from_chars(first, text.data() + end, value);
      if (error != std::errc() || stop != text.data() + end || !std::isfinite(value))
        throw Error(fmt::format("'{}', line {}: a number should be here", path, line));
      if (numbers.size() == 4 * most_surfaces) throw Error(fmt::format("'{}' has more than {} surfaces", path, most_surfaces));
      numbers.push_back(value);
      i = end;
    }
  }
  return numbers;
}

std::vector<LensSurface> lens_surfaces(const std::vector<double>& numbers, double unit) {
  if (numbers.empty() || numbers.size() % 4 != 0)
    throw Error(
        fmt::format("a surface is four numbers, a radius of curvature, a thickness, an index and a diameter, but there are "
                    "{} in all",
                    numbers.size()));
  if (numbers.size() > 4 * most_surfaces) throw Error(fmt::format("a lens has at most {} surfaces", most_surfaces));
  std::vector<LensSurface> surfaces;
  for (size_t i = 0; i < numbers.size(); i += 4) {
    const double index = numbers[i + 2] == 0 ? 1 : numbers[i + 2];
    const LensSurface s{numbers[i] * unit, numbers[i + 1] * unit, index, numbers[i + 3] * unit};
    const auto wrong = [&](const char* what) { throw Error(fmt::format("{} of surface {}", what, i / 4 + 1)); };
    const double most = 1e6;  // [m]; keeps the computations finite and precise
    if (!(std::abs(s.radius) < most)) wrong("the radius of curvature must be a number below 1000 km (0: a plane):");
    if (!(s.thickness >= 0 && s.thickness < most)) wrong("the thickness must be at least 0, and below 1000 km:");
    if (!(s.index >= 1 && s.index <= 10)) wrong("the index of refraction must be from 1 to 10, or 0 for air:");
    if (!(s.diameter > 0 && s.diameter < most)) wrong("the diameter must be more than 0, and below 1000 km:");
    surfaces.push_back(s);
  }
  return surfaces;
}

bool is_stop(const std::vector<LensSurface>& surfaces, size_t i) {
  const double before = i == 0 ? 1 : surfaces[i - 1].index;
  return surfaces[i].radius == 0 && surfaces[i].index == before;
}

// Paraxial optics: a surface of curvature c between indices n and n' changes n u, u being the slope of a ray at height y, by
// -y c (n' - n); a space of length t changes y by t u. For a ray that arrives parallel to the axis at height 1, the slope u
// behind the lens gives the focal length, f = -1 / u, and its height y at the last vertex the back focus, -y / u. Each
// principal plane lies one focal length from its focal point, towards the lens.
void LensSystem::set(const std::vector<LensSurface>& list) {
  surfaces_.clear();
  length_ = 0;
  for (size_t i = 0; i < list.size(); ++i) {
    Surface s;
    s.radius = list[i].radius;
    s.open_squared = list[i].diameter * list[i].diameter / 4;
    s.front_index = i == 0 ? 1 : list[i - 1].index;
    s.rear_index = list[i].index;
    s.vertex = -length_;  // relative to the front vertex, until focus() is called
    if (i + 1 < list.size()) length_ += list[i].thickness;
    surfaces_.push_back(s);
  }
  if (surfaces_.back().rear_index != 1) throw Error("behind the last surface there must be air, of index 1");
  // A ray from the scene, then a ray through the reversed lens.
  const size_t n = surfaces_.size();
  for (const bool turned : {false, true}) {
    double y = 1, u = 0;
    for (size_t k = 0; k < n; ++k) {
      const Surface& s = surfaces_[turned ? n - 1 - k : k];
      const double before = turned ? s.rear_index : s.front_index, after = turned ? s.front_index : s.rear_index;
      const double curvature = s.radius == 0 ? 0 : (turned ? -1 : 1) / s.radius;
      u = (before * u - y * curvature * (after - before)) / after;
      if (k + 1 < n) y += u * std::abs(surfaces_[turned ? n - 2 - k : k + 1].vertex - s.vertex);
    }
    focal_length_ = -1 / u;  // equal in both directions, as there is air on both sides
    (turned ? front_focus_ : back_focus_) = -y / u;
  }
  if (!(focal_length_ > 0) || !std::isfinite(focal_length_)) throw Error("the lens does not gather light: it makes no image");
}

// With s and s' the distances of object and film from the principal planes, which are d apart,  1/s + 1/s' = 1/f  and
// s + s' + d = D, the distance of the object from the film. With T = D - d hence s s' = f T and
// s' = (T - sqrt(T^2 - 4 f T)) / 2: of the two solutions the one in which the film is nearer to the lens than the object.
void LensSystem::focus(double distance) {
  const double f = focal_length_, apart = length_ + (back_focus_ - f) + (front_focus_ - f), t = distance - apart;
  if (!(t >= 4 * f))
    throw Error(
        fmt::format("a lens of a focal length of {:.4g} m is sharp from {:.4g} m on, counted from the film", f, 4 * f + apart));
  image_distance_ = std::isfinite(t) ? 2 * f / (1 + std::sqrt(1 - 4 * f / t)) : f;
  const double rear = image_distance_ + back_focus_ - f;  // distance of the last vertex from the film
  if (!(rear > 0)) throw Error("the image that the lens makes lies inside it");
  const double shift = rear - surfaces_.back().vertex;
  for (Surface& s : surfaces_) s.vertex += shift;
}

double LensSystem::rear_radius() const { return std::sqrt(surfaces_.back().open_squared); }

/// Refracts a ray at one surface; false: it is blocked, or reflected totally. Of the two intersections of a line and the sphere
/// the one on the vertex's side of the centre is taken.
bool LensSystem::pass(const Surface& s, double from, double to, LensRay& r) {
  DoubleVector3 normal{0, 0, 1};
  if (s.radius == 0) {
    if (r.direction.z == 0) return false;
    r.origin = r.at(s.vertex);
  } else {
    const DoubleVector3 o = r.origin - DoublePoint3{0, 0, s.vertex - s.radius};
    const double b = dot(o, r.direction), discriminant = b * b - (dot(o, o) - s.radius * s.radius);
    if (!(discriminant >= 0)) return false;
    const bool farther = (s.radius > 0) == (r.direction.z > 0);
    r.origin = r.origin + (-b + (farther ? 1 : -1) * std::sqrt(discriminant)) * r.direction;
    normal = (1 / s.radius) * (r.origin - DoublePoint3{0, 0, s.vertex - s.radius});
  }
  if (r.origin.x * r.origin.x + r.origin.y * r.origin.y > s.open_squared) return false;
  if (from == to) return true;
  double cosine = -dot(normal, r.direction);
  if (cosine < 0) {
    normal = -1.0 * normal;
    cosine = -cosine;
  }
  const double ratio = from / to, squared = 1 - ratio * ratio * (1 - cosine * cosine);
  if (!(squared > 0)) return false;
  r.direction = ratio * r.direction + (ratio * cosine - std::sqrt(squared)) * normal;
  return true;
}

bool LensSystem::outwards(LensRay& ray) const {
  for (size_t i = surfaces_.size(); i-- > 0;)
    if (!pass(surfaces_[i], surfaces_[i].rear_index, surfaces_[i].front_index, ray)) return false;
  return ray.direction.z > 0;
}

bool LensSystem::inwards(LensRay& ray) const {
  for (const Surface& s : surfaces_)
    if (!pass(s, s.front_index, s.rear_index, ray)) return false;
  return ray.direction.z < 0;
}

}  // namespace etendue
