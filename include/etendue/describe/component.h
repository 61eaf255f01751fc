#pragma once
// Component: the base of all plugin classes (Object in Mitsuba). A component is reference-counted, has described members, and
// is created by the name of its class.

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "etendue/core/error.h"
#include "etendue/core/ref.h"

namespace etendue {

class ClassInfo;

/// Components are prepared by one thread, and then used by many threads at once. After `prepare`, const functions must not
/// change any state that other threads see, and must return the same result for the same arguments, or images would depend on
/// the scheduling of threads.
class Component {
 public:
  virtual ~Component();
  Component(const Component&) = delete;
  Component& operator=(const Component&) = delete;

  void reference() const { count_.fetch_add(1, std::memory_order_relaxed); }
  void release() const {
    if (count_.fetch_sub(1, std::memory_order_acq_rel) == 1) delete this;
  }

  /// The number of Refs to this object; another thread may change it at any time.
  int references() const { return count_.load(std::memory_order_acquire); }

  /// The description of the object's class: name, parent, members, factory. By default that of its C++ type. Objects of classes
  /// that were declared at run time (describe/declared_class.h) override it.
  virtual const ClassInfo& class_info() const;

  /// Called by prepare_tree for its root component, before any component is prepared. A Job sets the origin of rendering space
  /// here.
  virtual void before_prepare() {}
  /// Called once, after all members were set and all members that are components were prepared; called again after an edit. May
  /// throw Error; `fail` throws one with the location where a member was written.
  virtual void prepare() {}
  /// Called instead of `prepare` after an edit that changed no member of Effect::rebuild, neither of this component nor of the
  /// components that such members refer to: an edit of a colour, not of a shape. By default calls `prepare`. Override it to
  /// keep data that is expensive to compute and depends on members of Effect::rebuild only.
  virtual void prepare_again() { prepare(); }

  /// The locations where a component and its members were written, and the component's name there. Null for components made in
  /// code.
  struct Origin {
    Origin();
    Origin(const Origin&);
    ~Origin();

    Location location;
    std::string name;
    std::vector<std::pair<std::string, Location>> members;
  };
  std::unique_ptr<Origin> origin;

  /// The location of a member if it was written, else of the component, else unknown.
  Location location_of(std::string_view member = {}) const;
  /// Throws an Error with the location of the member: "TriangleMesh.file: cannot open 'x.ply': No such file".
  [[noreturn]] void fail(std::string_view member, const std::string& message) const;

 protected:
  Component();

 private:
  mutable std::atomic<int> count_{0};
};

/// Prepares all components that a component refers to, each once, and then the component itself.
void prepare_tree(Component&);

/// Prints a warning; each distinct text is printed once.
void warn(const std::string& message, Location = {});
/// From now on each warning is given to `handle` instead, from whichever thread it comes; empty: warnings are printed again.
void handle_warnings(std::function<void(const std::string& message, Location)> handle);

/// Must be called in a catch block: rethrows an exception that was thrown during an operation on a component, such as
/// "preparing", as Error. An Error without a location gets that of the component, and its message names the component's plugin.
/// Any other exception becomes an Error with the component's location, whose message names the plugin classes that may have
/// thrown it: the component's own class, else the classes of all components that it refers to. Without such classes it is
/// rethrown unchanged.
[[noreturn]] void blame(const Component&, std::string_view doing);

}  // namespace etendue
