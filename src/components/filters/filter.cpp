#include "etendue/filter.h"

namespace etendue {

void Filter::describe(Description<Filter>& d) {
  d.summary("How much a sample counts for a pixel, by its offset from the pixel's centre.",
            "Mitchell & Netravali 1988, Reconstruction filters in computer graphics");
}

static const Register<Filter> registered;

}  // namespace etendue
