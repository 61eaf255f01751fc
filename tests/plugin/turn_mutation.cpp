// A mutation for PathSpaceMetropolis, in one file, out of tree: it rotates the direction from one vertex of a path to the next
// a little, and the surface point that this direction hits replaces the next vertex.
//
// The choices of the vertex and of the rotation have the same probability in both directions, so T(x -> y) is in proportion to
// the pdf per area [1/m^2] of y_i for directions from x_{i-1}: the solid angle of an area at y_i, seen from there, over the
// area.
#include "etendue/transport/mutation.h"

using namespace etendue;

class TurnMutation final : public Mutation {
  float largest = 0.1f;

 public:
  static void describe(Description<TurnMutation>& d) {
    d.summary("Turns one direction of a path, and keeps what comes before and after it.")
        .member<&TurnMutation::largest>("largest", "rad", "greatest angle", range(1e-5, 1));
  }

  std::optional<double> propose(const PathSpace& space, const LightPath& x, LightPath& y,
                                ChoiceNumbers& choices) const override {
    const int k = x.length(), moved = 1 + int(choices.next() * (k - 1));
    space.begin(y, x, moved);
    const float angle = small_change(choices.next(), largest / 1000, largest);
    ChainVertex met;
    if (x.specular(moved) || x.specular(moved - 1) || x.specular(moved + 1)) return {};
    if (!space.follow(y.x.back(), turned(x.x[size_t(moved - 1)].out, angle, choices.next()), y, met)) return {};
    if (!met.scatters_smoothly()) return {};
    y.x.push_back(met);
    y.x.insert(y.x.end(), x.x.begin() + moved + 1, x.x.end());
    if (!space.complete(y) || !space.visible(y, moved)) return {};
    return x.light_angle(moved) / y.light_angle(moved);
  }
};

static const Register<TurnMutation> registered;
