// ImageTile: the per-thread side of the film. Everything here runs once per sample.

#include <cstring>
#include <limits>
#include <tuple>

#include "etendue/film/image_tile.h"
#include "etendue/film/splat_label.h"
#include "film_values.h"
#include "filter_window.h"
#include "pixel_area.h"
#include "tile_values.h"

namespace etendue {
namespace {

using BadKind = BadSample::Kind;

// X, Y, Z and a fourth value, added at once.
using Sums = double __attribute__((vector_size(32)));
inline void add(double* sum, const Sums& more) {
  Sums s;
  std::memcpy(&s, sum, sizeof s);
  s += more;
  std::memcpy(sum, &s, sizeof s);
}

/// Negative values up to this fraction of the largest one are rounding errors.
constexpr float negative_tolerance = 1e-5f;

bool regular(const Spectrum& s) {
  const auto& v = s.lanes();
  bool all = true;
  for (int i = 0; i < spectrum_size; ++i) all &= v[i] >= 0 && v[i] <= std::numeric_limits<float>::max();
  return all;
}

/// Checks a spectrum and repairs harmless faults: values at dropped wavelengths are meaningless and set to zero, and slightly
/// negative values from rounding become zero. Returns false, with the kind, if the spectrum is bad.
[[gnu::noinline]] bool repair(Spectrum& s, const Wavelengths& wavelengths, BadKind& kind) {
  if (wavelengths.single())
    for (int i = 1; i < spectrum_size; ++i) s.set(i, 0);
  float largest = 0, least = 0;
  for (int i = 0; i < spectrum_size; ++i) {
    if (std::isnan(s[i])) {
      kind = BadKind::not_a_number;
      return false;
    }
    largest = std::max(largest, s[i]);
    least = std::min(least, s[i]);
  }
  if (std::isinf(largest) || std::isinf(least)) {
    kind = BadKind::infinite;
    return false;
  }
  if (least < -negative_tolerance * largest) {
    kind = BadKind::negative;
    return false;
  }
  s = max(s, 0);
  return true;
}

/// The colour of a sample; returns false, with the kind, if the sample is bad.
[[gnu::always_inline]] inline bool to_color(const Spectrum& value, const Wavelengths& wavelengths, Xyz& color, BadKind& kind) {
  if (regular(value)) [[likely]] {
    color = to_xyz(value, wavelengths);
  } else {
    Spectrum repaired = value;
    if (!repair(repaired, wavelengths, kind)) return false;
    color = to_xyz(repaired, wavelengths);
  }
  // A wavelength pdf of zero or NaN makes a NaN or infinite colour from a finite spectrum.
  const double sum = color.x + color.y + color.z;
  if (std::isfinite(sum)) [[likely]]
    return true;
  kind = std::isnan(sum) ? BadKind::not_a_number : BadKind::infinite;
  return false;
}

[[noreturn]] void refuse_groups() {
  throw Error(
      "this renderer does not tell which luminaires its light comes from, so that light groups (layers 'light.…' of the image) "
      "cannot be kept");
}

[[noreturn]] void refuse_paths() {
  throw Error(
      "this renderer does not tell by which paths its light comes, so that layers by light path expressions ('path.…' of the "
      "image) cannot be kept");
}

/// Throws Error if light groups are wanted and those of a sample do not add up to its colour: a renderer that reports only a
/// part of its light by group, or none, would make layers that are too dark.
void require_groups(const PictureFormat& format, const Xyz& color, std::span<const Spectrum> parts,
                    const Wavelengths& wavelengths) {
  if (format.light_groups.empty()) return;
  constexpr double rounding = 1e-3;
  Xyz sum{};
  for (size_t i = size_t(format.path_lengths);
       i < std::min(parts.size(), size_t(format.path_lengths) + format.light_groups.size()); ++i) {
    Xyz part;
    BadKind kind;
    if (parts[i].black() || !to_color(parts[i], wavelengths, part, kind)) continue;
    sum = {sum.x + part.x, sum.y + part.y, sum.z + part.z};
  }
  const double apart = std::abs(sum.x - color.x) + std::abs(sum.y - color.y) + std::abs(sum.z - color.z);
  if (apart > rounding * (color.x + color.y + color.z)) refuse_groups();
}

/// The same for a part of a Stokes vector, which may be negative. False if it is bad.
bool to_signed_color(const Spectrum& value, const Wavelengths& wavelengths, Xyz& color) {
  Spectrum used = value;
  if (wavelengths.single())
    for (int i = 1; i < spectrum_size; ++i) used.set(i, 0);
  if (!used.finite()) return false;
  color = to_xyz(used, wavelengths);
  return std::isfinite(color.x + color.y + color.z);
}

/// Whether a film point is finite and of ordinary size; false for NaN.
bool ordinary(Point2 film) { return std::abs(film.x) < 1e7f && std::abs(film.y) < 1e7f; }

/// A spectrum that `to_color` accepted, without its harmless faults.
Spectrum without_faults(const Spectrum& value, const Wavelengths& wavelengths) {
  Spectrum good = value;
  BadKind kind;
  if (!regular(good)) repair(good, wavelengths, kind);
  return good;
}

/// Calls f(x, y, factor) for the pixels of an area that a sample contributes to.
template <class F>
void each_reached(const PictureFormat& format, const PixelArea& extent, Point2 film, int px, int py, float weight, F f) {
  if (format.box) return f(px, py, double(weight));
  constexpr int size = PictureFormat::table_size;
  const FilterWindow across(film.x, format.radius, size, extent.x0, extent.x1);
  const FilterWindow down(film.y, format.radius, size, extent.y0, extent.y1);
  for (int j = 0; j < down.count; ++j) {
    const float* row = &format.table[size_t(down.cells[size_t(j)]) * size];
    for (int i = 0; i < across.count; ++i) f(across.first + i, down.first + j, double(row[across.cells[size_t(i)]] * weight));
  }
}

}  // namespace

bool BadSample::operator<(const BadSample& b) const {
  return std::tuple(y, x, sample, kind) < std::tuple(b.y, b.x, b.sample, b.kind);
}

void ImageTile::begin(const ImageBuffer& image, const PixelArea& area, std::uint32_t block) {
  format_ = image.format();
  block_ = block;
  sampled_ = intersection(area, format_->sampled_area);
  area_ = intersection(area, format_->area);
  extent_ = intersection(widened(area, format_->reach()), format_->area);
  light_.assign(4 * pixels(extent_), 0);
  lit_ = false;
  parts_.assign(pixel_values(*format_, extent_), 0);
  samples_.assign(pixels(area_), 0);
  weights_.clear();
  splats_.clear();
  splat_path_ = {-1, -1, 0};
  largest_.clear();
  bad_.clear();
  bad_count_ = paths_ = 0;
}

void ImageTile::note(const BadSample& sample) {
  ++bad_count_;
  if (bad_.size() < FilmCounts::bad_kept) return bad_.push_back(sample);
  const auto last = std::ranges::max_element(bad_, std::less());
  if (sample < *last) *last = sample;
}

void ImageTile::contribute(Point2 film, int px, int py, std::uint32_t sample, const Spectrum& value,
                           const Wavelengths& wavelengths, float weight, std::span<const Spectrum> parts) {
  Xyz color;
  BadKind kind = BadKind::not_a_number;
  bool good = to_color(value, wavelengths, color, kind);
  if (!ordinary(film) || !(weight >= 0 && weight <= std::numeric_limits<float>::max())) [[unlikely]] {
    if (good) kind = weight < 0 ? BadKind::negative : BadKind::not_a_number;
    good = false;
    film = {float(px) + 0.5f, float(py) + 0.5f};
    weight = 1;
  }
  if (!good) [[unlikely]] {
    note({px, py, sample, kind});
    color = {};
  }
  if (largest_wanted_ > 0) [[unlikely]]
    note_large({color.y * double(weight), px, py, sample, film, false});
  if (!sampled_.contains(px, py)) [[unlikely]]
    return;

  if (area_.contains(px, py)) [[likely]] {  // a sample outside of a crop contributes to the crop's pixels, but is not counted
    ++samples_[own_pixel(px, py)];
    if (weight != 1) [[unlikely]] {
      if (weights_.empty()) weights_.assign(pixels(area_), 0);
      weights_[own_pixel(px, py)] += double(weight) - 1;
    }
  }
  if (color.x == 0 && color.y == 0 && color.z == 0) return;
  lit_ = true;
  if (!parts_.empty()) [[unlikely]] {
    require_groups(*format_, color, parts, wavelengths);
    add_parts(film, px, py, wavelengths, weight, parts);
    if (format_->bands) {
      static thread_local std::vector<SpectralBands::Value> measured;
      format_->bands->measure({without_faults(value, wavelengths), wavelengths}, measured);
      each_reached(*format_, extent_, film, px, py, weight, [&](int x, int y, double factor) {
        double* sum = &parts_[place_of_parts(*format_, extent_, x, y) + 3 * format_->parts()];
        for (const auto& [band, in_band] : measured) sum[band] += factor * in_band;
      });
    }
  }
  add_light(film, px, py, color, weight);
}

void ImageTile::add_light(Point2 film, int px, int py, const Xyz& color, float weight) {
  const Sums light{color.x, color.y, color.z, color.y * color.y};
  if (format_->box) {
    if (!area_.contains(px, py)) return;
    const double w = double(weight);
    add(&light_[4 * (size_t(py - extent_.y0) * size_t(extent_.width()) + size_t(px - extent_.x0))],
        Sums{w, w, w, w * w} * light);
    return;
  }
  constexpr int size = PictureFormat::table_size;
  const FilterWindow across(film.x, format_->radius, size, extent_.x0, extent_.x1);
  const FilterWindow down(film.y, format_->radius, size, extent_.y0, extent_.y1);
  for (int j = 0; j < down.count; ++j) {
    const float* row = &format_->table[size_t(down.cells[size_t(j)]) * size];
    double* sum =
        &light_[4 * (size_t(down.first + j - extent_.y0) * size_t(extent_.width()) + size_t(across.first - extent_.x0))];
    for (int i = 0; i < across.count; ++i, sum += 4) {
      const double w = double(row[across.cells[size_t(i)]] * weight);
      add(sum, Sums{w, w, w, w * w} * light);
    }
  }
}

void ImageTile::add_parts(Point2 film, int px, int py, const Wavelengths& wavelengths, float weight,
                          std::span<const Spectrum> parts) {
  const size_t count = std::min(parts.size(), format_->parts());
  for (size_t part = 0; part < count; ++part) {
    if (parts[part].black()) continue;
    Xyz color;
    BadKind kind;
    const bool good = part < format_->first_stokes() ? to_color(parts[part], wavelengths, color, kind)
                                                     : to_signed_color(parts[part], wavelengths, color);
    if (!good) continue;
    each_reached(*format_, extent_, film, px, py, weight, [&](int x, int y, double factor) {
      double* sum = &parts_[place_of_parts(*format_, extent_, x, y) + 3 * part];
      sum[0] += factor * color.x;
      sum[1] += factor * color.y;
      sum[2] += factor * color.z;
    });
  }
}

void ImageTile::note_large(const LargeSample& s) {
  if (s.luminance > 0) keep_larger(largest_, s, largest_wanted_);
}

void ImageTile::keep_larger(std::vector<LargeSample>& kept, const LargeSample& s, size_t most) {
  // A heap with the smallest one in front; ties are broken by position, so that the order of merging does not matter.
  const auto larger = [](const LargeSample& a, const LargeSample& b) {
    return std::tuple(-a.luminance, a.y, a.x, a.sample, a.film.y, a.film.x) <
           std::tuple(-b.luminance, b.y, b.x, b.sample, b.film.y, b.film.x);
  };
  if (kept.size() >= most) {
    if (kept.empty() || !larger(s, kept.front())) return;
    std::pop_heap(kept.begin(), kept.end(), larger);
    kept.pop_back();
  }
  kept.push_back(s);
  std::push_heap(kept.begin(), kept.end(), larger);
}

void ImageTile::splat(Point2 film, int px, int py, std::uint32_t sample, const Spectrum& value, const Wavelengths& wavelengths,
                      int length) {
  const PixelArea& all = format_->sampled_area;
  // Splats outside of the sampled pixels are dropped, since there are no camera samples either: at the picture's edge both
  // estimate the same mean over the part of the filter that lies inside.
  if (!(film.x >= float(all.x0) && film.x < float(all.x1) && film.y >= float(all.y0) && film.y < float(all.y1))) return;
  Xyz color;
  BadKind kind = BadKind::not_a_number;
  if (!to_color(value, wavelengths, color, kind)) [[unlikely]]
    return note({px, py, sample, kind});
  if (!format_->light_groups.empty() || !format_->path_layers.empty()) [[unlikely]] {
    const SplatLabel label = SplatLabel::unpacked(length, format_->light_groups.size());
    if (!format_->light_groups.empty() && label.group < 0) refuse_groups();
    if (!format_->path_layers.empty() && label.matches == SplatLabel::unknown) refuse_paths();
  }
  const bool same = splat_path_.x == px && splat_path_.y == py && splat_path_.sample == sample;
  splat_path_ = {px, py, sample};
  splats_.push_back({film, color, length, same});
  if (format_->bands) [[unlikely]] {
    const SpectralBands::Light light(without_faults(value, wavelengths), wavelengths);
    parts_.insert(parts_.end(), light.wavelengths.begin(), light.wavelengths.end());
    parts_.insert(parts_.end(), light.weights.begin(), light.weights.end());
  }
  if (largest_wanted_ > 0) [[unlikely]]
    note_large(
        {color.y * (double(format_->width) * double(format_->height) / double(pixels(all))), px, py, sample, film, true});
}

}  // namespace etendue
