#pragma once
// Renderers that an expression names, on a command line or in the laboratory.

#include <string>

#include "etendue/render/job.h"

namespace etendue {

/// The renderer that an expression names. The class of the job's renderer means that renderer with all its settings; any other
/// expression, such as "PathTracer{next_event: false}", creates a new one. `option` is where it was written, for errors. Throws
/// Errors if it is no renderer.
Ref<Renderer> named_renderer(const Job&, const std::string& expression, const std::string& option);
/// Gives a new renderer the job's sampler, light sampler and max_depth, unless its expression sets them; likewise a renderer
/// nested in it. Throws Error if the renderer rejects them.
void take_over(Renderer& to, const Renderer& from);
/// Whether a description sets a member of a component.
bool written(const Component&, const std::string& member);

}  // namespace etendue
