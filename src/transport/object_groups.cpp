#include "etendue/transport/object_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "object_names.h"

namespace etendue {

void ObjectGroup::describe(Description<ObjectGroup>& d) {
  d.summary(
       "Objects of the scene under one name, which the layer crypto_group of the image shows as one matte. An object belongs "
       "to "
       "the first group that fits.")
      .member<&ObjectGroup::name>("name", "", "what the group is called", required)
      .member<&ObjectGroup::objects>(
          "objects", "",
          "names of objects as in the description, with * for any letters: 'wheel*'. All within an instance or a nested scene "
          "of such a name belong to the group as well; 'tree_2/leaf' is what is called leaf within tree_2",
          required);
}
static const Register<ObjectGroup> registered;

NamePattern::NamePattern(std::string_view text) {
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find('/', begin), text.size());
    names_.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
}

// After a '*' the rest of the pattern is tried at each later letter; only the last '*' needs to be tried again.
bool NamePattern::fits(std::string_view pattern, std::string_view name) {
  size_t p = 0, n = 0, star = pattern.npos, after = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      after = n;
    } else if (p < pattern.size() && pattern[p] == name[n]) {
      ++p, ++n;
    } else if (star != pattern.npos) {
      p = star + 1;
      n = ++after;
    } else {
      return false;
    }
  }
  return std::ranges::all_of(pattern.substr(p), [](char c) { return c == '*'; });
}

bool NamePattern::matches(const NamePath& path) const {
  for (size_t first = 0; first + names_.size() <= path.size(); ++first)
    if (std::ranges::equal(names_, std::span(path).subspan(first, names_.size()), fits)) return true;
  return false;
}

void require_groups(const std::vector<Ref<ObjectGroup>>& groups, const Scene& scene) {
  if (groups.empty()) return;
  std::set<std::string> named;
  const std::vector<std::string> known = ObjectNames(scene).all();
  for (const Ref<ObjectGroup>& group : groups) {
    if (group->name.empty()) group->fail("name", "a group needs a name");
    if (group->objects.empty()) group->fail("objects", fmt::format("the group '{}' has no objects", group->name));
    if (!named.insert(group->name).second) group->fail("name", fmt::format("two groups are called '{}'", group->name));
    for (const std::string& object : group->objects) {
      const NamePattern pattern(object);
      if (std::ranges::any_of(pattern.names(), &std::string::empty))
        group->fail("objects", fmt::format("'{}' names nothing", object));
      for (const std::string& name : pattern.names())
        if (std::ranges::none_of(known, [&](const std::string& k) { return NamePattern::fits(name, k); }))
          group->fail("objects", fmt::format("no object is called '{}'{}", name, suggestion(name, known)));
    }
  }
}

}  // namespace etendue
