#pragma once
// FollowsPolarization: implemented, in addition to Renderer, by renderers that follow the polarization of light. All others
// take all light for unpolarized at every scattering, which is wrong behind two polarizing plates, and slightly wrong after two
// mirrors.

#include <string>
#include <vector>

#include "etendue/render/renderer.h"

namespace etendue {

class FollowsPolarization {
 public:
  /// With its present members.
  virtual bool follows_polarization() const = 0;
  /// Whether it reports the Stokes vectors of all its light to the film (LightParts::add_stokes).
  virtual bool keeps_stokes() const = 0;

 protected:
  ~FollowsPolarization() = default;
};

/// The same of any renderer.
bool follows_polarization(const Renderer&);
bool keeps_stokes(const Renderer&);

/// The names of the classes that follow it, with their defaults.
std::vector<std::string> polarization_followers();

/// The polarizing plates of a scene (PolarizingPlate) for users, each with what it does: "'filter' polarizes". Empty: there are
/// none, so that renderers that do not follow polarization err little.
std::vector<std::string> polarizing_plates(const Scene&);

}  // namespace etendue
