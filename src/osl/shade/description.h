#pragma once
// Texts about shaders and networks, in the forms of the reference implementation's oslinfo and testshade.

#include "osl/running/shader_group.h"

namespace etendue::osl {

/// The shader's parameters with their types, defaults and metadata.
void print_description(const Shader&);
/// The network as text, in the form that parse_group reads.
void print_group(const GroupDescription&, const ShaderGroup&);
/// Each layer with its parameters.
void print_layers(const ShaderGroup&);

}  // namespace etendue::osl
