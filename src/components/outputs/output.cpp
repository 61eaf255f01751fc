#include "etendue/output.h"

namespace etendue {

void Output::describe(Description<Output>& d) {
  d.summary("Writes the picture to a file, which is either whole or as it was before.")
      .member<&Output::file>("file", "", "where to; without one, the render description's name with the format's ending",
                             Effect::retone)
      .member<&Output::tone_map>("tone_map", "",
                                 "instead of the Job's, or for a format that keeps radiance; none: the Job's for formats "
                                 "that are looked at, no tone map for the others",
                                 Effect::retone);
}

static const Register<Output> registered;

}  // namespace etendue
