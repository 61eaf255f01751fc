#pragma once
// SpectralBands: the bands in which a spectral film measures light besides its colour.
//
// Band b has a response r_b(lambda) with the integral R_b [nm], and its value is the mean spectral radiance
//   L_b = 1 / R_b int L(lambda) r_b(lambda) dlambda   [W m^-2 sr^-1 nm^-1].
// A path that carries the n wavelengths lambda_i with the pdfs p_i [1/nm] estimates it, as it estimates X, Y and Z, by
//   L_b ~ sum_i w_i r_b(lambda_i) / R_b   with   w_i = L(lambda_i) / (n p_i).
// Bands with edges are boxes of the response 1, each wavelength lies in one of them at most; the responses of a sensor overlap.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "etendue/core/spectral_function.h"

namespace etendue {

/// Immutable.
class SpectralBands {
 public:
  /// The bands between consecutive edges [nm], which increase strictly: n + 1 edges for n bands.
  explicit SpectralBands(std::vector<float> edges);
  /// Bands with response curves, which are tabulated at whole nanometres and linear between. Their integrals must be positive.
  SpectralBands(std::vector<std::string> names, const std::vector<Color>& responses);

  size_t count() const { return channels_.size(); }
  /// The names of the image's channels: "S0.555nm", "S0.404,5nm" for boxes, as in the layout of Fichet, Pacanowski & Wilkie
  /// 2021, with the wavelength in the middle; "response.NAME" for response curves.
  const std::vector<std::string>& channels() const { return channels_; }
  /// Empty for response curves.
  const std::vector<float>& edges() const { return edges_; }

  bool operator==(const SpectralBands&) const = default;
  /// A text that is the same for equal bands only, for hashes.
  std::string key() const;

  /// The wavelengths of a contribution [nm], and their w_i (see above).
  struct Light {
    std::array<double, spectrum_size> wavelengths{}, weights{};
    Light() = default;
    Light(const Spectrum&, const Wavelengths&);
  };
  /// A contribution's value in one band.
  struct Value {
    size_t band;
    double value;
  };
  /// Sets `values` to those of a contribution that are not zero; reuses its memory.
  void measure(const Light&, std::vector<Value>& values) const;

 private:
  void measure_boxes(const Light&, std::vector<Value>&) const;
  void measure_responses(const Light&, std::vector<Value>&) const;

  std::vector<std::string> channels_;
  std::vector<float> edges_;
  std::vector<double> scales_;  // 1 / R_b [1/nm]
  bool uniform_ = false;        // all boxes are equally wide
  std::vector<float> table_;    // r_b / R_b [1/nm], by whole nanometre from 360 nm, then by band
};

/// Implemented by images that store bands.
class HasBands {
 public:
  /// Throws Error at the member that is wrong.
  virtual std::shared_ptr<const SpectralBands> make_bands() const = 0;

 protected:
  ~HasBands() = default;
};

}  // namespace etendue
