#include "tree.h"

namespace etendue::osl {

const Metadatum* Symbol::find(std::string_view metadatum) const {
  for (const Metadatum& m : metadata)
    if (m.name == metadatum) return &m;
  return nullptr;
}

const Symbol* Expression::root() const {
  switch (kind) {
    case Kind::variable: return symbol;
    case Kind::element:
    case Kind::component:
    case Kind::matrix_component:
    case Kind::field: return operands[0]->root();
    default: return nullptr;
  }
}

const Symbol* Shader::find_parameter(std::string_view wanted) const {
  for (const Symbol* p : parameters)
    if (p->name == wanted) return p;
  return nullptr;
}

const char* name_of(Shader::Kind kind) {
  static constexpr const char* names[] = {"shader", "surface", "displacement", "volume", "light"};
  return names[int(kind)];
}

const char* name_of(Global global) {
  static constexpr const char* names[] = {"P", "I", "N",    "Ng",    "dPdu",    "dPdv", "Ps",
                                          "u", "v", "time", "dtime", "dPdtime", "Ci"};
  return names[int(global)];
}

}  // namespace etendue::osl
