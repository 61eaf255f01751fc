#pragma once
// TrianglePairs: tests all triangles one after another, many at a time by SIMD, for scenes so small that a tree does not pay.
// Two triangles that share an edge and a plane are tested as one quadrilateral, since walls and boxes consist of such pairs.

#include <array>
#include <vector>

#include "etendue/mesh_facts.h"
#include "geometry/lanes.h"

namespace etendue {

class TrianglePairs {
 public:
  void clear();
  /// `diameter` is that of the scene [m]: no ray begins farther from a triangle that it hits.
  void add(const SceneObject&, const TriangleView&, float diameter);

  /// The nearest hit in (0, ray.maximum); if there is none, `hit` is not changed.
  bool nearest(const Ray&, Hit& hit) const;
  bool any(const Ray&) const;
  void all(const Ray&, HitList&) const;

  /// In each lane two triangles (A, B, C) and (A, C, D) that form a plane convex quadrilateral, or the first triangle alone.
  /// With a = B - A, b = C - A, c = D - A, N = a x b, and k = |b x c| / |N|. A lane of zeros is never hit: its t is 0/0 = NaN,
  /// which fails all comparisons.
  struct alignas(32) Block {
    Floats vx, vy, vz;    // A
    Floats nx, ny, nz;    // N
    Floats ax, ay, az;    // g_a, see the test
    Floats bx, by, bz;    // g_b
    Floats cx, cy, cz;    // h
    Floats turn;          // -1/k
    Floats lowest, most;  // lower limit of the weights, and upper limit of their sums
  };

 private:
  struct Part {
    std::uint32_t primitive = 0;
    std::uint8_t second = 1, third = 2;  // which of the corners with weights w0, w1 and w2 are the triangle's second and third
  };
  struct Slot {
    const SceneObject* object = nullptr;
    std::array<Part, 2> parts;
    bool alone = false;    // no second triangle
    bool straight = true;  // B and C, C and D are the second and third corners
  };

  void add_lane(const SceneObject&, const std::array<Point3, 4>& corners, bool pair, const std::array<Part, 2>&,
                float diameter);
  void set(Hit&, size_t block, size_t lane, float t, float u, float v, float x) const;

  std::vector<Block> blocks_;
  std::vector<Slot> slots_;  // the objects and triangles of each lane, block after block
};

}  // namespace etendue
