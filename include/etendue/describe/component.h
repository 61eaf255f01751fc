#pragma once
// Component: the root of every part. It is counted, described and created by name.

#include <atomic>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "etendue/core/error.h"
#include "etendue/core/ref.h"

namespace etendue {

class ClassInfo;

/// Parts are prepared by one thread, and then used by many at once: after `prepare`, const functions must not change anything
/// that others see, and must give the same for the same arguments, or pictures would depend on threads.
class Component {
 public:
  virtual ~Component();
  Component(const Component&) = delete;
  Component& operator=(const Component&) = delete;

  void reference() const { count_.fetch_add(1, std::memory_order_relaxed); }
  void release() const {
    if (count_.fetch_sub(1, std::memory_order_acq_rel) == 1) delete this;
  }

  /// What is known of the object's class: name, parent, members, factory.
  const ClassInfo& class_info() const;

  /// Called before the members that are components are prepared, when this component is what prepare_tree was asked for: a
  /// Job tells them here what coordinates they are to count in.
  virtual void before_prepare() {}
  /// Called once, after all members are set and after the members that are components were prepared; again after an
  /// edit. May throw an Error; `fail` throws one with the place where a member was written.
  virtual void prepare() {}
  /// Called instead of `prepare` after an edit that left alone all that members of Effect::rebuild say, here and in the parts
  /// which such members hold: a colour, not a shape. By default `prepare`. What takes long and depends on those members only
  /// can be kept.
  virtual void prepare_again() { prepare(); }

  /// Where a component and its members were written, and the name it was given there. Absent for one made in code.
  struct Origin {
    Location location;
    std::string name;
    std::vector<std::pair<std::string, Location>> members;
  };
  std::unique_ptr<Origin> origin;

  /// The place of a member when it was written, else of the component, else unknown.
  Location location_of(std::string_view member = {}) const;
  /// Throws an Error at the place of the member: "TriangleMesh.file: cannot open 'x.ply': No such file".
  [[noreturn]] void fail(std::string_view member, const std::string& message) const;

 protected:
  Component() = default;

 private:
  mutable std::atomic<int> count_{0};
};

/// Prepares a component after all the components it refers to, each once.
void prepare_tree(Component&);

/// Reports something the user should know but that stops nothing (shown once per distinct text).
void warn(const std::string& message, Location = {});

/// In a catch block: throws on what came out while something was done with a component, such as "preparing". An Error gets the
/// component's place when it has none, and is told with the component's plugin. Anything else becomes an Error at the
/// component's place that names the classes of plugins which may have thrown it: the component's own, else those of all parts
/// it refers to.
[[noreturn]] void blame(const Component&, std::string_view doing);

}  // namespace etendue
