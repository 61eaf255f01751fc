#pragma once
// From runs to results: errors over time and samples, bias and variance apart, who is better and whether that is significant.

#include "check/verify/agreement.h"
#include "pixel_errors.h"
#include "reference.h"

namespace etendue::comparing {

inline constexpr double band_probability = 0.95;

/// At a mark: so many samples of each pixel, and the mean processor time of the runs until there.
struct CurvePoint {
  double samples = 0, seconds = 0;
  Estimate error;        ///< relative mean square error of a run
  Estimate symmetric;    ///< SMAPE of a run
  double variance = 0;   ///< the part of `error` that differs from run to run
  Estimate square_bias;  ///< the part that is the same in all
  double error_of_mean = 0;
};

/// What is known of the bias of a variant's mean, at the end of its runs.
struct Bias {
  bool known = false;              ///< false: there is nothing else to compare it with
  verify::PairAgreement test;      ///< of its mean (A) with the reference (B)
  double relative = 0, error = 0;  ///< of the mean Y of the whole picture, with its standard error
  bool found() const { return known && test.verdict == verify::Verdict::disagrees; }
};

struct VariantResult {
  std::string name;
  std::vector<std::string> misses;
  std::string says;           ///< what it says of its own bias; empty: it has none
  bool in_reference = false;  ///< a part of the agreed mean
  double weight = 0;          ///< there

  std::vector<CurvePoint> curve;
  std::optional<Estimate> slope_over_samples, slope_over_time;
  double samples = 0, seconds = 0;  ///< of a whole run, the mean of all
  double wall_seconds = 0;
  std::uint64_t bad_samples = 0;  ///< in all runs

  /// Errors of the runs at the common number of samples and processor time; empty where a run has not been looked at by then.
  std::vector<double> at_samples, at_time;
  std::optional<double> symmetric_at_samples, symmetric_at_time;
  Bias bias;
};

struct SceneResult {
  std::string file;
  int width = 0, height = 0;
  size_t runs = 0;
  std::string reference;       ///< what it is, in words
  double reference_noise = 0;  ///< its own relative variance, subtracted from errors
  bool reference_is_exact = false;
  double equal_samples = 0, equal_seconds = 0;
  std::vector<VariantResult> variants;
  Winner at_samples, at_time;
};

/// What is drawn of a scene.
struct SceneImages {
  std::vector<double> reference;
  struct One {
    Pixels picture;                ///< of the first run
    std::vector<double> mean;      ///< of all runs
    std::vector<double> variance;  ///< of one run, Y alone: one number a pixel
  };
  std::vector<One> variants;
  verify::Layout layout;  ///< the tiles of the tests of bias
};

struct Results {
  std::vector<SceneResult> scenes;
  double significance = 0.01;
  std::vector<Contest> at_samples, at_time;
  /// Of each variant over all scenes: its error over that of the first variant, at equal processor time.
  std::vector<GeometricMean> geometric_means;
};

/// Where the reference of a scene comes from.
struct ReferenceSource {
  std::optional<Reference> picture;  ///< from a file
  std::string text;                  ///< what it is
  /// Runs made for it: their place among the variants in the store, and how many.
  std::optional<size_t> variant;
  size_t runs = 0;
};

/// What a scene's runs were made of.
struct SceneRuns {
  size_t scene = 0;
  std::string file;
  int width = 0, height = 0, tile = 0;
  std::vector<Subject> subjects;
  size_t runs = 0;
  Budget budget;
  ReferenceSource reference;
};

/// The results of one scene, tests of bias among them at a significance that is already divided among all. Throws Error when
/// there is no reference. `images`, when given, gets what is drawn.
SceneResult analyse(const RunStore&, const SceneRuns&, double significance, SceneImages* images = nullptr);
/// Who is better on which scene, all scenes together.
void judge(Results&);

}  // namespace etendue::comparing
