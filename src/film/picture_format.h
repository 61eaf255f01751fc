#pragma once
// PictureFormat: the values derived from an ImageBuffer's description when it is prepared: pixels, layers, and the tabulated
// filter.

#include <cstdint>
#include <string>
#include <vector>

#include "etendue/film/image_buffer.h"
#include "spectral_bands.h"
#include "surface_layers.h"

namespace etendue {

/// Names of channels with a response curve begin with it.
inline constexpr const char* response_prefix = "response.";
/// Key of the metadata of an image with bands: their edges [nm], separated by spaces.
inline constexpr const char* band_edges_key = "band_edges";

struct PictureFormat {
  int width = 0, height = 0;
  PixelArea area, sampled_area;  ///< as the functions of ImageBuffer with these names
  bool cropped = false;
  std::vector<std::string> layers;
  int path_lengths = 0;
  /// Names of the light groups, as in ImageBuffer::layers without "light."; the last group holds the light of luminaires in no
  /// other group. Empty: there are no light groups.
  std::vector<std::string> light_groups;
  static constexpr const char* light_prefix = "light.";
  static constexpr const char* rest_group = "rest";
  static constexpr size_t most_light_groups = 256;
  /// Layers by light path expression: "path.NAME = EXPRESSION" in ImageBuffer::layers.
  struct PathLayer {
    std::string name, expression;
    bool operator==(const PathLayer&) const = default;
  };
  std::vector<PathLayer> path_layers;
  static constexpr const char* path_prefix = "path.";
  /// Whether S1, S2 and S3 of the Stokes vector are stored: the layer of this name in ImageBuffer::layers. S0 is the picture.
  bool stokes = false;
  static constexpr const char* stokes_layer = "stokes";
  static constexpr size_t stokes_parts = 3;
  /// The layers that show surfaces, which a SurfaceFilm collects.
  SurfaceLayers surfaces;
  /// The bands of a spectral film. Null: it has none.
  std::shared_ptr<const SpectralBands> bands;

  /// The filter tabulated over one quadrant, weight at ((i + 0.5) / table_size * radius).
  static constexpr int table_size = 64;
  std::vector<float> table;
  std::vector<std::int64_t> fixed_weights;  ///< the same as multiples of 2^-30 of the largest magnitude
  float radius = 0.5f;
  bool box = false;      ///< radius 0.5, constant: each sample contributes to its own pixel only
  int filter_reach = 0;  ///< pixels to each side that the filter of a pixel covers

  /// Integrals of the tabulated filter, centred at a pixel, over a part of the film; exact for the table.
  struct Integral {
    double filter = 0, square = 0;  ///< [pixel^2]
    /// The variance of a filtered mean relative to the variance of the unfiltered mean of as many samples as lie in one pixel.
    double noise() const { return filter != 0 ? square / (filter * filter) : 0; }
  };
  std::vector<Integral> shares;  ///< over the pixels around its own, one quadrant of (filter_reach + 1)^2 pixels
  Integral whole;                ///< over all pixels

  /// Parts of the light that are stored besides the whole: by path length, then by group, then by expression, then those of the
  /// Stokes vector, which have values of both signs.
  size_t parts() const { return first_stokes() + (stokes ? stokes_parts : 0); }
  size_t first_stokes() const { return size_t(path_lengths) + light_groups.size() + path_layers.size(); }
  /// Values that are stored besides the whole, in groups of three: X, Y, Z of each part, then the bands, filled up with zeros.
  size_t triples() const { return parts() + (bands ? (bands->count() + 2) / 3 : 0); }
  size_t pixels() const { return size_t(area.width()) * size_t(area.height()); }
  size_t index(int x, int y) const { return size_t(y - area.y0) * size_t(area.width()) + size_t(x - area.x0); }
  /// Pixels to each side that a sample anywhere in a pixel may contribute to: a sample at the edge of its pixel lies half a
  /// pixel from the centre, and contributes to pixels whose centres are nearer than the radius.
  int reach() const { return box ? 0 : filter_reach; }
  /// The integral of a pixel's filter over the film.
  Integral over_film(int x, int y) const;
  /// The expected sum of the filter weights of camera samples at a pixel, where pixel i has `weight(i)` samples. Pixels outside
  /// of a crop are assumed to have as many samples as this pixel.
  template <class Weight>
  double expected(int x, int y, Weight weight) const {
    double sum = 0;
    each_share(x, y, [&](int i, int j, const Integral& share) {
      sum += share.filter * weight(area.contains(i, j) ? index(i, j) : index(x, y));
    });
    return sum;
  }
  /// FNV-1a hash of the filter, the names of light groups, the expressions, whether there are Stokes vectors, and the bands:
  /// sums with different hashes must not be added.
  std::uint64_t hash() const;
  /// Whether sums collected with one format are valid for the other.
  bool collects_as(const PictureFormat&) const;
  /// Whether both have the same pixels and filter.
  bool samples_as(const PictureFormat&) const;

  void set_filter(std::vector<float> weights, float filter_radius);

 private:
  bool within_reach(int x, int y) const;
  template <class F>
  void each_share(int x, int y, F f) const {
    const int r = filter_reach;
    for (int j = std::max(y - r, 0); j <= std::min(y + r, height - 1); ++j)
      for (int i = std::max(x - r, 0); i <= std::min(x + r, width - 1); ++i)
        f(i, j, shares[size_t(std::abs(j - y) * (r + 1) + std::abs(i - x))]);
  }
};

}  // namespace etendue
