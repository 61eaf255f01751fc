// The lens perturbation (Veach & Guibas 1997, section 5.3.2; Veach 1997, section 11.4.2): the path's place on the film moves a
// little, and what the camera sees there is joined to the rest of the path.
//
// The film point moves by a distance that is as likely in any direction, so T is the density of x_{k-1} as what a camera ray
// meets: T(y -> x) / T(x -> y) = E_{k-1}(x) / E_{k-1}(y).

#include "etendue/transport/mutation.h"

namespace etendue {

class LensMutation final : public Mutation {
  float smallest = 0.3f, largest = 0.1f;

 public:
  static void describe(Description<LensMutation>& d) {
    d.summary("Moves a path's place on the film, and keeps all but the first thing seen.",
              "Veach & Guibas 1997, section 5.3.2; Veach 1997, section 11.4.2")
        .member<&LensMutation::smallest>("smallest", "1", "least distance on the film [pixels]", more_than(0), soft(0.01, 10),
                                         logarithmic)
        .member<&LensMutation::largest>("largest", "1", "greatest distance, over the width of the film", range(1e-4, 1));
  }

  std::optional<double> propose(const PathSpace& space, const LightPath& x, LightPath& y,
                                ChoiceNumbers& choices) const override {
    const int k = x.length();
    const auto width = float(space.context.image.width), height = float(space.context.image.height);
    const float distance = small_change(choices.next(), std::min(smallest, largest * width), largest * width);
    const auto angle = float(2 * M_PI * choices.next());
    const Point2 film{x.film.x + distance * std::cos(angle), x.film.y + distance * std::sin(angle)};
    if (!(film.x >= 0 && film.x < width && film.y >= 0 && film.y < height)) return {};
    space.begin(y, x, k - 1);
    KeptVertex seen;
    if (!space.follow_camera(film, y, seen)) return {};
    y.x.push_back(seen);
    y.x.push_back(x.x.back());
    if (!space.complete(y) || !space.visible(y, k - 2)) return {};
    return double(x.x[size_t(k - 1)].reverse) / double(y.x[size_t(k - 1)].reverse);
  }
};

static const Register<LensMutation> registered;

}  // namespace etendue
