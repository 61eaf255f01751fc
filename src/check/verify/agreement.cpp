// The statistics of agreement.
//
// Each renderer gives K independent passes of the same picture, each with its own random numbers. The means over a tile or over
// the whole picture are compared, so a pass contributes one number to each comparison, a mean of thousands of samples. No
// assumption is made about the dependence of samples within a pass (they are stratified, and splats of one path fall into many
// tiles): the variance is estimated from whole passes only.
//
// 1. Two means m_A, m_B with the passes' variances v_A, v_B: Welch's t = (m_A - m_B) / sqrt(v_A/K_A + v_B/K_B), with the
//    degrees of freedom of Welch & Satterthwaite, and the two-sided probability of Student's t.
//
// 2. The distributions of rendering are skewed: much of the light may come in rare, large contributions. A mean in which some
//    of them are missing is too low, and its estimated variance is too low as well, so that t is too large. For normally
//    distributed pass means, mean and variance are independent; in general
//        Cov(mean, variance) = k3 / K,   Var(mean) = k2 / K     (k2, k3: cumulants of a pass mean),
//    so a pass mean whose average is d below its expectation has, on the average, a variance estimate that is
//        (k3 / k2) d
//    too small (the regression of the variance on the mean). If all light came in events of one size c, as in a Poisson
//    process, k3 / k2 would be c exactly, and v + c d would be the variance under the hypothesis that the other renderer's mean
//    is the true one. This is used here: the variance of the lower renderer becomes v + c d, with c its "event size". Chen 1995
//    and Johnson 1978 correct t for skewness to the same order, but they estimate k3 from the same few passes, in which events
//    too rare to be seen are missing. Here c is estimated from all tiles of the picture together,
//        c = sum_tiles k3 / sum_tiles k2,
//    in which the largest events count most, so that events seen in any tile are assumed possible in all tiles. (Both sums are
//    over tiles' sums of light, in which an event has the same size whatever the tile's size.) A place whose own passes are
//    significantly skewed has its own k3 / k2 if that is larger. The event size of a path length is at least that of shorter
//    lengths: a path with one more segment is the same path seen by way of one more surface. A layer in which a renderer found
//    almost nothing has the event size of all lengths together. Where one pass holds more than half of all light found, no
//    estimate is possible: such a comparison is never counted as a failure.
//
//    No test of means can be valid for all distributions (Bahadur & Savage 1956): if light comes in events of which none was
//    seen anywhere, no statistic can detect them. How often this test errs is simulated in tests/check/verify_test.cpp.
//
// 3. Differences below 1e-5 of the means, or 1e-7 of the picture's mean, are due to float arithmetic; they are subtracted
//    before testing. This also decides the comparison of two renderers without any variance.
//
// 4. All p-values of all pairs are corrected together by Holm's method (1979), which needs no independence. Half of the
//    significance goes to the mean Y of the whole picture, a quarter to the other means of the whole picture, a quarter to
//    the thousands of tiles, so that a small difference everywhere remains significant despite the number of tiles (Holm's
//    method with weights, his section 4).

#include "agreement.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "student.h"

namespace etendue::verify {
namespace {

constexpr double relative_margin = 1e-5, picture_margin = 1e-7;
constexpr double whole_share = 0.5, whole_parts_share = 0.25, tiles_share = 0.25;

/// The moments of one renderer's means, and its event sizes.
struct Known {
  std::vector<Moments> moments;    // at layout.index
  std::vector<double> event_size;  // of each layer, as sums over pixels
  const std::vector<double>& systematic;
  /// The variance of a mean that is due to the systematic error, not to chance.
  double more_variance(size_t at) const { return systematic.empty() ? 0 : systematic[at] * systematic[at]; }
};

/// Whether the skewness exceeds what passes of a normal distribution have in one of a hundred places. The standard error is
/// that of the sample skewness G1 of a normal sample.
bool significantly_skewed(const Moments& m) {
  if (!(m.variance > 0)) return false;
  const double n = m.count;
  const double error = std::sqrt(6 * n * (n - 1) / ((n - 2) * (n + 1) * (n + 3)));
  return std::abs(m.third) > 2.5 * error * std::pow(m.variance, 1.5);
}

Known know(const Layout& layout, const Measured& measured) {
  Known known{{}, {}, measured.systematic};
  known.moments.reserve(layout.count());
  for (size_t layer = 0; layer < layout.layers.size(); ++layer)
    for (size_t place = 0; place < layout.places(); ++place) known.moments.push_back(moments(layout, measured, layer, place));

  for (size_t layer = 0; layer < layout.layers.size(); ++layer) {
    double second = 0, third = 0, seen = 0;
    for (size_t tile = 0; tile < layout.tiles.size(); ++tile) {
      const Moments& m = known.moments[layout.index(layer, tile)];
      const double pixels = layout.pixels(tile);
      second += pixels * pixels * m.variance;
      third += pixels * pixels * pixels * m.third;
      for (const auto& pass : measured.passes) seen += pass[layout.index(layer, tile)] != 0;
    }
    double size = second > 0 ? third / second : 0;
    constexpr double too_few = 8;
    if (seen < too_few && layer > 0) size = std::max(size, known.event_size[0]);
    if (layout.layers[layer].length > 1) size = std::max(size, known.event_size.back());
    known.event_size.push_back(size);
  }
  return known;
}

/// The variance to be added to that of a pass mean if the true mean is higher by `deficit` (lower if negative).
double missing_variance(const Layout& layout, const Known& known, size_t layer, size_t place, double deficit) {
  const Moments& m = known.moments[layout.index(layer, place)];
  double missing = deficit * known.event_size[layer] / layout.pixels(place);
  if (significantly_skewed(m)) missing = std::max(missing, deficit * m.third / m.variance);
  return std::max(missing, 0.0);
}

/// The p-value of Welch's test. `more` is the variance of the means' difference in addition to that of the passes.
double welch_p(double difference, const Moments& a, const Moments& b, double variance_a, double variance_b, double more) {
  const double sa = variance_a / a.count + more / 2, sb = variance_b / b.count + more / 2, sum = sa + sb;
  if (difference <= 0) return 1;
  if (!(sum > 0)) return 0;
  const double freedom = sum * sum / (sa * sa / (a.count - 1) + sb * sb / (b.count - 1));
  return student_two_sided(difference / std::sqrt(sum), freedom);
}

MeanTest test(const Layout& layout, const Known& known_a, const Known& known_b, size_t layer, size_t place, double floor) {
  const Moments& a = known_a.moments[layout.index(layer, place)];
  const Moments& b = known_b.moments[layout.index(layer, place)];
  MeanTest t;
  t.layer = layer;
  t.place = place;
  t.mean_a = a.mean;
  t.mean_b = b.mean;
  const double margin = relative_margin * std::max(std::abs(a.mean), std::abs(b.mean)) + floor;
  const double excess = a.mean - b.mean, difference = std::abs(excess) - margin;
  const size_t at = layout.index(layer, place);
  const double more = known_a.more_variance(at) + known_b.more_variance(at);
  t.plain_p = welch_p(difference, a, b, a.variance, b.variance, more);
  t.p = welch_p(difference, a, b, a.variance + missing_variance(layout, known_a, layer, place, -excess),
                b.variance + missing_variance(layout, known_b, layer, place, excess), more);
  if (t.p > t.plain_p) t.doubt = Doubt::rare_events;
  if (t.p < 1 && (a.one_pass || b.one_pass)) {
    t.p = 1;
    t.doubt = Doubt::one_pass;
  }
  t.z = std::copysign(normal_two_sided_quantile(t.p), excess);
  return t;
}

/// The difference d that a test of level `p` finds with a probability of 95 %: d = q s, with q the sum of both quantiles of
/// Student's t and s the standard error of the difference, in which the lower renderer's variance has grown by c d.
double noticeable(const Layout& layout, const Known& known_a, const Known& known_b, double p) {
  const Moments& a = known_a.moments[layout.index(0, layout.whole())];
  const Moments& b = known_b.moments[layout.index(0, layout.whole())];
  const double more =
      known_a.more_variance(layout.index(0, layout.whole())) + known_b.more_variance(layout.index(0, layout.whole()));
  const double sa = a.variance / a.count + more / 2, sb = b.variance / b.count + more / 2, sum = sa + sb;
  const double mean = 0.5 * (a.mean + b.mean);
  if (!(mean > 0)) return HUGE_VAL;
  double difference = 0;
  if (sum > 0) {
    const double freedom = sum * sum / (sa * sa / (a.count - 1) + sb * sb / (b.count - 1));
    const double q = student_upper_quantile(p / 2, freedom) + student_upper_quantile(0.05, freedom);
    const double growth = std::max(missing_variance(layout, known_a, 0, layout.whole(), 1) / a.count,
                                   missing_variance(layout, known_b, 0, layout.whole(), 1) / b.count);
    difference = 0.5 * (q * q * growth + std::sqrt(q * q * growth * (q * q * growth) + 4 * q * q * sum));
  }
  return difference / mean + relative_margin;
}

}  // namespace

Layout Layout::of(const PixelArea& area, int tile, int lengths) {
  Layout layout;
  layout.lengths = lengths;
  for (int y = area.y0; y < area.y1; y += tile)
    for (int x = area.x0; x < area.x1; x += tile)
      layout.tiles.push_back({x, y, std::min(x + tile, area.x1), std::min(y + tile, area.y1)});
  layout.layers = {{0, 'Y'}, {0, 'X'}, {0, 'Z'}};
  for (int length = 1; length <= lengths; ++length) layout.layers.push_back({length, 'Y'});
  return layout;
}

PixelArea Layout::area(size_t place) const {
  return place < tiles.size() ? tiles[place] : PixelArea{tiles.front().x0, tiles.front().y0, tiles.back().x1, tiles.back().y1};
}

double Moments::error() const { return std::sqrt(variance / count); }

Moments moments(const Layout& layout, const Measured& measured, size_t layer, size_t place) {
  const size_t at = layout.index(layer, place);
  const double n = double(measured.passes.size());
  Moments m;
  m.count = n;
  double sum = 0, largest = 0;
  for (const auto& pass : measured.passes) {
    sum += pass[at];
    largest = std::max(largest, pass[at]);
  }
  m.mean = sum / n;
  double second = 0, third = 0;
  for (const auto& pass : measured.passes) {
    const double d = pass[at] - m.mean;
    second += d * d;
    third += d * d * d;
  }
  m.variance = second / (n - 1);
  m.third = n * third / ((n - 1) * (n - 2));
  m.one_pass = sum > 0 && largest > 0.5 * sum;
  return m;
}

std::vector<double> holm(const std::vector<double>& p, const std::vector<double>& weights) {
  std::vector<size_t> order(p.size());
  std::iota(order.begin(), order.end(), size_t(0));
  std::sort(order.begin(), order.end(), [&](size_t i, size_t j) { return p[i] * weights[j] < p[j] * weights[i]; });
  // The total weight of the hypotheses not yet rejected, summed from the end so that rounding cannot make it negative.
  std::vector<double> left(p.size() + 1, 0.0);
  for (size_t i = p.size(); i-- > 0;) left[i] = left[i + 1] + weights[order[i]];
  std::vector<double> corrected(p.size());
  double highest = 0;
  for (size_t i = 0; i < order.size(); ++i) {
    highest = std::max(highest, std::min(1.0, p[order[i]] * left[i] / weights[order[i]]));
    corrected[order[i]] = highest;
  }
  return corrected;
}

bool Agreement::disagrees() const {
  return std::any_of(pairs.begin(), pairs.end(), [](const PairAgreement& p) { return p.verdict == Verdict::disagrees; });
}

Agreement compare(const Layout& layout, const std::vector<Measured>& renderers, double significance) {
  std::vector<Known> known;
  for (const Measured& measured : renderers) known.push_back(know(layout, measured));

  Agreement agreement;
  agreement.significance = significance;
  const size_t pair_count = renderers.size() * (renderers.size() - 1) / 2;
  std::vector<double> plain, safe;
  size_t whole_parts = 0, tile_tests = 0;
  for (size_t a = 0; a < renderers.size(); ++a)
    for (size_t b = a + 1; b < renderers.size(); ++b) {
      PairAgreement pair;
      pair.a = a;
      pair.b = b;
      pair.by_length = renderers[a].tells_lengths && renderers[b].tells_lengths;
      const size_t whole = layout.index(0, layout.whole());
      const double floor = picture_margin * std::max(known[a].moments[whole].mean, known[b].moments[whole].mean);
      for (size_t layer = 0; layer < layout.layers.size(); ++layer) {
        if (layout.layers[layer].length > 0 && !pair.by_length) continue;
        for (size_t place = 0; place < layout.places(); ++place) {
          pair.tests.push_back(test(layout, known[a], known[b], layer, place, floor));
          plain.push_back(pair.tests.back().plain_p);
          safe.push_back(pair.tests.back().p);
          (place == layout.whole() ? whole_parts : tile_tests) += 1;
        }
      }
      pair.noticeable = noticeable(layout, known[a], known[b], significance * whole_share / double(pair_count));
      agreement.pairs.push_back(std::move(pair));
    }
  agreement.tests = safe.size();
  whole_parts -= agreement.pairs.size();

  std::vector<double> weights;
  for (const PairAgreement& pair : agreement.pairs)
    for (const MeanTest& t : pair.tests)
      weights.push_back(t.place != layout.whole() ? tiles_share / double(tile_tests)
                        : t.layer == 0            ? whole_share / double(pair_count)
                                                  : whole_parts_share / double(whole_parts));
  const std::vector<double> corrected = holm(safe, weights), plain_corrected = holm(plain, weights);
  size_t i = 0;
  for (PairAgreement& pair : agreement.pairs)
    for (MeanTest& t : pair.tests) {
      t.corrected = corrected[i];
      if (corrected[i] <= significance) {
        t.verdict = Verdict::disagrees;
        t.doubt = Doubt::none;
      } else if (plain_corrected[i] <= significance) {
        t.verdict = Verdict::undecided;
      } else {
        t.doubt = Doubt::none;
      }
      pair.verdict = std::max(pair.verdict, t.verdict);
      ++i;
    }
  return agreement;
}

}  // namespace etendue::verify
