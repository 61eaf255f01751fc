#pragma once
// PointTree: a balanced k-d tree over points, for searches within a radius and for the nearest points (Bentley 1975,
// "Multidimensional binary search trees used for associative searching"; Jensen 2001, section 6.2).
//
// The points are sorted so that each node of the tree is a range: of n points the first n/2 lie on the lower side of a plane
// perpendicular to the longest edge of their bounding box, and so on down to a few points. Only planes are stored, about a byte
// per point.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "etendue/core/math.h"
#include "etendue/core/vector.h"

namespace etendue {

class PointTree {
 public:
  static constexpr size_t leaf = 8;  ///< maximum number of points in a leaf
  /// Builds the tree on all cores. Returns the order of the points: point i of the tree is points[order[i]]. At most 2^32
  /// points. During the build each takes 16 bytes more.
  std::vector<std::uint32_t> build(std::span<const Point3> points) {
    return build(points.data(), sizeof(Point3), points.size());
  }
  /// The same for points that are members of larger structures.
  template <class Whole>
  std::vector<std::uint32_t> build(std::span<const Whole> all, Point3 Whole::* point) {
    return build(all.empty() ? nullptr : &(all.front().*point), sizeof(Whole), all.size());
  }

  size_t size() const { return points_.size(); }
  const Point3& operator[](size_t i) const { return points_[i]; }
  /// [bytes]
  size_t memory() const { return points_.capacity() * sizeof(Point3) + planes_.capacity() * sizeof(Plane); }

  /// Calls `visit(i, squared distance)` for all points within `radius`, in a fixed order.
  template <class Visit>
  void within(const Point3& centre, float radius, Visit&& visit) const {
    float squared = square(radius);
    search(centre, squared, [&](std::uint32_t i, float d2) { visit(i, d2); });
  }

  /// Calls `visit(i, t)` for all points within `radius` of a line segment, from its origin to the distance `reach`, with t the
  /// parameter of the closest point of the line; in a fixed order. `direction` is unit.
  template <class Visit>
  void along(const Point3& origin, const Vector3& direction, float reach, float radius, const Visit& visit) const {
    struct Part {
      std::uint32_t begin, end;
      std::uint64_t node;
      float from, to;  ///< interval of the line in which it can be close to the node's points
    };
    std::array<Part, 64> stack;
    stack[0] = {0, std::uint32_t(points_.size()), 0, -radius, reach + radius};
    for (int waiting = 1; waiting > 0;) {
      const Part at = stack[size_t(--waiting)];
      if (at.end - at.begin <= leaf) {
        for (std::uint32_t i = at.begin; i < at.end; ++i) {
          const Vector3 to = points_[i] - origin;
          const float t = dot(to, direction);
          if (t > 0 && t < reach && length_squared(to - t * direction) < square(radius)) visit(i, t);
        }
        continue;
      }
      // The lower child: the part of the line that is less than `radius` above the plane. The upper child likewise.
      const Plane& plane = planes_[at.node];
      const float o = origin[int(plane.axis)] - plane.at, d = direction[int(plane.axis)];
      const float below = (radius - o) / d, above = (-radius - o) / d;
      const std::uint32_t middle = at.begin + (at.end - at.begin) / 2;
      Part lower{at.begin, middle, 2 * at.node + 1, at.from, at.to}, upper{middle, at.end, 2 * at.node + 2, at.from, at.to};
      bool low = true, high = true;
      if (d > 0) {
        lower.to = std::min(lower.to, below);
        upper.from = std::max(upper.from, above);
      } else if (d < 0) {
        lower.from = std::max(lower.from, below);
        upper.to = std::min(upper.to, above);
      } else {
        low = o < radius;
        high = o > -radius;
      }
      if (high && upper.from <= upper.to) stack[size_t(waiting++)] = upper;
      if (low && lower.from <= lower.to) stack[size_t(waiting++)] = lower;
    }
  }

  /// A point and its squared distance.
  struct Near {
    float squared;
    std::uint32_t index;
    bool operator<(const Near& b) const { return squared != b.squared ? squared < b.squared : index < b.index; }
  };
  /// The `count` nearest points within `radius`, in a heap with the farthest first; fewer if there are no more.
  void nearest(const Point3& centre, float radius, size_t count, std::vector<Near>& found) const;
  /// A buffer for the result, valid until the next call on this thread.
  static std::vector<Near>& near_on_this_thread();

 private:
  struct Plane {
    float at;
    std::uint32_t axis;
  };
  struct Build;
  /// `stride`: the distance from point to point [bytes].
  std::vector<std::uint32_t> build(const Point3* first, size_t stride, size_t count);

  /// `visit` may reduce `squared`.
  template <class Visit>
  void search(const Point3& centre, const float& squared, const Visit& visit) const {
    struct Subtree {
      std::uint32_t begin, end;
      std::uint64_t node;
      float least;  ///< lower bound of the squared distance to the points, from the planes above
    };
    std::array<Subtree, 64> stack;
    int waiting = 0;
    Subtree at{0, std::uint32_t(points_.size()), 0, 0};
    while (true) {
      while (at.end - at.begin > leaf) {
        const Plane& plane = planes_[at.node];
        const float over = centre[int(plane.axis)] - plane.at;
        const std::uint32_t middle = at.begin + (at.end - at.begin) / 2;
        Subtree lower{at.begin, middle, 2 * at.node + 1, at.least}, upper{middle, at.end, 2 * at.node + 2, at.least};
        if (over > 0) std::swap(lower, upper);
        upper.least = std::max(at.least, square(over));
        if (upper.least < squared) stack[size_t(waiting++)] = upper;
        at = lower;
      }
      for (std::uint32_t i = at.begin; i < at.end; ++i)
        if (const float d2 = length_squared(points_[i] - centre); d2 < squared) visit(i, d2);
      do {
        if (waiting == 0) return;
        at = stack[size_t(--waiting)];
      } while (at.least >= squared);
    }
  }

  std::vector<Point3> points_;
  std::vector<Plane> planes_;
};

}  // namespace etendue
