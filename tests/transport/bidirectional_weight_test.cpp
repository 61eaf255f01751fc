// The multiple importance sampling weights of all strategies that make a path sum to 1, for any pdfs, and are in proportion to
// the pdfs of the strategies.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "etendue/transport/bidirectional_weight.h"

namespace etendue {
namespace {

/// A path x_0 (on a luminaire) … x_last (the lens) with random pdfs, as each strategy sees it.
struct MadeUp {
  int last;
  std::vector<float> from_light, from_camera;
  std::vector<bool> specular;  ///< whether scattering at x_i is specular
  float next_event_point_pdf;
  double merging;

  MadeUp(std::mt19937& random, int length, double merged, double mirrors) : last(length), merging(merged) {
    std::uniform_real_distribution<float> u(0.1f, 3);
    std::bernoulli_distribution mirror(mirrors);
    for (int i = 0; i <= last; ++i) {
      from_light.push_back(u(random));
      from_camera.push_back(u(random));
      specular.push_back(i > 0 && i < last && mirror(random));
    }
    next_event_point_pdf = u(random);
  }

  /// The product of the pdfs of strategy j. `of_walk`: x_0 has the pdf of emission in strategy 1, too.
  double pdf(int j, bool of_walk = false) const {
    double p = 1;
    for (int i = 0; i <= last; ++i)
      p *= double(i >= j                           ? from_camera[size_t(i)]
                  : (i == 0 && j == 1 && !of_walk) ? next_event_point_pdf
                                                   : from_light[size_t(i)]);
    return p;
  }
  double merged_pdf(int i) const { return pdf(i, true) * merging * double(from_light[size_t(i)]); }
  bool connects(int j) const {
    if (j == 0) return true;
    return !specular[size_t(j - 1)] && !specular[size_t(j)] && last > 1;
  }

  double moment(int s, Heuristic heuristic) const {
    double found = 0;
    weight(s, false, heuristic, &found);
    return found;
  }
  float weight(int s, bool merge, Heuristic heuristic, double* moment = nullptr) const {
    std::vector<SubpathVertex> light, camera;
    for (int i = 0; i < s; ++i) light.push_back(vertex(i, from_light[size_t(i)], from_camera[size_t(i)]));
    for (int i = last; i >= s; --i) camera.push_back(vertex(i, from_camera[size_t(i)], from_light[size_t(i)]));
    // The reverse pdfs that a connection replaces are set to -1 in the subpaths, since the weight must not read them there. The
    // `leaves_specularly` flags of the last vertices belong to the sampled continuations and must not be read either, so they
    // are flipped.
    if (!merge && s > 0) light.back().leaves_specularly = !light.back().leaves_specularly;
    camera.back().leaves_specularly = !camera.back().leaves_specularly;
    for (std::vector<SubpathVertex>* walk : {&light, &camera})
      for (size_t k = 0; k < 2 && k < walk->size(); ++k)
        if (!merge || walk == &camera || k == 0) (*walk)[walk->size() - 1 - k].pdf_reverse = -1;
    const auto at = [](const std::vector<float>& list, int i) {
      return i >= 0 && size_t(i) < list.size() ? list[size_t(i)] : 0;
    };
    ConnectedPath path{light.data(),
                       s,
                       camera.data(),
                       last + 1 - s,
                       at(from_camera, s - 1),
                       at(from_camera, s - 2),
                       at(from_light, s),
                       at(from_light, s + 1),
                       next_event_point_pdf,
                       from_light[0],
                       true,
                       {merging, 0}};
    if (moment) *moment = path_tracing_moment(path, heuristic);
    if (!merge) return bidirectional_weight(path, heuristic);
    // A photon stores the pdf of its previous vertex, sampled from the merged vertex, over the pdf of the direction, here
    // `back`.
    const float back = 0.3f;
    path.light_last_from_camera /= back;
    path.light_before_from_camera = -1;
    const PhotonWeight photon = photon_weight(path, path.camera_last_from_light, heuristic);
    path.light = nullptr;
    path.light_last_from_camera = path.next_event_point_pdf = path.pdf_emission_origin = -1;
    return merging_weight(path, photon, back, heuristic);
  }
  SubpathVertex vertex(int i, float pdf_forward, float pdf_reverse) const {
    SubpathVertex v;
    v.kind = i == 0 ? PathVertex::Kind::luminaire : i == last ? PathVertex::Kind::camera : PathVertex::Kind::surface;
    v.leaves_specularly = specular[size_t(i)];
    v.pdf_forward = pdf_forward;
    v.pdf_reverse = pdf_reverse;
    return v;
  }
};

TEST(BidirectionalWeight, of_all_strategies_sum_to_one_in_proportion_to_their_pdfs) {
  std::mt19937 random(3);
  for (const Heuristic heuristic : {Heuristic::balance, Heuristic::power})
    for (const double merging : {0.0, 0.7, 40.0})
      for (int n = 0; n < 400; ++n) {
        const MadeUp path(random, 2 + n % 6, merging, n % 3 == 0 ? 0.4 : 0);
        const double power = heuristic == Heuristic::balance ? 1 : 2;
        double sum = 0, all = 0;
        std::vector<std::pair<double, double>> known;  // weight, pdf
        // Strategy last + 1, with all vertices from the luminaire, would have to hit the lens.
        for (int s = 0; s <= path.last; ++s)
          if (path.connects(s)) known.emplace_back(path.weight(s, false, heuristic), path.pdf(s));
        for (int i = 1; merging > 0 && i < path.last; ++i)
          if (!path.specular[size_t(i)]) known.emplace_back(path.weight(i, true, heuristic), path.merged_pdf(i));
        for (const auto& [weight, pdf] : known) {
          sum += weight;
          all += std::pow(pdf, power);
        }
        EXPECT_NEAR(sum, 1, 1e-5);
        for (const auto& [weight, pdf] : known) EXPECT_NEAR(weight, std::pow(pdf, power) / all, 1e-5);
      }
}

// The second moment of path tracing, f^2 sum_{j=0,1} w_j^2 / p_j with the weights of these two strategies among each other, is
// (f / p_s)^2 G p_s for whichever strategy s made the path.
TEST(BidirectionalWeight, each_strategy_tells_the_second_moment_of_path_tracing) {
  std::mt19937 random(5);
  for (const Heuristic heuristic : {Heuristic::balance, Heuristic::power})
    for (int n = 0; n < 400; ++n) {
      const MadeUp path(random, 2 + n % 6, 0, n % 3 == 0 ? 0.4 : 0);
      const double power = heuristic == Heuristic::balance ? 1 : 2;
      double all = 0, moment = 0;
      for (const int j : {0, 1})
        if (path.connects(j)) all += std::pow(path.pdf(j), power);
      for (const int j : {0, 1})
        if (path.connects(j)) moment += std::pow(std::pow(path.pdf(j), power) / all, 2) / path.pdf(j);
      for (int s = 0; s <= path.last; ++s)
        if (path.connects(s)) EXPECT_NEAR(path.moment(s, heuristic) / (moment * path.pdf(s)), 1, 1e-5);
    }
}

TEST(BidirectionalWeight, without_merging_nothing_is_merged) {
  std::mt19937 random(4);
  const MadeUp path(random, 4, 0, 0);
  EXPECT_EQ(path.weight(2, true, Heuristic::power), 0);
}

}  // namespace
}  // namespace etendue
