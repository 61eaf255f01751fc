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

/// In a catch block: throws on what came out while something was done with a component, such as "preparing". An Error gets the
/// component's place when it has none, and is told with the component's plugin. Anything else becomes an Error at the
/// component's place that names the classes of plugins which may have thrown it: the component's own, else those of all parts
/// it refers to.
[[noreturn]] void blame(const Component&, std::string_view doing);

}  // namespace etendue
