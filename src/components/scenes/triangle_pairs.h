#pragma once
// Triangles tested many at a time, one after another of those given: for scenes so small that no tree pays. Two that share an
// edge and a plane are tested as one, since walls and boxes are made of such pairs.

#include <array>
#include <vector>

#include "etendue/scene_object.h"
#include "geometry/lanes.h"

namespace etendue {

class TrianglePairs {
 public:
  void clear();
  /// `diameter` of the scene [m]: no ray begins further from a triangle that it meets.
  void add(const SceneObject&, const TriangleView&, float diameter);

  /// The nearest hit in (0, ray.maximum); what `hit` was stays when there is none.
  bool nearest(const Ray&, Hit& hit) const;
  bool any(const Ray&) const;
  void all(const Ray&, HitList&) const;

  /// Two triangles (A, B, C) and (A, C, D) that make a plane convex quadrilateral, or the first alone, in each lane. With
  /// a = B - A, b = C - A, c = D - A, N = a x b, and k = |b x c| / |N|. A lane of zeros is never met: its t is 0/0, which fails
  /// all comparisons.
  struct alignas(32) Block {
    Floats vx, vy, vz;    // A
    Floats nx, ny, nz;    // N
    Floats ax, ay, az;    // g_a, see the test
    Floats bx, by, bz;    // g_b
    Floats cx, cy, cz;    // h
    Floats turn;          // -1/k
    Floats lowest, most;  // what the least weight and the sum of both may be
  };

 private:
  struct Part {
    std::uint32_t primitive = 0;
    std::uint8_t second = 1, third = 2;  // which of our corners, of weights w0, w1 and w2, are the triangle's second and third
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
  std::vector<Slot> slots_;  // what is in each lane, block after block
};

}  // namespace etendue
