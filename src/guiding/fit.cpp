// Fits the lobes and the share of a region to a batch of samples, by weighted expectation maximization (guiding/guide.h).

#include <algorithm>
#include <cmath>

#include "etendue/core/warp.h"
#include "etendue/guiding/guide.h"

namespace etendue {
namespace {

using DoubleLanes = double __attribute__((vector_size(64)));
constexpr int lobes = LobeMixture::size;

// The range of a learned share: scattering finds light that the guide has not learned, and must keep a positive probability.
constexpr double least_share = 0.05, most_share = 0.85;
// Maximum of known_: earlier batches count as no more effective samples than this, so that results learned with worse lobes
// fade out.
constexpr double most_known = 4000;
// Maximum of seen_: the moments of X cover about this number of the latest samples.
constexpr double most_seen = 20000;
// Added to the number of samples of a lobe's mean direction, as if spread over all directions: one sample alone makes no narrow
// lobe.
constexpr double spread_samples = 0.05;
// A lobe with a smaller weight is restarted at samples where the pdf is too low.
constexpr float least_weight = 0.004f;
// Iterations per batch: for the first one, which has no earlier fit, and for the others.
constexpr int first_iterations = 10, iterations = 3;
// The concentration of a lobe at its start.
constexpr float new_concentration = 30;

/// Random numbers that follow from a region's samples, so that results do not depend on threads and their timing.
class Chance {
 public:
  explicit Chance(std::uint64_t bits) : bits_(bits) {}
  double next() {
    bits_ = mix_bits(bits_ + 0x9e3779b97f4a7c15ull);
    return double(bits_ >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t bits_;
};

/// The mean cosine between a lobe's directions and its axis, coth k - 1 / k.
double mean_cosine(double k) { return 1 / std::tanh(k) - 1 / k; }
/// An approximation of its inverse (Banerjee et al. 2005, "Clustering on the unit hypersphere using von Mises-Fisher
/// distributions").
double concentration_of(double r) {
  return std::clamp(r * (3 - r * r) / (1 - std::min(r * r, 1 - 1e-9)), double(LobeMixture::least_concentration),
                    double(LobeMixture::most_concentration));
}

/// Whether a sample is valid: its numbers are finite, which fails for a source at distance 0, for example.
bool tells(const GuideSample& s) {
  return s.found > 0 && std::isfinite(s.found) && std::isfinite(s.scatter) && s.nearness < 1e15f && is_finite(s.position) &&
         is_finite(s.direction);
}

/// The source of a sample's light as seen from the centre of the region.
struct Seen {
  Vector3 direction;
  float nearness;
};

}  // namespace

class Guide::Fit {
 public:
  Fit(Region& region, std::span<const GuideSample* const> samples, const GuideSettings& settings)
      : r_(region), settings_(settings) {
    double sum = 0;
    const double keep = std::min(most_seen / std::max(r_.seen_, 1.0), 1.0);
    for (double* x : {&r_.seen_, &r_.found_, &r_.found_squared_}) *x *= keep;
    for (const GuideSample* s : samples)
      if (tells(*s)) {
        used_.push_back(s);
        const auto x = double(s->found);
        sum += x;
        r_.seen_ += 1;
        r_.found_ += x;
        r_.found_squared_ += x * x;
        r_.count_ += 1;
        for (int i = 0; i < 3; ++i) {
          const auto p = double(s->position[i]);
          r_.sum_[i] += p;
          r_.squares_[i] += p * p;
        }
      }
    if (used_.empty()) return;
    scale_ = r_.found_ / r_.found_squared_;
    effective_ = scale_ * sum;
    double variance = 0;
    double mean[3];
    for (int i = 0; i < 3; ++i) {
      mean[i] = r_.sum_[i] / r_.count_;
      variance += std::max(r_.squares_[i] / r_.count_ - mean[i] * mean[i], 0.0);
    }
    centre_ = {float(mean[0]), float(mean[1]), float(mean[2])};
    // A source closer to the centre than half the spread of the samples is seen in very different directions from them:
    // nearness is limited.
    most_nearness_ = float(2 / std::max(std::sqrt(variance), 1e-20));
  }

  void run() {
    if (!(effective_ > 0)) return;
    const bool first = !(r_.known_ > 0);
    if (first) begin();
    before_ = r_.lobes_;
    share_before_ = double(r_.share_);
    for (int i = 0; i < (first ? first_iterations : iterations); ++i) iterate();
    r_.known_ = std::min(r_.known_ + effective_, most_known);
    r_.gathered_ += effective_;
    replace();
  }

 private:
  Seen seen(const GuideSample& s) const {
    const Vector3 v = s.direction + s.nearness * (s.position - centre_);
    const float scale = 1 / std::max(length(v), 1e-10f);
    return {scale * v, std::min(scale * s.nearness, most_nearness_)};
  }

  /// Starts the lobes at samples: with a probability in proportion to X, and to the distance from existing lobes (Arthur &
  /// Vassilvitskii 2007, "k-means++").
  void begin() {
    Chance chance(used_.size());
    std::vector<double> weight;
    for (const GuideSample* s : used_) weight.push_back(s->specular ? 0 : double(s->found));
    r_.share_ = settings_.share;
    for (int k = 0; k < lobes; ++k) {
      double sum = 0;
      for (const double w : weight) sum += w;
      if (!(sum > 0)) {  // no samples are left: uniform directions
        r_.lobes_.set(
            centre_, k,
            {warp::sphere({(float(k) + 0.5f) / lobes, float(k) * 0.618f - float(int(float(k) * 0.618f))}), 0, 1, 1.0f / lobes});
        continue;
      }
      double rest = chance.next() * sum;
      size_t i = 0;
      while (i + 1 < weight.size() && rest >= weight[i]) rest -= weight[i++];
      const Seen at = seen(*used_[i]);
      r_.lobes_.set(centre_, k, {at.direction, at.nearness, new_concentration, 1.0f / lobes});
      for (size_t j = 0; j < weight.size(); ++j) {
        const double apart = std::max(1 - double(dot(seen(*used_[j]).direction, at.direction)), 0.0);
        weight[j] = std::min(weight[j], double(used_[j]->found) * apart);
      }
    }
  }

  void iterate() {
    DoubleLanes whole{}, x{}, y{}, z{}, nearness{};
    double scattered = 0;
    const float a = r_.share_;
    for (const GuideSample* s : used_) {
      const auto w = float(scale_ * double(s->found));
      if (s->specular) {
        scattered += double(w);
        continue;
      }
      const LobeLanes each = a * SeenLobes(r_.lobes_, s->position).pdfs(s->direction);
      float sum = (1 - a) * s->scatter;
      for (int i = 0; i < lobes; ++i) sum += each[i];
      if (!(sum > 0)) continue;
      const LobeLanes part = each * (w / sum);
      const Seen at = seen(*s);
      whole += __builtin_convertvector(part, DoubleLanes);
      x += __builtin_convertvector(part * at.direction.x, DoubleLanes);
      y += __builtin_convertvector(part * at.direction.y, DoubleLanes);
      z += __builtin_convertvector(part * at.direction.z, DoubleLanes);
      nearness += __builtin_convertvector(part * at.nearness, DoubleLanes);
      scattered += double(w * (1 - a) * s->scatter / sum);
    }
    double guided = 0;
    LobeMixture::Lobe made[lobes];
    double parts[lobes];
    for (int i = 0; i < lobes; ++i) {
      const LobeMixture::Lobe old = before_.seen_from(centre_, i);
      const double n = r_.known_ * share_before_ * double(old.weight), all = n + whole[i];
      const double cosine = n > 0 ? mean_cosine(double(old.concentration)) : 0;
      const double mx = n * cosine * double(old.direction.x) + x[i], my = n * cosine * double(old.direction.y) + y[i],
                   mz = n * cosine * double(old.direction.z) + z[i], resultant = std::sqrt(mx * mx + my * my + mz * mz);
      parts[i] = all;
      guided += all;
      if (!(resultant > 1e-12)) {
        made[i] = r_.lobes_.seen_from(centre_, i);
        continue;
      }
      made[i].direction = {float(mx / resultant), float(my / resultant), float(mz / resultant)};
      made[i].nearness = float(std::min((n * double(old.nearness) + nearness[i]) / all, double(most_nearness_)));
      made[i].concentration = float(concentration_of(resultant / (all + spread_samples)));
    }
    for (int i = 0; i < lobes; ++i) {
      made[i].weight = float((parts[i] + 0.01) / (guided + 0.01 * lobes));
      r_.lobes_.set(centre_, i, made[i]);
    }
    if (settings_.learn_share)
      r_.share_ =
          float(std::clamp((guided + 1) / (guided + scattered + r_.known_ * (1 - share_before_) + 2), least_share, most_share));
  }

  /// Restarts lobes of negligible weight at samples with a large X, where the pdf is too low.
  void replace() {
    Chance chance(used_.size() + (std::uint64_t(r_.gathered_) << 20));
    const double mean = r_.found_ / r_.seen_;
    std::vector<double> excess;
    double all = 0;
    for (int k = 0; k < lobes; ++k) {
      if (r_.lobes_.weight[k] >= least_weight) continue;
      if (excess.empty())
        for (const GuideSample* s : used_) {
          const double x = s->specular ? 0 : double(s->found);
          excess.push_back(x > 2 * mean ? x : 0);
          all += excess.back();
        }
      if (!(all > 0)) return;
      double rest = chance.next() * all;
      size_t i = 0;
      while (i + 1 < excess.size() && rest >= excess[i]) rest -= excess[i++];
      const Seen at = seen(*used_[i]);
      r_.lobes_.set(centre_, k, {at.direction, at.nearness, new_concentration, 2 * least_weight});
    }
    if (excess.empty()) return;
    float sum = 0;
    for (int k = 0; k < lobes; ++k) sum += r_.lobes_.weight[k];
    r_.lobes_.weight /= sum;
  }

  Region& r_;
  const GuideSettings& settings_;
  std::vector<const GuideSample*> used_;
  double effective_ = 0, scale_ = 0;
  Point3 centre_;
  float most_nearness_ = 0;
  LobeMixture before_;
  double share_before_ = 0;
};

Guide::Region Guide::fitted(std::uint32_t region, std::span<const GuideSample* const> samples) const {
  Region fitted = regions_[region];
  Fit(fitted, samples, settings_).run();
  return fitted;
}

}  // namespace etendue
