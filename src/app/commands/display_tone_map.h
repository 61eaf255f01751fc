#pragma once
// Tone mapping of images in reports.

#include "etendue/render/job.h"

namespace etendue {

/// The tone map for a report's images: the job's if it clips to the display's range, otherwise the default one.
Ref<ToneMap> display_tone_map(const Job&);

}  // namespace etendue
