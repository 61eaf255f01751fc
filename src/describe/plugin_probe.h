#pragma once

#include <functional>
#include <string>

namespace etendue {

/// What a plugin says of itself; see etendue/describe/abi.h.
struct PluginAnswer {
  std::string abi, instructions;
};

/// Opens a library in a child process, asks it there what it was built for and lets `accept` look at that; then `use` takes in
/// what it has enlisted. A library that is damaged, or something else, may crash or never return on the way. Throws Error with
/// the reason alone: what it was, or what `accept` or `use` threw.
void try_plugin(const std::string& file, const std::function<void(const PluginAnswer&)>& accept,
                const std::function<void()>& use);

}  // namespace etendue
