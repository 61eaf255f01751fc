// The multi-chain perturbation (Veach & Guibas 1997, section 5.3.4; Veach 1997, section 11.4.2): the film point moves by a
// small distance, which gives a new first smooth vertex; the direction in which the path continues from there is rotated by a
// small angle, and leads, through specular vertices with the same lobes as before, to the next smooth vertex; and so on until a
// smooth vertex is followed by another one directly, to which it is connected, or by the luminaire. Caustics that are seen by
// specular reflection change little this way, and so do glossy reflections in glossy surfaces.
//
// All moves and rotations have a uniform azimuth, so
//     T(y -> x) / T(x -> y) = E_{k-1}(x) prod w(x) / (E_{k-1}(y) prod w(y)),
// with w, at each vertex where a direction is rotated, the solid angle of the next vertex over its area.

#include "etendue/transport/mutation.h"

namespace etendue {

class MultiChainMutation final : public Mutation {
  float smallest = 0.3f, largest = 0.1f, smallest_angle = 1e-4f, largest_angle = 0.1f;

 public:
  static void describe(Description<MultiChainMutation>& d) {
    d.summary("Moves a path's place on the film, and turns its direction behind each thing seen before mirrors and glass.",
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
    // The vertices at which directions are rotated, and the smooth vertex at which the changes end.
    std::vector<int> turns;
    int last = x.smooth_before(k);
    while (last > 0 && (turns.empty() || x.specular(last - 1))) {
      turns.push_back(last);
      last = x.smooth_before(last);
    }
    if (turns.empty()) return {};
    const std::optional<Point2> film = moved_on_film(space, x.film, smallest, largest, choices);
    if (!film) return {};
    space.begin(y, x, last);
    PathSpace::Walk walk{x.x.back()};
    if (!space.follow_from_camera(walk, *film, x, y)) return {};
    for (const int turn : turns) {
      const float angle = small_change(choices.next(), smallest_angle, largest_angle);
      const Vector3 direction = turned(-x.x[size_t(turn - 1)].out, angle, choices.next());
      const int next = x.smooth_before(turn);
      std::vector<Lobe> lobes;
      if (next + 1 < turn) lobes = x.lobes(turn - 1, next + 1);
      if (!space.follow_chain(walk, direction, lobes, Transport::radiance, y, next == 0)) return {};
    }
    y.x.insert(y.x.end(), walk.rbegin(), walk.rend());
    if (!space.complete(y) || (last > 0 && !space.visible(y, last - 1))) return {};
    double ratio = x.x[size_t(k - 1)].from_camera / y.x[size_t(k - 1)].from_camera;
    for (const int turn : turns) ratio *= x.camera_angle(turn - 1) / y.camera_angle(turn - 1);
    return ratio;
  }
};

static const Register<MultiChainMutation> registered;

}  // namespace etendue
