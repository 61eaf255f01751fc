#pragma once
// What a meter reads: the mean over the whole picture of a job, per band and for the eye, with standard errors.
//
// The job is rendered several times with different seeds. The renders are independent whatever the algorithm is, so the spread
// of their means gives the standard error of the mean of all, with all correlations within a render: low-discrepancy samples,
// splats of one path, mutations.
//
// A Meter also reads what pictures do not show: the direct light of delta lights, which rays never hit (delta_light.h), and
// objects that are invisible to cameras.

#include <functional>
#include <string>
#include <vector>

#include "etendue/meter.h"
#include "etendue/render/render.h"

namespace etendue::measure {

/// A mean of independent renders and its standard error.
struct Reading {
  double value = 0, error = 0;
};

struct BandReading {
  std::string channel;       ///< "S0.555nm", "response.red"
  double low = 0, high = 0;  ///< edges [nm]; both 0: a response curve
  Reading reading;           ///< in the quantity's unit per nm
};

struct Measurement {
  MeterQuantity quantity;
  std::vector<BandReading> bands;
  Reading total;        ///< the integral over all bands, in the quantity's unit; 0 for response curves
  Reading photometric;  ///< in the photometric unit
  Reading x, y;         ///< chromaticity, CIE 1931
  int renders = 0;
  std::uint64_t samples = 0;      ///< of all renders
  std::uint64_t bad_samples = 0;  ///< which counted as black
  std::string bias;               ///< of the renderer; empty: it is unbiased
};

struct Options {
  double samples = 1 << 20;  ///< of the whole picture, in all renders together
  int renders = 16;          ///< at least 2
  int bands = 47;            ///< from 360 to 830 nm, for jobs whose image is no SpectralFilm
  int threads = 0;           ///< 0: all cores
  /// Called after each render with the number of renders done; measuring ends with an Error if it returns false.
  std::function<bool(int)> go_on = {};
};

/// Replaces a job's image by the one that is measured: with the bands of its SpectralFilm, or else those of the options; 16 x
/// 16 pixels for a Meter and the job's own for another camera; a BoxFilter, so that all pixels count alike. For a Meter, makes
/// all objects visible to the camera.
void prepare_image(Job&, const Options&);

/// Throws Error if the image has a crop, and the errors of the render.
Measurement measure(const Ref<Job>&, const Options&);

/// Tables for people, and JSON.
std::string measurement_text(const Measurement&);
std::string measurement_json(const Measurement&);

}  // namespace etendue::measure
