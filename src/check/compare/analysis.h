#pragma once
// From runs to results: errors over time and samples, bias and variance separately, and which variant is significantly better.

#include "check/verify/agreement.h"
#include "pixel_errors.h"
#include "reference.h"

namespace etendue::comparing {

inline constexpr double band_probability = 0.95;

/// At a mark: the number of samples per pixel, and the mean processor time of the runs until then.
struct CurvePoint {
  double samples = 0, seconds = 0;
  Estimate error;        ///< relative mean square error of a run
  Estimate symmetric;    ///< SMAPE of a run
  double variance = 0;   ///< the part of `error` that varies from run to run
  Estimate square_bias;  ///< the part of `error` that is the same in all runs
  double error_of_mean = 0;
};

/// The bias of a variant's mean at the end of its runs.
struct Bias {
  bool known = false;              ///< false: there is no other variant or reference to compare with
  verify::PairAgreement test;      ///< test of its mean (A) against the reference (B)
  double relative = 0, error = 0;  ///< bias of the mean Y of the whole image, with its standard error
  bool found() const { return known && test.verdict == verify::Verdict::disagrees; }
};

struct VariantResult {
  std::string name;
  std::vector<std::string> misses;
  std::string says;           ///< the bias that its renderer declares; empty: none
  bool in_reference = false;  ///< a part of the agreed mean
  double weight = 0;          ///< its weight in that mean

  std::vector<CurvePoint> curve;
  std::optional<Estimate> slope_over_samples, slope_over_time;
  double samples = 0, seconds = 0;  ///< of a whole run, averaged over all
  double wall_seconds = 0;
  std::uint64_t bad_samples = 0;  ///< in all runs

  /// Errors of the runs at the common number of samples and at the common processor time; empty if a run's first mark is later.
  std::vector<double> at_samples, at_time;
  std::optional<double> symmetric_at_samples, symmetric_at_time;
  Bias bias;
};

struct SceneResult {
  std::string file;
  int width = 0, height = 0;
  size_t runs = 0;
  std::string reference;       ///< its description
  double reference_noise = 0;  ///< its own relative variance, subtracted from errors
  bool reference_is_exact = false;
  double equal_samples = 0, equal_seconds = 0;
  std::vector<VariantResult> variants;
  Winner at_samples, at_time;
};

/// The data for a scene's images and maps in the report.
struct SceneImages {
  std::vector<double> reference;
  struct One {
    Pixels picture;                ///< of the first run
    std::vector<double> mean;      ///< of all runs
    std::vector<double> variance;  ///< of one run, Y only: one number per pixel
  };
  std::vector<One> variants;
  verify::Layout layout;  ///< the tiles of the tests of bias
};

struct Results {
  std::vector<SceneResult> scenes;
  double significance = 0.01;
  std::vector<Contest> at_samples, at_time;
  /// For each variant the geometric mean over all scenes of its error over that of the first variant, at equal processor time.
  std::vector<GeometricMean> geometric_means;
};

/// The source of a scene's reference.
struct ReferenceSource {
  std::optional<Reference> picture;  ///< from a file
  std::string text;                  ///< its description
  /// Runs rendered for the reference: their variant index in the store, and their number.
  std::optional<size_t> variant;
  size_t runs = 0;
};

/// The description of a scene's runs.
struct SceneRuns {
  size_t scene = 0;
  std::string file;
  int width = 0, height = 0, tile = 0;
  std::vector<Subject> subjects;
  size_t runs = 0;
  Budget budget;
  ReferenceSource reference;
};

/// The results of one scene. `significance` is for this scene's tests of bias, already divided among all tests. Throws Error if
/// there is no reference. `images`, if given, receives the data for the report's images.
SceneResult analyse(const RunStore&, const SceneRuns&, double significance, SceneImages* images = nullptr);
/// Determines which variants are significantly better, for all scenes together.
void judge(Results&);

}  // namespace etendue::comparing
