// The caustic perturbation (Veach & Guibas 1997, section 5.3.3; Veach 1997, section 11.4.2): the direction in which light
// leaves a smooth vertex, or the luminaire, is rotated by a small angle, and the light is traced through specular vertices with
// the same lobes as before; the smooth vertex that it reaches is connected to the lens.
//
// The azimuth of the rotation is uniform, so T is the pdf of the new vertex for a uniform direction:
//     T(y -> x) / T(x -> y) = w(x) / w(y)
// with w the solid angle of the direction per measure of the vertices that it leads to (LightPath::light_angle).

#include "etendue/transport/mutation.h"

namespace etendue {

class CausticMutation final : public Mutation {
  float smallest = 1e-4f, largest = 0.1f;

 public:
  static void describe(Description<CausticMutation>& d) {
    d.summary(
         "Turns the direction of light before the mirrors and glass it comes through, and joins where it falls to the lens.",
         "Veach & Guibas 1997, section 5.3.3; Veach 1997, section 11.4.2")
        .member<&CausticMutation::smallest>("smallest", "rad", "least angle", range(1e-7, 1))
        .member<&CausticMutation::largest>("largest", "rad", "greatest angle", range(1e-7, 1));
  }
  void prepare() override {
    if (smallest > largest) fail("smallest", "must not exceed largest");
  }

  std::optional<double> propose(const PathSpace& space, const LightPath& x, LightPath& y,
                                ChoiceNumbers& choices) const override {
    const int k = x.length();
    if (x.specular(k - 1)) return {};  // a specular vertex is seen, which cannot be connected to the lens
    const int from = x.smooth_before(k - 1);
    const float angle = small_change(choices.next(), smallest, largest);
    const Vector3 direction = turned(x.x[size_t(from)].out, angle, choices.next());
    space.begin(y, x, from + 1);
    std::vector<Lobe> lobes;
    if (from + 1 < k - 1) lobes = x.lobes(from + 1, k - 2);
    if (!space.follow_chain(y.x, direction, lobes, Transport::importance, y)) return {};
    y.x.push_back(x.x.back());
    if (!space.complete(y) || !space.visible(y, k - 1)) return {};
    const double there = y.light_angle(k - 1);
    if (!(there > 0)) return {};
    return x.light_angle(k - 1) / there;
  }
};

static const Register<CausticMutation> registered;

}  // namespace etendue
