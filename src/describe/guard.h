#pragma once
// Guards calls of plugin code, which may throw exceptions of any type: they become an Error that names the plugin class.

#include <string>
#include <string_view>
#include <vector>

#include "etendue/describe/component.h"
#include "etendue/describe/registry.h"

namespace etendue {

/// The message of the current exception, or its type if it is no std::exception. To be called in a catch block.
std::string thrown_text();
/// The errors of the current exception: those of an Error or Errors, otherwise one with thrown_text(). To be called in a catch
/// block.
std::vector<Error> thrown_errors();

/// "HShader", with " (of plugin 'libh.so')" for a class of a plugin.
std::string name_with_plugin(const ClassInfo&);

/// A new object; exceptions of its constructor become Error.
Ref<Component> create(const ClassInfo&);

}  // namespace etendue
