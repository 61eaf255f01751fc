#pragma once
// Filters by name.

#include "etendue/describe/registry.h"
#include "etendue/filter.h"

namespace etendue::test {

inline Ref<Filter> make_filter(const std::string& name, std::initializer_list<std::pair<const char*, double>> members = {}) {
  const Ref<Component> c = Registry::instance().create(name);
  for (const auto& [member, value] : members) set(*c, member, Value(Number{value}));
  return ref_cast<Filter>(c);
}

inline std::vector<Ref<Filter>> all_filters() {
  std::vector<Ref<Filter>> filters;
  for (const ClassInfo* c : Registry::instance().subclasses(*Registry::instance().find("Filter")))
    filters.push_back(ref_cast<Filter>(Registry::instance().create(c->name)));
  return filters;
}

inline std::string name(const Filter& f) { return f.class_info().name; }

}  // namespace etendue::test
