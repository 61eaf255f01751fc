#include "globals.h"

#include <cstddef>

namespace etendue::osl {

int global_offset(std::string_view name) {
  static constexpr struct {
    std::string_view name;
    std::size_t offset;
  } table[] = {
      {"P", offsetof(Globals, P)},       {"I", offsetof(Globals, I)},         {"N", offsetof(Globals, N)},
      {"Ng", offsetof(Globals, Ng)},     {"u", offsetof(Globals, u)},         {"v", offsetof(Globals, v)},
      {"dPdu", offsetof(Globals, dPdu)}, {"dPdv", offsetof(Globals, dPdv)},   {"Ps", offsetof(Globals, Ps)},
      {"time", offsetof(Globals, time)}, {"dtime", offsetof(Globals, dtime)}, {"dPdtime", offsetof(Globals, dPdtime)},
      {"Ci", offsetof(Globals, Ci)},
  };
  for (const auto& row : table)
    if (row.name == name) return int(row.offset);
  return -1;
}

}  // namespace etendue::osl
