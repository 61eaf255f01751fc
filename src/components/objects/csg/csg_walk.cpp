#include "csg_walk.h"

#include <memory>

#include "geometry/geometry.h"

// Whether a point of the ray is inside an operand follows from the operand's next crossing: it is inside if that crossing is an
// exit. No count is kept from the ray's origin, so if rounding loses a crossing (at a silhouette, say), the state is correct
// again behind the operand's next crossing.
//
// Coincident surfaces. Faces of operands often lie in one plane: two boxes that touch, a hole drilled flush with a face.
// Rounding then decides which of them a ray hits first, and processing them one by one would produce gaps and skins of zero
// thickness. So coincident crossings are processed together: only the states before and after the group matter. Two surfaces
// with errors e1 and e2 are coincident where the ray is within e1 + e2 of both: with the cosines c1 and c2 between ray and
// normals, where the distance along the ray between them is less than (e1 + e2) / max(c1, c2). Of coincident surfaces the
// visible one is always that of the first operand, so that the choice is the same everywhere.

namespace etendue {
namespace {

/// Buffers for crossings, reused by each thread from ray to ray. Combinations nest, so the buffers form a stack.
class Rooms {
 public:
  std::vector<CsgCrossing>& take() {
    if (taken_ == rooms_.size()) rooms_.push_back(std::make_unique<std::vector<CsgCrossing>>());
    std::vector<CsgCrossing>& room = *rooms_[taken_++];
    room.clear();
    return room;
  }
  void give_back() { --taken_; }

 private:
  std::vector<std::unique_ptr<std::vector<CsgCrossing>>> rooms_;
  size_t taken_ = 0;
};
thread_local Rooms rooms;

/// Ray-box slab test (Kay & Kajiya 1986), with slabs slightly wider than the rounding error requires.
bool meets(const Bounds3& box, const Ray& ray) {
  float enter = 0, leave = ray.maximum;
  for (int k = 0; k < 3; ++k) {
    const float inverse = 1 / ray.direction[k];
    float t0 = (box.low[k] - ray.origin[k]) * inverse, t1 = (box.high[k] - ray.origin[k]) * inverse;
    if (inverse < 0) std::swap(t0, t1);
    t1 *= 1 + 2 * rounding_bound(3);
    t0 *= 1 - 2 * rounding_bound(3);
    // For a ray that lies in a slab's plane t0 and t1 may be NaN; the comparisons then leave the interval unchanged.
    if (t0 > enter) enter = t0;
    if (t1 < leave) leave = t1;
  }
  return enter <= leave;
}

bool in_one_place(const CsgCrossing& a, const CsgCrossing& b) {
  return std::abs(a.t - b.t) * double(std::max(a.across, b.across)) <= 2 * double(a.error + b.error);
}

}  // namespace

CsgWalk::CsgWalk(std::span<const CsgOperand> operands, int least_weight, const Ray& ray)
    : ray_(ray), least_weight_(least_weight), crossings_(rooms.take()) {
  int reachable = 0;  // largest weight sum that the ray can still reach
  for (const CsgOperand& operand : operands) reachable += std::max(operand.weight, 0);
  for (const CsgOperand& operand : operands) {
    if (meets(operand.bounds, ray)) {
      CsgCrossing& c = crossings_.emplace_back();
      c.operand = &operand;
      c.rest = ray;
      c.rest.maximum = infinity;  // whether the ray starts inside may follow only from a crossing beyond its end
      find(c);
      if (c.t < infinity) continue;
      crossings_.pop_back();
    }
    reachable -= std::max(operand.weight, 0);
    if (reachable < least_weight) {
      crossings_.clear();
      return;
    }
  }
}

CsgWalk::~CsgWalk() { rooms.give_back(); }

void CsgWalk::find(CsgCrossing& c) const {
  const double before = c.t;
  c.located = c.passed = false;
  c.t = c.operand->object->intersect(c.rest, c.hit) ? std::max(before, c.start + double(c.hit.distance)) : infinity;
}

void CsgWalk::locate(CsgCrossing& c) const {
  if (c.located) return;
  SurfacePoint p;
  c.operand->object->surface_point(c.rest, c.hit, p);
  const float cosine = dot(p.normal, ray_.direction);
  c.leaving = cosine > 0;
  c.across = std::abs(cosine);
  c.error = p.error;
  c.exit = p.exit(ray_.direction);
  c.located = true;
}

void CsgWalk::advance(CsgCrossing& c) const {
  locate(c);
  double along = 0, squared = 0;
  for (int k = 0; k < 3; ++k) {
    const double d = double(ray_.direction[k]);
    along += (double(c.exit[k]) - double(ray_.origin[k])) * d;
    squared += d * d;
  }
  c.rest.origin = c.exit;
  c.start = along / squared;
  find(c);
}

CsgCrossing* CsgWalk::nearest() const {
  CsgCrossing* first = nullptr;
  int reachable = 0;
  for (CsgCrossing& c : crossings_) {
    if (!(c.t < infinity)) continue;
    reachable += std::max(c.operand->weight, 0);
    if (!first || c.t < first->t) first = &c;
  }
  return reachable < least_weight_ ? nullptr : first;
}

const CsgCrossing* CsgWalk::next() {
  // Each iteration should advance by more than the error of a surface; the limit on the iterations of a whole walk is for
  // objects that violate this.
  const int most = (1 << 13) + 16 * int(crossings_.size());
  while (turns_++ < most) {
    for (CsgCrossing& c : crossings_)
      if (c.passed) advance(c);
    CsgCrossing* const first = nearest();
    if (!first || !(float(first->t) < ray_.maximum)) return nullptr;
    CsgCrossing* found = first;
    if (crossings_.size() == 1) {  // only one operand is hit
      first->passed = true;
    } else {
      for (CsgCrossing& c : crossings_)
        if (c.t < infinity) locate(c);
      int before = 0, after = 0;
      CsgCrossing *in = nullptr, *out = nullptr;
      for (CsgCrossing& c : crossings_) {
        if (!(c.t < infinity)) continue;
        const int inside = c.leaving ? c.operand->weight : 0;
        before += inside;
        c.passed = in_one_place(c, *first);
        after += c.passed ? c.operand->weight - inside : inside;
        if (!c.passed) continue;
        CsgCrossing*& way = c.leaving == (c.operand->weight < 0) ? in : out;
        if (!way) way = &c;
      }
      if ((before >= least_weight_) == (after >= least_weight_)) continue;
      found = after >= least_weight_ ? in : out;
    }
    if (!(float(found->t) > 0)) continue;
    return float(found->t) < ray_.maximum ? found : nullptr;
  }
  return nullptr;
}

}  // namespace etendue
