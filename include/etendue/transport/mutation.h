#pragma once
// Mutation: a way to change a path of light into another one.

#include <optional>

#include "etendue/describe/description.h"
#include "etendue/transport/light_path.h"

namespace etendue {

/// A mutation proposes a path y for a path x with the density T(x -> y). The renderer accepts it with the probability
///     min(1, I(y) T(y -> x) / (I(x) T(x -> y)))     (Veach & Guibas 1997, "Metropolis light transport").
class Mutation : public Component {
 public:
  using Interface = Mutation;
  using Parent = Component;
  static void describe(Description<Mutation>&);

  float share = 1;  ///< of proposals, in proportion to those of the other mutations

  /// Fills y, by PathSpace::complete in the end, and returns T(y -> x) / T(x -> y). Empty: it proposes nothing, and x stays. A
  /// mutation may choose among several ways by itself, with probabilities that are part of T, if from y the same way leads
  /// back.
  virtual std::optional<double> propose(const PathSpace&, const LightPath& x, LightPath& y, ChoiceNumbers&) const = 0;
};

/// A small change: its size falls exponentially from `largest` to `smallest`, so that all scales in between are alike likely
/// (Veach 1997, section 11.4.2).
inline float small_change(double u, float smallest, float largest) {
  return largest * float(std::exp(-std::log(double(largest) / double(smallest)) * u));
}

/// A film point at such a distance [pixels] from another, to all sides alike; `largest` in widths of the film. Empty: it is
/// none.
std::optional<Point2> moved_on_film(const PathSpace&, Point2, float smallest, float largest, ChoiceNumbers&);

/// A direction at such an angle [rad] from another, to all sides alike.
Vector3 turned(const Vector3&, float angle, double u);

}  // namespace etendue
