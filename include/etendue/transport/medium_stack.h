#pragma once
// MediumStack: the objects that a path is inside of. Where objects overlap, the one of highest priority fills the space (nested
// dielectrics: Schmidt & Budge 2002, "Simple nested dielectrics in ray traced images").

#include "etendue/scene_object.h"
#include "etendue/shader.h"

namespace etendue {

/// Whether a surface transmits as a thin sheet does: a thin pane, thin paper.
inline bool is_sheet(const Shader& shader) {
  constexpr Lobes through_a_sheet = null_scattering | diffuse_transmission;
  return !shader.transmits() && !shader.has_subsurface_exit() && (shader.possible_lobes() & through_a_sheet);
}

/// Whether paths that cross the surface of an object enter or leave its inside: it is closed, and its shader transmits. A sheet
/// alone encloses nothing, but it bounds the medium that the object names as its interior: a balloon full of smoke.
inline bool enterable(const SceneObject& object) {
  if (!object.shader || !object.closed()) return false;
  return object.shader->transmits() || (object.interior && is_sheet(*object.shader));
}

/// Whether the refractive index inside the object can differ from that outside. Null scattering and sheets do not change the
/// direction of light, so behind such a boundary the index is that before it.
inline bool has_own_index(const SceneObject& object) {
  constexpr Lobes turned = transmission_lobes & ~null_scattering;
  return object.shader && object.shader->transmits() && (object.shader->possible_lobes() & turned);
}

/// A small multiset of objects. The effective medium is that of the highest priority; of equal priorities, that entered last.
/// With more than `capacity` objects at one point, those entered first are dropped.
///
/// A ray leaves a mesh with inverted normals before it enters it. Such exits without an entry are counted, and the next entry
/// cancels one: a path is inside of an object that it has entered more often than left. So the glass of such a mesh refracts by
/// its normals, but the space around it does not count as its inside.
class MediumStack {
 public:
  static constexpr int capacity = 12;

  /// The object whose medium is effective; null: vacuum outside of everything.
  const SceneObject* current() const {
    const SceneObject* top = top_excluding(nullptr, false);
    return top ? top : surroundings_;
  }

  /// Whether a surface of the object has an effect: it has none if the path is inside an object of higher priority.
  bool visible(const SceneObject& object) const {
    const SceneObject* top = top_excluding(&object, false);
    return top == nullptr || object.priority >= top->priority;
  }

  /// Sets the object whose inside is all of space (SceneObject::surrounds). It is below all objects that the path enters.
  void surround(const SceneObject& object) { surroundings_ = &object; }

  /// The object that gives the refractive index on the other side of the object's boundary: the effective one without it, among
  /// those with an index of their own. If the path is about to leave the object, coincident boundaries that it crosses with it
  /// count as well.
  const SceneObject* outside_of(const SceneObject& object) const {
    // Between two touching bricks of one kind (one object in two scenes) there is no boundary.
    for (int i = 0; i < others_; ++i)
      if (other_[i].object == &object && has_own_index(object)) return &object;
    if (others_ == 0 || !inside(object)) return beside(object);
    MediumStack beyond = *this;
    beyond.cross_others();
    return beyond.beside(object);
  }

  /// Boundaries that coincide with the one that the path has hit, with the side from which the path comes: they are crossed
  /// together with it, or not at all.
  void forget_others() { others_ = 0; }
  void note_other(const SceneObject& object, bool entered) {
    if (others_ < most_others) other_[others_++] = {&object, entered};
  }
  void cross_others() {
    for (int i = 0; i < others_; ++i) {
      if (other_[i].entered)
        enter(*other_[i].object);
      else
        leave(*other_[i].object);
    }
    others_ = 0;
  }

  void enter(const SceneObject& object) {
    for (int i = 0; i < owed_; ++i)
      if (left_[i] == &object) {
        left_[i] = left_[--owed_];
        return;
      }
    if (size_ == capacity) {
      for (int i = 1; i < size_; ++i) inside_[i - 1] = inside_[i];
      --size_;
      ++forgotten_;
    }
    inside_[size_++] = &object;
  }
  void leave(const SceneObject& object) {
    for (int i = size_ - 1; i >= 0; --i)
      if (inside_[i] == &object) {
        for (int k = i + 1; k < size_; ++k) inside_[k - 1] = inside_[k];
        --size_;
        return;
      }
    if (forgotten_ > 0)
      --forgotten_;
    else if (owed_ < most_owed)
      left_[owed_++] = &object;
  }
  bool empty() const { return size_ == 0 && !surroundings_; }

  /// Refractive index of a medium (null: 1).
  static Spectrum index(const SceneObject* medium, const Wavelengths& wavelengths) {
    return medium && medium->shader ? medium->shader->interior_index(wavelengths) : Spectrum(1.0f);
  }

 private:
  /// The effective object with a refractive index, without the given one.
  const SceneObject* beside(const SceneObject& object) const {
    const SceneObject* top = top_excluding(&object, true);
    return top || !surroundings_ || !has_own_index(*surroundings_) ? top : surroundings_;
  }

  const SceneObject* top_excluding(const SceneObject* skip, bool with_index) const {
    const SceneObject* top = nullptr;
    for (int i = 0; i < size_; ++i)
      if (inside_[i] != skip && (top == nullptr || inside_[i]->priority >= top->priority) &&
          (!with_index || has_own_index(*inside_[i])))
        top = inside_[i];
    return top;
  }

  bool inside(const SceneObject& object) const {
    for (int i = 0; i < size_; ++i)
      if (inside_[i] == &object) return true;
    return false;
  }

  static constexpr int most_others = 4;
  struct Other {
    const SceneObject* object;
    bool entered;
  };

  static constexpr int most_owed = 4;

  const SceneObject* inside_[capacity];
  const SceneObject* left_[most_owed];  // exits before an entry: inverted meshes
  const SceneObject* surroundings_ = nullptr;
  Other other_[most_others];
  int size_ = 0, owed_ = 0, forgotten_ = 0, others_ = 0;
};

}  // namespace etendue
