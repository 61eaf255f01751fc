#pragma once
// Descriptions of members that several renderers have, so that each is declared once.

#include <string>

#include "etendue/describe/description.h"
#include "etendue/transport/multiple_importance.h"

namespace etendue {

/// `int`: the longest path in segments. `more` is appended to the help text.
template <auto member, class R>
Description<R>& describe_max_depth(Description<R>& d, const std::string& more = "", Range allowed = at_least(1)) {
  return d.template member<member>("max_depth", "1",
                                   "longest path, in segments: 1 shows luminaires only, 2 adds direct light" + more, allowed,
                                   soft(1, 64), logarithmic);
}

/// `int`: see Roulette::depth.
template <auto member, class R>
Description<R>& describe_roulette_depth(Description<R>& d) {
  return d.template member<member>("roulette_depth", "1", "segments before Russian roulette may end a path", at_least(1),
                                   soft(1, 64), logarithmic);
}

/// `Heuristic`; `when` are conditions under which it has an effect.
template <auto member, class R, class... Conditions>
Description<R>& describe_heuristic(Description<R>& d, Conditions... when) {
  return d.template member<member>("heuristic", "", "how strategies that find the same light are weighted against each other",
                                   choices("balance", "power"), when...);
}

/// `int`s: see Splitting.
template <auto reflect_and_refract, auto wavelengths, class R>
Description<R>& describe_splitting(Description<R>& d) {
  return d
      .template member<reflect_and_refract>(
          "split_depth", "1",
          "how often a path from the camera that has met nothing else is both reflected and refracted; "
          "then one of the two is chosen",
          range(0, 8))
      .template member<wavelengths>(
          "split_wavelengths", "1",
          "how many of a path's wavelengths are followed, each by itself, where refraction disperses them; 1: the hero alone",
          range(1, spectrum_size));
}

/// The text that max_depth adds for renderers that store a whole subpath, and the maximum length of such subpaths [segments]. A
/// vertex takes about a kilobyte with its medium stack and its BSDF, so a subpath of this length takes 100 MB per thread.
inline constexpr int longest_stored_subpath = 100000;
inline const char* const stored_subpath_depth =
    ". Walks are kept as a whole, which takes up to 1 kB for each segment and thread, hence the limit";

}  // namespace etendue
