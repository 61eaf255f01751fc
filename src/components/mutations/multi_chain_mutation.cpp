// The multi-chain perturbation (Veach & Guibas 1997, section 5.3.4; Veach 1997, section 11.4.2), here for chains of surfaces
// that scatter smoothly: the film point moves a little, the direction in which the path goes on from the first thing seen turns
// a little, and where that leads is joined to the rest. Glossy surfaces seen in glossy ones change little then.
//
// Both changes are alike likely to all sides, so
//     T(y -> x) / T(x -> y) = E_{k-1}(x) w(x) / (E_{k-1}(y) w(y)),
// w being the solid angle of an area at x_{k-2} seen from x_{k-1}, over the area.

#include "etendue/transport/mutation.h"

namespace etendue {

class MultiChainMutation final : public Mutation {
  float smallest = 0.3f, largest = 0.1f, smallest_angle = 1e-4f, largest_angle = 0.1f;

 public:
  static void describe(Description<MultiChainMutation>& d) {
    d.summary("Moves a path's place on the film, and turns its direction behind the first thing seen.",
              "Veach & Guibas 1997, section 5.3.4; Veach 1997, section 11.4.2")
        .member<&MultiChainMutation::smallest>("smallest", "1", "least distance on the film [pixels]", more_than(0),
                                               soft(0.01, 10), logarithmic)
        .member<&MultiChainMutation::largest>("largest", "1", "greatest distance, over the width of the film", range(1e-4, 1))
        .member<&MultiChainMutation::smallest_angle>("smallest_angle", "rad", "least angle", range(1e-7, 1))
        .member<&MultiChainMutation::largest_angle>("largest_angle", "rad", "greatest angle", range(1e-7, 1));
  }
  void prepare() override {
    if (smallest_angle > largest_angle) fail("smallest_angle", "must not exceed largest_angle");
  }

  std::optional<double> propose(const PathSpace& space, const LightPath& x, LightPath& y,
                                ChoiceNumbers& choices) const override {
    const int k = x.length();
    if (k < 3) return {};
    const auto width = float(space.context.image.width), height = float(space.context.image.height);
    const float distance = small_change(choices.next(), std::min(smallest, largest * width), largest * width);
    const auto across = float(2 * M_PI * choices.next());
    const Point2 film{x.film.x + distance * std::cos(across), x.film.y + distance * std::sin(across)};
    if (!(film.x >= 0 && film.x < width && film.y >= 0 && film.y < height)) return {};
    const float angle = small_change(choices.next(), smallest_angle, largest_angle);
    const Vector3 direction = turned(-x.x[size_t(k - 2)].out, angle, choices.next());
    space.begin(y, x, k - 2);
    KeptVertex seen, behind;
    if (!space.follow_camera(film, y, seen) || !space.follow(seen, direction, y, behind)) return {};
    for (const KeptVertex& v : {behind, seen, x.x.back()}) y.x.push_back(v);
    if (!space.complete(y) || !space.visible(y, k - 3)) return {};
    return weight(x) / weight(y);
  }

 private:
  static double weight(const LightPath& x) {
    const KeptVertex &seen = x.x[x.x.size() - 2], &behind = x.x[x.x.size() - 3];
    return double(seen.reverse) * double(std::abs(dot(behind.point.normal, behind.out))) /
           double(length_squared(seen.point.position - behind.point.position));
  }
};

static const Register<MultiChainMutation> registered;

}  // namespace etendue
