#pragma once
// What walks and connections note for people; like record.h, nothing when nobody listens.

#include "etendue/transport/sample_context.h"
#include "vertex.h"

namespace etendue {

void record_walk(std::vector<PathRecord::Vertex>&, std::span<const Vertex>);

/// The features of the first surface along a camera ray, for renderers whose walks do not keep its hit.
void note_first_surface(const Scene&, const Ray&, SampleContext&);

}  // namespace etendue
