// The caustic perturbation (Veach & Guibas 1997, section 5.3.3; Veach 1997, section 11.4.2): the direction in which light
// leaves the last vertex but one before the camera turns a little, and where it meets something then is joined to the lens.
//
// Turned directions are alike likely by angle, so T is the density of x_{k-1} for a uniform direction from x_{k-2}:
// T(y -> x) / T(x -> y) = w(x) / w(y), w being the solid angle of an area at x_{k-1} seen from x_{k-2}, over the area.

#include "etendue/transport/mutation.h"

namespace etendue {

class CausticMutation final : public Mutation {
  float smallest = 1e-4f, largest = 0.1f;

 public:
  static void describe(Description<CausticMutation>& d) {
    d.summary("Turns the light's direction before the last thing it meets, and joins where it falls to the lens.",
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
    const float angle = small_change(choices.next(), smallest, largest);
    const Vector3 direction = turned(x.x[size_t(k - 2)].out, angle, choices.next());
    space.begin(y, x, k - 1);
    KeptVertex lit;
    if (!space.follow(y.x.back(), direction, y, lit)) return {};
    y.x.push_back(lit);
    y.x.push_back(x.x.back());
    if (!space.complete(y) || !space.visible(y, k - 1)) return {};
    return double(x.solid_angle(k - 1)) / double(y.solid_angle(k - 1));
  }
};

static const Register<CausticMutation> registered;

}  // namespace etendue
