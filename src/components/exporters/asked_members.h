#pragma once
// Tracks the members that an exporter has read, in order to warn of the others.

#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include "etendue/exporter.h"
#include "etendue/scene_object.h"

namespace etendue {

/// During its lifetime, the functions of members.h record on this thread which members are read. An exporter cannot have
/// written a member that it never read, so a warning states that the member is left out. If the exporter reads a member and
/// does not write it, it must add the warning itself.
class AskedMembers {
 public:
  AskedMembers();
  ~AskedMembers();
  AskedMembers(const AskedMembers&) = delete;
  AskedMembers& operator=(const AskedMembers&) = delete;

  /// Warns of members that were never read and differ from their defaults, of the job's camera and all components of its scene
  /// of which any member was read. The exporter itself warns of other components.
  void tell(const Job&, Exporting&) const;

  /// Records that a member is read.
  static void note(const Component&, std::string_view member);
  /// An object is written as triangles, which express all members of its shape: records those that not all objects have.
  static void note_shape(const SceneObject&);

 private:
  void tell_part(const Component&, Exporting&) const;

  std::unordered_map<const Component*, std::unordered_set<std::string>> asked_;
  AskedMembers* const outer_;
};

}  // namespace etendue
