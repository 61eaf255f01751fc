#pragma once
// The direct light of delta lights at a meter.

#include <cstdint>

#include "etendue/render/job.h"

namespace etendue::measure {

/// The light that reaches a meter straight from the delta lights of a prepared scene (points, distant lights), as a picture of
/// the job's image whose upper left pixel holds the contribution to the mean over the whole picture. Renderers leave this light
/// out, as rays never hit delta lights. The camera must be a Meter at a point.
Image delta_light(const Job&, std::uint64_t seed);

/// Whether the scene has delta lights.
bool has_delta_light(const Job&);

}  // namespace etendue::measure
