// The caustic perturbation (Veach & Guibas 1997, section 5.3.3; Veach 1997, section 11.4.2): the direction in which light
// leaves a smooth vertex, or the luminaire, turns a little, and goes through the same kinds of mirrors and clear surfaces as
// before; where it falls then is joined to the lens.
//
// Turned directions are alike likely by angle, so T is the density of what they lead to for a uniform direction:
// T(y -> x) / T(x -> y) = w(x) / w(y), w being the solid angle there over the measure of what it leads to
// (LightPath::light_angle).

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
    if (x.specular(k - 1)) return {};  // seen in a mirror: nothing can be joined to the lens
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
