#pragma once
// Which members an exporter has asked for.

#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include "etendue/exporter.h"
#include "etendue/scene_object.h"

namespace etendue {

/// As long as it lives, the functions of members.h note what they are asked for on this thread. What an exporter never asks for
/// it cannot have written, so whatever is said there is told to be left out. What it asks for and does not write it must tell
/// itself.
class AskedMembers {
 public:
  AskedMembers();
  ~AskedMembers();
  AskedMembers(const AskedMembers&) = delete;
  AskedMembers& operator=(const AskedMembers&) = delete;

  /// Tells of the camera of a job and of all parts of its scene of which anything was asked: members that are not as by default
  /// and that nobody has asked for. Parts of which nothing was asked are the exporter's to tell.
  void tell(const Job&, Exporting&) const;

  /// Somebody asks for a member.
  static void note(const Component&, std::string_view member);
  /// An object is written as triangles, which tell all that makes its shape: what it has more than all objects have.
  static void note_shape(const SceneObject&);

 private:
  void tell_part(const Component&, Exporting&) const;

  std::unordered_map<const Component*, std::unordered_set<std::string>> asked_;
  AskedMembers* const outer_;
};

}  // namespace etendue
