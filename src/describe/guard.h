#pragma once
// Code of plugins may throw anything, anywhere. Where it is called, what comes out becomes an Error that names who threw it.

#include <string>
#include <string_view>

#include "etendue/describe/component.h"
#include "etendue/describe/registry.h"

namespace etendue {

/// What the exception says that is handled now: its own words, or its type when it is no std::exception. To be called in a
/// catch block.
std::string thrown_text();

/// "HShader", with " (of plugin 'libh.so')" when it comes from one.
std::string name_with_plugin(const ClassInfo&);

/// A new object; what its constructor throws becomes an Error.
Ref<Component> create(const ClassInfo&);

}  // namespace etendue
