#pragma once
// The scenes of the manual's images.

#include <optional>
#include <string>

#include "check/conform/fixtures/fixtures.h"
#include "etendue/describe/registry.h"

namespace etendue {

/// The image of a class: the component that it shows, as in a render description, and a render description of a scene in which
/// it is named `part`.
struct PictureScene {
  std::string part, description;
  bool measured = false;  ///< exposed by the mean luminance, as emissions differ by powers of ten
};

/// Nullopt for classes that cannot be shown. Sample files are written into the folder of `fixtures`.
std::optional<PictureScene> picture_of(const ClassInfo&, const conform::Fixtures& fixtures);

/// A component that shows more of a class than its defaults do; empty: none is listed.
std::string example_of(const ClassInfo&);

}  // namespace etendue
