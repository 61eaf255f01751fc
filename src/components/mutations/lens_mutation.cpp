// The lens perturbation (Veach & Guibas 1997, section 5.3.2; Veach 1997, section 11.4.2): the path's film point moves by a
// small distance, and the first smooth vertex that the camera sees there, through specular vertices with the same lobes as
// before, is connected to the rest of the path.
//
// The direction of the move is uniform, so T is the pdf of x_{k-1} for a camera ray:
//     T(y -> x) / T(x -> y) = E_{k-1}(x) / E_{k-1}(y).
// The specular vertices behind x_{k-1} follow from it.

#include "etendue/transport/mutation.h"

namespace etendue {

class LensMutation final : public Mutation {
  float smallest = 0.3f, largest = 0.1f;

 public:
  static void describe(Description<LensMutation>& d) {
    d.summary("Moves a path's place on the film, and keeps all but what is seen there, in mirrors and through glass too.",
              "Veach & Guibas 1997, section 5.3.2; Veach 1997, section 11.4.2")
        .member<&LensMutation::smallest>("smallest", "1", "least distance on the film [pixels]", more_than(0), soft(0.01, 10),
                                         logarithmic)
        .member<&LensMutation::largest>("largest", "1", "greatest distance, over the width of the film", range(1e-4, 1));
  }

  std::optional<double> propose(const PathSpace& space, const LightPath& x, LightPath& y,
                                ChoiceNumbers& choices) const override {
    const int k = x.length(), seen = x.smooth_before(k);
    if (seen > 0 && x.specular(seen - 1)) return {};  // nothing can be connected: see MultiChainMutation
    const std::optional<Point2> film = moved_on_film(space, x.film, smallest, largest, choices);
    if (!film) return {};
    space.begin(y, x, seen);
    PathSpace::Walk walk{x.x.back()};
    if (!space.follow_from_camera(walk, *film, x, y)) return {};
    y.x.insert(y.x.end(), walk.rbegin(), walk.rend());
    if (!space.complete(y) || (seen > 0 && !space.visible(y, seen - 1))) return {};
    return x.x[size_t(k - 1)].from_camera / y.x[size_t(k - 1)].from_camera;
  }
};

static const Register<LensMutation> registered;

}  // namespace etendue
