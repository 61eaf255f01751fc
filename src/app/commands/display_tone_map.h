#pragma once
// How pictures within reports are shown.

#include "etendue/render/job.h"

namespace etendue {

/// The tone map of a report's pictures: the job's, unless that leaves them as they are.
Ref<ToneMap> display_tone_map(const Job&);

}  // namespace etendue
