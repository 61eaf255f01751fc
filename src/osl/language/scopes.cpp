#include "scopes.h"

#include <algorithm>

namespace etendue::osl {

const Scope::Entry* Scope::find(const std::string& name) const {
  std::size_t below = std::size_t(-1);
  for (const Scope* s = this; s; s = s->parent) {
    if (const auto found = s->names.find(name); found != s->names.end())
      for (auto e = found->second.rbegin(); e != found->second.rend(); ++e)
        if (e->number < below) return &*e;
    below = std::min(below, s->limit);
  }
  return nullptr;
}

std::vector<FunctionEntry*> Scope::functions(const std::string& name) const {
  std::vector<FunctionEntry*> list;
  std::size_t below = std::size_t(-1);
  for (const Scope* s = this; s; s = s->parent) {
    if (const auto found = s->names.find(name); found != s->names.end())
      for (auto e = found->second.rbegin(); e != found->second.rend(); ++e) {
        if (e->number >= below) continue;
        if (!e->function) return list;
        list.push_back(e->function);
      }
    below = std::min(below, s->limit);
  }
  return list;
}

}  // namespace etendue::osl
