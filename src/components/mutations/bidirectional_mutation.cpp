// The bidirectional mutation (Veach & Guibas 1997, section 5.3.1; Veach 1997, section 11.4.1): part of a path is taken away,
// and walks from what is left on both sides are joined instead.
//
// r of the path's vertices go, from a place l on, and r' = r - 1, r or r + 1 come in their place. What is left on both sides
// scatters smoothly, and r is the less likely the more of what goes does, by halves. With D the density of what comes,
// whichever part of it each of the walks makes,
//     T(y -> x) / T(x -> y) = P(l, r | y) D(x) / (P(l, r' | x) D(y)).

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
    if (r + more < 1 || r + more > longest) return {};  // the way back would never be chosen
    space.begin(y, x, l);
    const std::vector<ChainVertex> rest(x.x.begin() + l + r, x.x.end());
    if (!space.join(y, rest, r + more, choices)) return {};
    const double back = likely(y, l, r + more) / sum(y, k + more, [](int, int) { return false; });
    return back * PathSpace::pdf(x, l, r) / (likely(x, l, r) / all * PathSpace::pdf(y, l, r + more));
  }

 private:
  /// How likely it is, compared with others, that x_l … x_{l+r-1} go.
  static double likely(const LightPath& x, int l, int r) {
    if ((l > 0 && x.specular(l - 1)) || x.specular(l + r)) return 0;
    bool joins = l == 0;
    int smooth = 0;
    for (int i = l; i < l + r; ++i) {
      smooth += !x.specular(i);
      joins = joins || !(x.specular(i - 1) || x.specular(i));
    }
    // A chain between two places that stay cannot be made anew by walks.
    if (!joins && x.specular(l + r - 1)) return 0;
    return std::ldexp(1.0, -std::max(smooth, 1));
  }
  /// Adds that up over all that may go, until `stop(l, r)`. Of very long paths short parts go: what is longer is as good as
  /// never chosen.
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
