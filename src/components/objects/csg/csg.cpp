#include "csg.h"

#include <algorithm>
#include <bit>

#include "csg_operand_shader.h"
#include "geometry/geometry.h"
#include "geometry/numbered_parts.h"

namespace etendue {

Csg::Csg(int weight_of_others, int least_weight) : weight_of_others_(weight_of_others), given_least_weight_(least_weight) {
  shader = make<OperandShader>();
}

namespace {

bool contains_operand_shader(const Component& part) {
  for (const Member& m : part.class_info().members) {
    if (m.kind != Kind::component || m.list) continue;
    const Value value = get(part, m.name);
    const auto* inner = value.as<Ref<Component>>();
    const auto* below = inner ? dynamic_cast<const Shader*>(inner->get()) : nullptr;
    if (below && (dynamic_cast<const OperandShader*>(below) || contains_operand_shader(*below))) return true;
  }
  return false;
}

}  // namespace

// ---- preparing ------------------------------------------------------------------------------------------------------------

void Csg::prepare() {
  if (operands.empty()) fail("operands", "a solid needs at least one");
  times_.clear();
  if (transform.animated())
    for (const AnimatedTransform::Key& key : transform.keys()) times_.push_back(key.time);
  combined_.clear();
  nested_.clear();
  for (size_t i = 0; i < operands.size(); ++i) {
    if (!operands[i]) fail("operands", "operand " + std::to_string(i + 1) + " is none");
    check_operand(*operands[i]);
    nested_.push_back(dynamic_cast<const Csg*>(operands[i].get()));
    if (operands[i]->transform.animated())
      for (const AnimatedTransform::Key& key : operands[i]->transform.keys()) times_.push_back(key.time);
    if (nested_[i]) times_.insert(times_.end(), nested_[i]->times_.begin(), nested_[i]->times_.end());
    combined_.push_back({operands[i].get(), operands[i]->bounds(), i == 0 ? 1 : weight_of_others_, int(i)});
  }
  std::sort(times_.begin(), times_.end());
  times_.erase(std::unique(times_.begin(), times_.end()), times_.end());
  least_weight_ = given_least_weight_ > 0 ? given_least_weight_ : int(operands.size());
  number_parts();
  combine_bounds();
  areas_ = std::make_unique<Areas>();
  if (auto* by_operand = dynamic_cast<OperandShader*>(shader.get())) {
    for (const Ref<SceneObject>& operand : operands)
      if (!by_operand->stand_for(*this, operand->shader.get()))
        fail("shader", "one OperandShader cannot stand for the shaders of two solids: leave it out, or write one for each");
  } else if (shader && contains_operand_shader(*shader)) {
    fail("shader", "an OperandShader must be the solid's own shader, not part of another");
  }
  // Only a warning: the test may miss a solid that is very small compared with its bounding box.
  if (!something_left()) warn(class_info().name + ": nothing seems to be left of its operands", location_of("operands"));
}

std::vector<SceneObject*> Csg::placed_within() const {
  std::vector<SceneObject*> all;
  for (const Ref<SceneObject>& operand : operands) all.push_back(operand.get());
  return all;
}

void Csg::check_operand(SceneObject& operand) {
  const std::string name = operand.class_info().name, part_of = " part of a solid";
  if (!operand.transform.valid())
    operand.fail("transform",
                 "the transform is singular or beyond what can be counted with, or mirrors at some of its times only");
  if (!operand.closed()) operand.fail("", "it cannot be" + part_of + ": its surface is not closed, so it has no inside");
  if (operand.unbounded()) operand.fail("", "it cannot be" + part_of + ": it has no end");
  if (operand.emission)
    warn(name + ":" + part_of + " does not emit by itself: give the emission to the solid", operand.location_of("emission"));
  if (operand.interior) warn(name + ": the medium inside" + part_of + " is that of the solid", operand.location_of("interior"));
}

namespace {

/// Upper bound of the number of parts of objects that are not NumberedParts: these number a few faces, or nothing.
constexpr std::uint64_t few_parts = 16;

}  // namespace

void Csg::number_parts() {
  leaves_ = 0;
  most_parts_ = 1;
  first_leaf_.clear();
  for (size_t i = 0; i < operands.size(); ++i) {
    first_leaf_.push_back(leaves_);
    leaves_ += nested_[i] ? nested_[i]->leaves_ : 1;
    const auto* parts = dynamic_cast<const NumberedParts*>(operands[i].get());
    most_parts_ = std::max(most_parts_, nested_[i] ? nested_[i]->most_parts_ : parts ? parts->part_count() : few_parts);
  }
  shift_ = 32 - std::bit_width(leaves_ - 1);
  const std::uint64_t room = std::uint64_t(1) << shift_;
  if (most_parts_ > room)
    fail("operands", "there is room for " + std::to_string(room) + " triangles or other parts in each of " +
                         std::to_string(leaves_) + " objects, but one has " + std::to_string(most_parts_));
}

std::uint32_t Csg::encode(size_t operand, std::uint32_t primitive) const {
  std::uint64_t leaf = first_leaf_[operand];
  if (const Csg* inner = nested_[operand]) {
    leaf += std::uint64_t(primitive) >> inner->shift_;
    primitive &= std::uint32_t((std::uint64_t(1) << inner->shift_) - 1);
  }
  return std::uint32_t(leaf << shift_) | primitive;
}

size_t Csg::decode(std::uint32_t primitive, std::uint32_t& of_operand) const {
  const auto leaf = std::uint32_t(std::uint64_t(primitive) >> shift_);
  const auto operand = size_t(std::upper_bound(first_leaf_.begin(), first_leaf_.end(), leaf) - first_leaf_.begin()) - 1;
  of_operand = primitive & std::uint32_t((std::uint64_t(1) << shift_) - 1);
  if (const Csg* inner = nested_[operand])
    of_operand |= std::uint32_t(std::uint64_t(leaf - first_leaf_[operand]) << inner->shift_);
  return operand;
}

void Csg::combine_bounds() {
  own_bounds_ = combined_[0].bounds;
  for (size_t i = 1; i < combined_.size(); ++i) {
    const Bounds3& box = combined_[i].bounds;
    if (weight_of_others_ < 0) break;
    if (given_least_weight_ > 0) {
      own_bounds_.add(box);
    } else {
      for (int k = 0; k < 3; ++k) {
        own_bounds_.low[k] = std::max(own_bounds_.low[k], box.low[k]);
        own_bounds_.high[k] = std::min(own_bounds_.high[k], box.high[k]);
      }
    }
  }
  if (own_bounds_.empty()) own_bounds_ = {};
  bounds_ = own_bounds_;
  if (!bounds_.empty()) bounds_ = bounds_of(transform, own_bounds_);
}

// ---- hits -----------------------------------------------------------------------------------------------------------------

void Csg::own_hit(const CsgCrossing& crossing, Hit& hit) const {
  hit.distance = float(crossing.t);
  hit.object = this;
  hit.primitive = encode(size_t(crossing.operand->index), crossing.hit.primitive);
  hit.u = crossing.hit.u;
  hit.v = crossing.hit.v;
  hit.depth = 0;
}

bool Csg::intersect(const Ray& ray, Hit& hit) const {
  Transform scratch;
  const Transform& t = placed(transform, ray.time, scratch);
  const Ray local = t.identity() ? ray : ray_into(t, ray);
  CsgWalk walk(combined_, least_weight_, local);
  const CsgCrossing* const crossing = walk.next();
  if (!crossing) return false;
  own_hit(*crossing, hit);
  return true;
}

void Csg::all_hits(const Ray& ray, HitList& list) const {
  Transform scratch;
  const Transform& t = placed(transform, ray.time, scratch);
  const Ray local = t.identity() ? ray : ray_into(t, ray);
  CsgWalk walk(combined_, least_weight_, local);
  while (const CsgCrossing* const crossing = list.size < HitList::capacity ? walk.next() : nullptr) {
    Hit hit;
    own_hit(*crossing, hit);
    list.add(hit);
  }
}

void Csg::surface_point(const Ray& ray, const Hit& hit, SurfacePoint& p) const {
  Transform scratch;
  const Transform& t = placed(transform, ray.time, scratch);
  if (t.identity()) {
    own_point(ray, hit, p);
  } else {
    own_point(ray_into(t, ray), hit, p);
    carry_out(t, p);
  }
}

void Csg::own_point(const Ray& ray, const Hit& hit, SurfacePoint& p) const {
  Hit there = hit;
  const size_t i = decode(hit.primitive, there.primitive);
  const SceneObject& operand = *operands[i];
  there.object = &operand;
  p.dpdu = {};
  operand.surface_point(ray, there, p);
  operand.tangents(p);
  p.error = std::max(p.error, error_of_coincident(i, p));
  if (combined_[i].weight < 0) {
    p.normal = -p.normal;
    p.shading_normal = -p.shading_normal;
    p.uv.x = 1 - p.uv.x;
    p.dpdu = -p.dpdu;
  }
  p.object = this;
  p.primitive = hit.primitive;
  p.object_position = object_position_of(transform, p.position);
  p.object_normal = p.normal;
}

// A ray that leaves the surface must begin on the same side of all coincident surfaces, each of which is found only to within
// its own error.
float Csg::error_of_coincident(size_t operand, const SurfacePoint& p) const {
  const float largest = std::max({std::abs(p.position.x), std::abs(p.position.y), std::abs(p.position.z)});
  const float reach = 4 * p.error + rounding_bound(8) * largest;
  const Vector3 normal(p.normal);
  float error = 0;
  for (const CsgOperand& other : combined_) {
    if (other.index == int(operand)) continue;
    const Vector3 around{reach, reach, reach};
    if (!Bounds3{other.bounds.low - around, other.bounds.high + around}.contains(p.position)) continue;
    Ray probe;
    probe.origin = p.position - reach * normal;
    probe.direction = normal;
    probe.maximum = 2 * reach;
    probe.time = p.time;
    Hit hit;
    if (!other.object->intersect(probe, hit)) continue;
    SurfacePoint there;
    other.object->surface_point(probe, hit, there);
    error = std::max(error, std::abs(hit.distance - reach) + there.error + p.error);
  }
  return error;
}

const SceneObject& Csg::operand_at(const SurfacePoint& p, SurfacePoint& there) const {
  const size_t i = decode(p.primitive, there.primitive);
  const SceneObject& operand = *operands[i];
  there.object = &operand;
  Transform scratch;
  const Transform& t = placed(operand.transform, p.time, scratch);
  there.object_position = Point3(operand.transform.written(p.time).back(DoublePoint3(p.object_position)));
  there.object_normal = normalize(normal_into(t, combined_[i].weight < 0 ? -p.object_normal : p.object_normal));
  return operand;
}

void Csg::tangents(SurfacePoint& p) const {
  if (p.dpdu != Vector3{} || p.dpdv != Vector3{}) return;
  SurfacePoint there = p;
  const SceneObject& operand = operand_at(p, there);
  const bool subtracted = combined_[decode(p.primitive, there.primitive)].weight < 0;
  there.position = Point3(DoublePoint3(p.object_position) - (transform.inner_origin() - DoublePoint3{}));
  there.normal = there.shading_normal = subtracted ? -p.object_normal : p.object_normal;
  operand.tangents(there);
  Transform scratch;
  const Transform& t = placed(transform, p.time, scratch);
  p.dpdu = t(subtracted ? -there.dpdu : there.dpdu);
  p.dpdv = t(there.dpdv);
}

int Csg::attribute(int number, const SurfacePoint& p, float* values) const {
  SurfacePoint there = p;
  const MeshFacts* facts = operand_at(p, there).mesh_facts();
  return facts ? facts->attribute(number, there, values) : 0;
}

}  // namespace etendue
