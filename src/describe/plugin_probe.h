#pragma once

#include <functional>
#include <string>

namespace etendue {

/// The texts that describe a plugin's build; see etendue/describe/abi.h.
struct PluginAnswer {
  std::string abi, instructions;
};

/// Opens a library in a child process, reads what it was built for and passes that to `accept`; then `use` registers its
/// classes there. A damaged library, or another file, may crash or hang meanwhile. Throws Error with the reason alone: this
/// fault, or the Error that `accept` or `use` threw.
void try_plugin(const std::string& file, const std::function<void(const PluginAnswer&)>& accept,
                const std::function<void()>& use);

}  // namespace etendue
