// TabulatedPhase: a phase function given by a table, measured or computed elsewhere.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "etendue/core/math.h"
#include "etendue/phase_function.h"

namespace etendue {
namespace {

// Linear in c = cos(theta) between the table's nodes, and scaled so that it integrates to 1. Stored by increasing h = 1 - c:
// with nodes h_0 = 0 < ... < h_n = 2 and values v_k, the area up to h_k is A_k = 2 pi sum (v_i + v_{i+1}) / 2 (h_{i+1} - h_i).
//
// Sampling. In the interval that contains u A_n, with r = u A_n - A_k, width d and values v, v' at its ends, h is h_k + t d
// with
//     2 pi d (v t + (v' - v) t^2 / 2) = r,   t = 2 s / (v + sqrt(v^2 + 2 (v' - v) s)),   s = r / (2 pi d),
// the form of the root that does not cancel, whichever end is higher.
class TabulatedPhase final : public PhaseFunction {
 public:
  static void describe(Description<TabulatedPhase>& d) {
    d.summary("By a table, as of measured particles or of Mie's theory; linear in the cosine between its values.")
        .member<&TabulatedPhase::values>("values", "1",
                                         "how much goes each way, in any unit: from all the way back, where the cosine of the "
                                         "angle light turns by is -1, to straight on, 1",
                                         required)
        .member<&TabulatedPhase::cosines>(
            "cosines", "1", "where the values stand: as many rising numbers, from -1 to 1; none: at equal distances");
  }
  void prepare() override {
    const size_t n = values.size();
    if (n < 2) fail("values", "at least two are needed");
    if (!cosines.empty() && cosines.size() != n) fail("cosines", fmt::format("there are {}, but {} values", cosines.size(), n));
    for (const float v : values)
      if (!(v >= 0 && v < infinity)) fail("values", fmt::format("{} is neither positive nor 0", v));
    h_.resize(n), v_.resize(n);
    for (size_t k = 0; k < n; ++k) {
      h_[k] = cosines.empty() ? 2 * double(k) / double(n - 1) : 1 - double(cosines[n - 1 - k]);
      v_[k] = double(values[n - 1 - k]);
      if (k > 0 && !(h_[k] > h_[k - 1])) fail("cosines", "must rise");
    }
    if (std::abs(h_.front()) > 1e-6 || std::abs(h_.back() - 2) > 1e-6) fail("cosines", "must go from -1 to 1");
    h_.front() = 0, h_.back() = 2;
    scale_to_one();
  }

  float value(float given) const override {
    const float h = clamp(given, 0, 2);  // by rounding `given` may lie outside
    const size_t k = interval(h_, double(h));
    return float(std::lerp(v_[k], v_[k + 1], (double(h) - h_[k]) / (h_[k + 1] - h_[k])));
  }
  float sample(float u) const override {
    const size_t k = interval(area_, double(u));
    const double d = h_[k + 1] - h_[k], v = v_[k], rise = v_[k + 1] - v, s = (double(u) - area_[k]) / (two_pi * d);
    const double root = std::sqrt(std::max(v * v + 2 * rise * s, 0.0));
    const double t = v + root > 0 ? std::clamp(2 * s / (v + root), 0.0, 1.0) : 0;
    return float(h_[k] + t * d);
  }

  std::vector<float> values{1, 1}, cosines;

 private:
  static constexpr double two_pi = 6.28318530717958647692;

  void scale_to_one() {
    area_.assign(h_.size(), 0);
    for (size_t k = 1; k < h_.size(); ++k) area_[k] = area_[k - 1] + two_pi * (v_[k - 1] + v_[k]) / 2 * (h_[k] - h_[k - 1]);
    const double whole = area_.back();
    if (!(whole > 0 && std::isfinite(whole))) fail("values", "must not all be 0, nor their sum too large");
    for (double& v : v_) v /= whole;
    for (double& a : area_) a /= whole;
  }
  /// The k with rising[k] <= x < rising[k + 1], or the nearest k.
  static size_t interval(const std::vector<double>& rising, double x) {
    const auto after = std::upper_bound(rising.begin() + 1, rising.end() - 1, x);
    return size_t(after - rising.begin()) - 1;
  }

  std::vector<double> h_, v_, area_;  // at the nodes: h, pdf [1/sr], CDF
};

const Register<TabulatedPhase> registered;

}  // namespace
}  // namespace etendue
