#pragma once
// Machine: the compiler of groups, in a library of its own (libetendue_osl_machine.so; src/osl/machine), as it needs LLVM. It
// is opened when the first group is to be compiled; where it is missing, groups are interpreted.

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "code.h"
#include "memory_layout.h"

namespace etendue::osl {

class Services;
struct RunState;

/// A layer's defaults and body. It throws what the interpreter would throw, but ExitLayer.
using LayerCode = void (*)(RunState*, std::byte* memory, Services*);

/// The code of a group; its memory is freed with it.
class GroupCode {
 public:
  virtual ~GroupCode() = default;
  std::vector<LayerCode> layers;
};

struct CodeRequest {
  std::string name;  ///< for who looks at the code
  const MemoryLayout& layout;
  int layers = 0;
  std::function<void(Code&, int layer)> emit;
};

class Machine {
 public:
  virtual ~Machine() = default;
  /// Throws Error.
  virtual std::unique_ptr<GroupCode> compile(const CodeRequest&) const = 0;
};

/// Opens the library when it is first called. Null if there is none, which is told once, in the log.
const Machine* machine();
/// What the library calls when it is opened.
void announce_machine(const Machine&, const char* version);

/// How groups run. All ways give the same numbers.
enum class Execute : unsigned char {
  automatic,    ///< interpreted at first; what runs often is compiled meanwhile, by a thread of its own
  interpreter,  ///< never compiled
  compiler      ///< compiled before the first run; an Error if that is not possible
};
/// As chosen, or as the variable of the environment ETENDUE_OSL says: "interpreter", "compiler", else automatic.
Execute execution_mode();
void set_execution_mode(Execute);

}  // namespace etendue::osl
