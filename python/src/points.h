#pragma once
// Points: many points on surfaces, found by rays or made by hand. They keep all that shaders and emissions read.

#ifdef __linux__
#include <sys/mman.h>
#endif

#include <memory>
#include <new>

#include "etendue/transport/medium_stack.h"
#include "question_arrays.h"
#include "snapshots.h"

namespace etendue::python {

/// Memory for objects that need no destructor, and that the caller constructs, in any order.
template <class T>
class Block {
 public:
  Block() = default;
  explicit Block(size_t count) : data_(allocate(std::max<size_t>(count, 1) * sizeof(T))) {}
  explicit operator bool() const { return bool(data_); }
  T& operator[](size_t i) const { return data_.get()[i]; }

 private:
  static constexpr std::align_val_t huge_page{size_t(1) << 21};
  struct Free {
    bool huge = false;
    void operator()(T* p) const {
      if (huge)
        ::operator delete(p, huge_page);
      else
        ::operator delete(p);
    }
  };
  using Memory = std::unique_ptr<T, Free>;
  /// A block for a million points has 45,000 pages of ordinary size, which take longer to be mapped than the points to be
  /// found.
  static Memory allocate(size_t bytes) {
    const bool huge = bytes >= 4 * size_t(huge_page);
    if (!huge) return Memory(static_cast<T*>(::operator new(bytes)));
    void* const memory = ::operator new(bytes, huge_page);
#ifdef __linux__
    madvise(memory, bytes, MADV_HUGEPAGE);
#endif
    return Memory(static_cast<T*>(memory), Free{true});
  }
  Memory data_;
};

/// A point, and what is left of the ray that found it.
struct FoundPoint {
  SurfacePoint point;
  float distance = infinity;   ///< from the ray's origin [m]; infinite: the ray hit nothing
  float remaining = infinity;  ///< the ray's length beyond the point [m]
  float spread = 0;            ///< of the ray's cone
  bool of_camera = false;      ///< see Ray
  /// A point that was made by hand is one without an object.
  bool exists() const { return distance < infinity; }
  /// Of a ray that hit nothing: the ray, whose origin stands in place of the point's position.
  Ray escaped() const {
    Ray ray;
    ray.origin = point.position;
    ray.direction = point.ray_direction;
    ray.time = point.time;
    ray.of_camera = of_camera;
    return ray;
  }
};

struct Points {
  size_t count = 0;
  std::shared_ptr<const Snapshot> scene;  ///< null: made by hand
  Block<FoundPoint> at;
  Block<MediumStack> media;  ///< around the points, on the side of the ray; null: media are not tracked

  Points(size_t n, std::shared_ptr<const Snapshot> from, bool tracked)
      : count(n), scene(std::move(from)), at(n), media(tracked ? Block<MediumStack>(n) : Block<MediumStack>()) {}
  DoublePoint3 own_origin;  ///< of points that were made by hand
  DoublePoint3 origin() const { return scene ? scene->origin() : own_origin; }
  DoublePoint3 world(size_t i) const { return origin() + DoubleVector3(at[i].point.position - Point3{}); }
  /// The place of the i-th item of a question about `of` items: a single point is that of all of them.
  const FoundPoint& row(size_t i) const { return at[count == 1 ? 0 : i]; }
};

/// Throws Error for points of another snapshot: their objects are not those of the scene as it is now. Points that were made by
/// hand belong to every scene.
inline void require_present(const Points& points, const std::shared_ptr<const Snapshot>& scene) {
  if (points.scene && points.scene != scene)
    throw Error("the points were found in another scene, or before an edit of this one: find them again by nearest");
}

/// Media around the origins of rays, which Python passes on from `leave` to `nearest`.
struct RayMedia {
  size_t count = 0;
  std::shared_ptr<const Snapshot> scene;
  Block<MediumStack> stacks;
};

/// Rays that Python gives as a tuple of arrays: origin in world space, direction, maximum, time, width, spread, of_camera, and
/// their media or None.
struct RayRows {
  explicit RayRows(const nb::tuple& given);
  /// The i-th ray in the rendering space of a scene; false: it has no direction, begins nowhere or ends at once, and so meets
  /// nothing.
  bool at(size_t i, const Snapshot& scene, Ray&) const;
  Rows<double> origin;
  Rows<float> direction, maximum, time, width, spread;
  Rows<bool> of_camera;
  const RayMedia* media = nullptr;
};

}  // namespace etendue::python
