// The bidirectional mutation (Veach & Guibas 1997, section 5.3.1; Veach 1997, section 11.4.1): a part of a path is removed, and
// replaced by walks from both remaining ends, which are connected.
//
// r of the path's vertices are removed, from index l on, and r' = r - 1, r or r + 1 are inserted. Both remaining ends are
// smooth vertices, and the probability of a choice (l, r) halves with each further smooth vertex that is removed. With D the
// pdf of the inserted part, averaged over the ways to divide it between the two walks (PathSpace::pdf),
//     T(y -> x) / T(x -> y) = P(l, r' | y) D(x) / (P(l, r | x) D(y)).

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
    const double all = sum(x, k, [](int, int) { return false; });
    double u = choices.next() * all;
    int l = -1, r = 0;
    sum(x, k, [&](int at, int count) {
      l = at;
      r = count;
      return (u -= likely(x, at, count)) < 0;
    });
    if (l < 0) return {};
    const double v = choices.next();
    const int more = v < 0.25 ? -1 : v < 0.5 ? 1 : 0;
    if (r + more < 1 || r + more > longest) return {};  // the reverse mutation would have probability 0
    space.begin(y, x, l);
    const std::vector<ChainVertex> rest(x.x.begin() + l + r, x.x.end());
    if (!space.join(y, rest, r + more, choices)) return {};
    const double back = likely(y, l, r + more) / sum(y, k + more, [](int, int) { return false; });
    return back * PathSpace::pdf(x, l, r) / (likely(x, l, r) / all * PathSpace::pdf(y, l, r + more));
  }

 private:
  /// The relative probability that x_l … x_{l+r-1} are removed.
  static double likely(const LightPath& x, int l, int r) {
    if ((l > 0 && x.specular(l - 1)) || x.specular(l + r)) return 0;
    bool joins = l == 0;
    int smooth = 0;
    for (int i = l; i < l + r; ++i) {
      smooth += !x.specular(i);
      joins = joins || !(x.specular(i - 1) || x.specular(i));
    }
    // A specular chain between two vertices that stay cannot be sampled by walks.
    if (!joins && x.specular(l + r - 1)) return 0;
    return std::ldexp(1.0, -std::max(smooth, 1));
  }
  /// The sum of these over all choices, until `stop(l, r)` returns true. Of very long paths only short parts are removed:
  /// longer ones would almost never be chosen.
  template <class Stop>
  static double sum(const LightPath& x, int k, const Stop& stop) {
    double sum = 0;
    for (int l = 0; l < k; ++l)
      for (int r = 1; l + r <= k && r <= longest; ++r) {
        const double p = likely(x, l, r);
        sum += p;
        if (p > 0 && stop(l, r)) return sum;
      }
    return sum;
  }
  static constexpr int longest = 16;
};

static const Register<BidirectionalMutation> registered;

}  // namespace etendue
