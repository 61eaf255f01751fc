#pragma once
// Mutation: the proposal distribution of a Markov chain over paths, for Metropolis light transport in path space. New mutations
// derive from it (src/components/mutations).

#include <optional>

#include "etendue/describe/description.h"
#include "etendue/transport/light_path.h"

namespace etendue {

/// A mutation proposes a path y, given a path x, with the pdf T(x -> y). The renderer accepts it with the probability
///     min(1, I(y) T(y -> x) / (I(x) T(x -> y)))     (Veach & Guibas 1997, "Metropolis light transport").
class Mutation : public Component {
 public:
  using Interface = Mutation;
  using Parent = Component;
  static void describe(Description<Mutation>&);

  float share = 1;  ///< of proposals, in proportion to those of the other mutations

  /// Fills y, which must end with PathSpace::complete, and returns T(y -> x) / T(x -> y). Empty: nothing is proposed, and the
  /// chain stays at x. A mutation may choose among several variants at random, with probabilities that are part of T, if the
  /// same variant leads from y back to x.
  virtual std::optional<double> propose(const PathSpace&, const LightPath& x, LightPath& y, ChoiceNumbers&) const = 0;
};

/// A random perturbation size. It falls exponentially from `largest` to `smallest`, so that all scales in between are equally
/// probable (Veach 1997, section 11.4.2).
inline float small_change(double u, float smallest, float largest) {
  return largest * float(std::exp(-std::log(double(largest) / double(smallest)) * u));
}

/// A film point at such a distance [pixels] from another, in a uniform direction; `largest` is relative to the width of the
/// film. Empty: the point is outside of the film.
std::optional<Point2> moved_on_film(const PathSpace&, Point2, float smallest, float largest, ChoiceNumbers&);

/// A direction at the given angle [rad] from another, with a uniform azimuth (`u`).
Vector3 turned(const Vector3&, float angle, double u);

}  // namespace etendue
