#pragma once
// What scenes share that divide space into cells: a primitive may lie in several of them.

#include <algorithm>

#include "etendue/scene.h"
#include "etendue/shader.h"  // objects own shaders
#include "geometry/finite_ray.h"
#include "primitives.h"

namespace etendue {

/// The last primitives a ray was tested against, so that one that lies in several cells need not be tested again. It may
/// forget, never confuse. Each ray has its own, so nothing is written that other threads see.
class Mailbox {
 public:
  Mailbox() { std::fill(std::begin(last_), std::end(last_), ~0u); }
  /// Whether it was met before; from now on it was.
  bool met(std::uint32_t primitive) {
    std::uint32_t& last = last_[primitive % std::size(last_)];
    if (last == primitive) return true;
    last = primitive;
    return false;
  }

 private:
  std::uint32_t last_[32];
};

/// A ray in double, its direction free of zeros: (plane - origin) * inverse is never not-a-number, and a ray that lies within
/// a plane is at a place just beside it. (The smallest float is 1e-45, the largest number of these 1e45 * 1e38.)
struct CellRay {
  double origin[3], direction[3], inverse[3];
  bool sound;  ///< others are in no cell
  explicit CellRay(const Ray& ray) : sound(has_finite_squares(ray)) {
    for (int k = 0; k < 3; ++k) {
      origin[k] = double(ray.origin[k]);
      direction[k] = double(ray.direction[k]);
      if (direction[k] == 0) direction[k] = 1e-60;
      inverse[k] = 1 / direction[k];
    }
  }
};

/// `Structure` derives from this and has a function walk(ray, limit, visit): calls visit(primitives) for the cells along the
/// ray, near ones first, until it returns true or `limit`, which visit may lower, is reached. Cells that share a primitive
/// share what was found on it: hits need not lie in the cell.
template <class Structure>
class CellScene : public Scene {
 public:
  bool find_nearest(const Ray& ray, Hit& hit) const override {
    Ray rest = ray;
    bool found = primitives_.nearest_endless(rest, hit);
    const ShearedRay<double> sheared(ray);
    Mailbox mailbox;
    structure().walk(ray, rest.maximum, [&](std::span<const std::uint32_t> cell) {
      for (const std::uint32_t i : cell) {
        if (mailbox.met(i) || !primitives_.nearest(i, rest, sheared, hit)) continue;
        rest.maximum = hit.distance;
        found = true;
      }
      return false;
    });
    return found;
  }

  bool find_any(const Ray& ray) const override {
    if (primitives_.any_endless(ray)) return true;
    const ShearedRay<double> sheared(ray);
    Mailbox mailbox;
    bool found = false;
    structure().walk(ray, ray.maximum, [&](std::span<const std::uint32_t> cell) {
      for (const std::uint32_t i : cell)
        if (!mailbox.met(i) && primitives_.any(i, ray, sheared)) return found = true;
      return false;
    });
    return found;
  }

  void find_all(const Ray& ray, HitList& list) const override {
    const int before = list.size;
    primitives_.all_endless(ray, list);
    const ShearedRay<double> sheared(ray);
    Mailbox mailbox;
    structure().walk(ray, ray.maximum, [&](std::span<const std::uint32_t> cell) {
      for (const std::uint32_t i : cell) {
        if (mailbox.met(i)) continue;
        HitList own;
        primitives_.all(i, ray, sheared, own);
        for (int k = 0; k < own.size; ++k)  // the mailbox may have forgotten; the same test finds the same again
          if (std::none_of(list.hits + before, list.hits + list.size, [&](const Hit& h) { return same(h, own.hits[k]); }))
            list.add(own.hits[k]);
      }
      return false;
    });
  }

 protected:
  Primitives primitives_;

 private:
  const Structure& structure() const { return static_cast<const Structure&>(*this); }

  static bool same(const Hit& a, const Hit& b) {
    return a.object == b.object && a.primitive == b.primitive && a.distance == b.distance && a.u == b.u && a.v == b.v &&
           a.depth == b.depth && std::equal(a.scenes, a.scenes + a.depth, b.scenes);
  }
};

}  // namespace etendue
