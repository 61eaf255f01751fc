#pragma once
// CellScene: base class of scenes that divide space into cells. A primitive may lie in several cells.

#include <algorithm>

#include "etendue/scene.h"
#include "geometry/finite_ray.h"
#include "primitives.h"

namespace etendue {

/// The last primitives that a ray was tested against (mailboxing), so that a primitive in several cells is not tested again.
/// Entries may be overwritten, so that a primitive is tested twice, but no primitive is skipped that was not tested. Each ray
/// has its own mailbox, so no data is shared between threads.
class Mailbox {
 public:
  Mailbox() { std::fill(std::begin(last_), std::end(last_), ~0u); }
  /// Whether a primitive is known to have been tested; marks it as tested.
  bool met(std::uint32_t primitive) {
    std::uint32_t& last = last_[primitive % std::size(last_)];
    if (last == primitive) return true;
    last = primitive;
    return false;
  }

 private:
  std::uint32_t last_[32];
};

/// A ray in double whose direction has no zero components: (plane - origin) * inverse is never NaN, and a ray that lies within
/// a plane is treated as if it crossed the plane very slowly. (The smallest float is 1e-45, so for other directions the largest
/// of these numbers is 1e45 * 1e38.)
struct CellRay {
  double origin[3], direction[3], inverse[3];
  bool sound;  ///< the ray is finite; other rays visit no cell
  explicit CellRay(const Ray& ray) : sound(has_finite_squares(ray)) {
    for (int k = 0; k < 3; ++k) {
      origin[k] = double(ray.origin[k]);
      direction[k] = double(ray.direction[k]);
      if (direction[k] == 0) direction[k] = 1e-60;
      inverse[k] = 1 / direction[k];
    }
  }
};

/// `Structure` derives from this class and implements walk(ray, limit, visit), which calls visit(primitives) for the cells
/// along the ray, near ones first, until visit returns true or `limit`, which visit may lower, is reached. A hit on a primitive
/// is accepted in the first of its cells that is visited, so hits need not lie in the visited cell.
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
        for (int k = 0; k < own.size; ++k)  // without an entry in the mailbox the same hit is found again
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
