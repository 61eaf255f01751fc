#pragma once
// What the manual's pictures show.

#include <optional>
#include <string>

#include "check/conform/fixtures/fixtures.h"
#include "etendue/describe/registry.h"

namespace etendue {

/// A picture of a class: the part that it shows, as in a render description, and a render description of a scene that calls it
/// `part`.
struct PictureScene {
  std::string part, description;
  bool measured = false;  ///< lamps differ by powers of ten: exposed by what comes out
};

/// Nothing for classes that cannot be seen. Sample files are written into the folder of `fixtures`.
std::optional<PictureScene> picture_of(const ClassInfo&, const conform::Fixtures& fixtures);

/// A part that shows more of a class than its defaults do; empty: none is known.
std::string example_of(const ClassInfo&);

}  // namespace etendue
