// The bidirectional mutation (Veach & Guibas 1997, section 5.3.1; Veach 1997, section 11.4.1): part of a path is taken away,
// and walks from what is left on both sides are joined instead.
//
// r of the path's vertices go, r = 1, 2, … with probabilities that halve, from a place l that is as likely as any; r' = r - 1,
// r or r + 1 come in their place. With D the density of what comes, whichever part of it each of the walks makes,
//     T(y -> x) / T(x -> y) = P(r' | y) D(x) / (P(r | x) D(y)).

#include "etendue/transport/mutation.h"

namespace etendue {

class BidirectionalMutation final : public Mutation {
 public:
  static void describe(Description<BidirectionalMutation>& d) {
    d.summary("Takes part of a path away and makes it anew by walks from both sides.",
              "Veach & Guibas 1997, section 5.3.1; Veach 1997, section 11.4.1");
  }

  std::optional<double> propose(const PathSpace& space, const LightPath& x, LightPath& y,
                                ChoiceNumbers& choices) const override {
    const int k = x.length();
    int r = 1;
    for (double u = choices.next(); r < k && u >= probability(k, r); ++r) u -= probability(k, r);
    const int l = std::min(int(choices.next() * (k + 1 - r)), k - r);
    const double u = choices.next();
    const int more = u < 0.25 ? -1 : u < 0.5 ? 1 : 0;
    if (r + more < 1) return {};
    space.begin(y, x, l);
    const std::vector<KeptVertex> rest(x.x.begin() + l + r, x.x.end());
    if (!space.join(y, rest, r + more, choices)) return {};
    // Of both paths there are as many places l.
    return probability(k + more, r + more) * PathSpace::density(x, l, r) /
           (probability(k, r) * PathSpace::density(y, l, r + more));
  }

 private:
  /// That r of the k vertices before the lens go.
  static double probability(int k, int r) { return std::ldexp(1.0, -r) / (1 - std::ldexp(1.0, -k)); }
};

static const Register<BidirectionalMutation> registered;

}  // namespace etendue
