#pragma once
// MediumStack: the objects a path is inside of. Overlapping objects are settled by priority (Schmidt & Budge 2002,
// "Simple nested dielectrics in ray traced images").

#include "etendue/scene_object.h"
#include "etendue/shader.h"

namespace etendue {

/// A small set of objects, each entered some number of times. The effective medium is that of the highest priority; of
/// equal ones, that entered last. More than `capacity` objects at one point: the deepest are forgotten.
class MediumStack {
 public:
  static constexpr int capacity = 12;

  /// Null: the outside of everything.
  const SceneObject* current() const { return top_excluding(nullptr); }

  /// Whether a surface of the object matters here: it does not when the path is inside something of higher priority.
  bool visible(const SceneObject& object) const {
    const SceneObject* top = top_excluding(&object);
    return top == nullptr || object.priority >= top->priority;
  }

  /// The medium on the other side of the object's boundary: what would be current without it. Where the path is about to
  /// leave the object, what it enters or leaves in the same place counts as well.
  const SceneObject* outside_of(const SceneObject& object) const {
    // Between two bricks of one kind (one object in two scenes) there is no boundary.
    for (int i = 0; i < others_; ++i)
      if (other_[i].object == &object) return &object;
    if (others_ == 0 || !inside(object)) return top_excluding(&object);
    MediumStack beyond = *this;
    beyond.cross_others();
    return beyond.top_excluding(&object);
  }

  /// Boundaries that lie in the same place as the one the path has come to, in the direction it travels in: they are crossed
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
    if (size_ == capacity) {
      for (int i = 1; i < size_; ++i) inside_[i - 1] = inside_[i];
      --size_;
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
  }
  bool empty() const { return size_ == 0; }

  /// Refractive index of a medium (null: 1).
  static Spectrum index(const SceneObject* medium, const Wavelengths& w) {
    return medium && medium->shader ? medium->shader->interior_index(w) : Spectrum(1.0f);
  }

 private:
  const SceneObject* top_excluding(const SceneObject* skip) const {
    const SceneObject* top = nullptr;
    for (int i = 0; i < size_; ++i)
      if (inside_[i] != skip && (top == nullptr || inside_[i]->priority >= top->priority)) top = inside_[i];
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

  const SceneObject* inside_[capacity];
  Other other_[most_others];
  int size_ = 0, others_ = 0;
};

}  // namespace etendue
