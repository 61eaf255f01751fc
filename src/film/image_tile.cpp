// ImageTile: the per-thread side of the film. Everything here runs once per sample.

#include <cstring>
#include <limits>

#include "etendue/film/image_buffer.h"
#include "filter_window.h"
#include "pixel_area.h"

namespace etendue {
namespace {

using BadKind = BadSample::Kind;

// X Y Z and a weight, added at once.
using Sums = double __attribute__((vector_size(32)));
inline void add(double* sum, const Sums& more) {
  Sums s;
  std::memcpy(&s, sum, sizeof s);
  s += more;
  std::memcpy(sum, &s, sizeof s);
}

/// Values below zero by no more than this part of the largest are rounding.
constexpr float negative_tolerance = 1e-5f;

bool regular(const Spectrum& s) {
  const auto& v = s.lanes();
  bool all = true;
  for (int i = 0; i < spectrum_size; ++i) all &= v[i] >= 0 && v[i] <= std::numeric_limits<float>::max();
  return all;
}

/// What is wrong with a spectrum, and the spectrum with what is not wrong put right: values at wavelengths that were
/// dropped mean nothing, and negative ones by rounding are zero.
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

/// The colour of a sample; false with the kind when it is bad.
[[gnu::always_inline]] inline bool to_color(const Spectrum& value, const Wavelengths& wavelengths, Xyz& color, BadKind& kind) {
  if (regular(value)) [[likely]] {
    color = to_xyz(value, wavelengths);
  } else {
    Spectrum repaired = value;
    if (!repair(repaired, wavelengths, kind)) return false;
    color = to_xyz(repaired, wavelengths);
  }
  // A density of zero or one that is no number makes a colour that is no number from a spectrum that is one.
  const double sum = color.x + color.y + color.z;
  if (std::isfinite(sum)) [[likely]]
    return true;
  kind = std::isnan(sum) ? BadKind::not_a_number : BadKind::infinite;
  return false;
}

/// Also false for what is no number.
bool ordinary(Point2 film) { return std::abs(film.x) < 1e7f && std::abs(film.y) < 1e7f; }

size_t pixels(const PixelArea& a) { return size_t(std::max(a.width(), 0)) * size_t(std::max(a.height(), 0)); }

}  // namespace

void ImageTile::begin(const ImageBuffer& buffer, const PixelArea& area) {
  buffer_ = &buffer;
  sampled_ = intersection(area, buffer.sampled_area());
  area_ = intersection(area, buffer.area());
  extent_ = intersection(widened(area, buffer.reach()), buffer.area());
  sums_.assign(4 * pixels(extent_), 0);
  moments_.assign(3 * pixels(area_), 0);
  features_.assign(buffer.wants_features() ? ImageBuffer::feature_values * pixels(area_) : 0, 0);
  lengths_.assign(3 * size_t(buffer.path_lengths) * pixels(extent_), 0);
  splats_.clear();
  largest_.clear();
  bad_.clear();
  bad_count_ = paths_ = 0;
}

void ImageTile::note(int x, int y, std::uint32_t sample, BadSample::Kind kind) {
  ++bad_count_;
  if (bad_.size() < ImageBuffer::bad_samples_kept) bad_.push_back({x, y, sample, kind});
}

void ImageTile::contribute(Point2 film, int px, int py, std::uint32_t sample, const Spectrum& value,
                           const Wavelengths& wavelengths, float weight, std::span<const Spectrum> by_length) {
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
    note(px, py, sample, kind);
    color = {};
  }
  if (buffer_->largest_wanted_ > 0) [[unlikely]]
    note_large({color.y * double(weight), px, py, sample, film, false});
  if (!sampled_.contains(px, py)) [[unlikely]]
    return;

  if (area_.contains(px, py)) [[likely]] {  // beside a crop a sample counts for the pixels of the crop alone
    double* moment = &moments_[3 * (size_t(py - area_.y0) * size_t(area_.width()) + size_t(px - area_.x0))];
    moment[0] += 1;
    moment[1] += color.y;
    moment[2] += color.y * color.y;
  }

  if (!lengths_.empty() && good) [[unlikely]]
    add_lengths(film, px, py, wavelengths, weight, by_length);

  const Sums light{color.x, color.y, color.z, 0};
  if (extent_.contains(px, py)) [[likely]] {
    double* own = &sums_[4 * (size_t(py - extent_.y0) * size_t(extent_.width()) + size_t(px - extent_.x0))];
    own[3] += double(weight);
    if (buffer_->box_) add(own, double(weight) * light);
  }
  if (buffer_->box_) return;
  constexpr int size = ImageBuffer::table_size;
  const FilterWindow across(film.x, buffer_->filter_radius_, size, extent_.x0, extent_.x1);
  const FilterWindow down(film.y, buffer_->filter_radius_, size, extent_.y0, extent_.y1);
  for (int j = 0; j < down.count; ++j) {
    const float* row = &buffer_->filter_table_[size_t(down.cells[size_t(j)]) * size];
    double* sum =
        &sums_[4 * (size_t(down.first + j - extent_.y0) * size_t(extent_.width()) + size_t(across.first - extent_.x0))];
    for (int i = 0; i < across.count; ++i, sum += 4) add(sum, double(row[across.cells[size_t(i)]] * weight) * light);
  }
}

void ImageTile::add_lengths(Point2 film, int px, int py, const Wavelengths& wavelengths, float weight,
                            std::span<const Spectrum> by_length) {
  const size_t count = std::min(by_length.size(), size_t(buffer_->path_lengths)), stride = 3 * size_t(buffer_->path_lengths);
  for (size_t length = 0; length < count; ++length) {
    if (by_length[length].black()) continue;
    Xyz color;
    BadKind kind;
    if (!to_color(by_length[length], wavelengths, color, kind)) continue;
    const auto add = [&](int x, int y, double factor) {
      double* sum =
          &lengths_[stride * (size_t(y - extent_.y0) * size_t(extent_.width()) + size_t(x - extent_.x0)) + 3 * length];
      sum[0] += factor * color.x;
      sum[1] += factor * color.y;
      sum[2] += factor * color.z;
    };
    if (buffer_->box_) {
      add(px, py, double(weight));
      continue;
    }
    constexpr int size = ImageBuffer::table_size;
    const FilterWindow across(film.x, buffer_->filter_radius_, size, extent_.x0, extent_.x1);
    const FilterWindow down(film.y, buffer_->filter_radius_, size, extent_.y0, extent_.y1);
    for (int j = 0; j < down.count; ++j) {
      const float* row = &buffer_->filter_table_[size_t(down.cells[size_t(j)]) * size];
      for (int i = 0; i < across.count; ++i)
        add(across.first + i, down.first + j, double(row[across.cells[size_t(i)]] * weight));
    }
  }
}

void ImageTile::note_large(const LargeSample& s) {
  if (!(s.luminance > 0)) return;
  keep_larger(largest_, s, buffer_->largest_wanted_);
}

void ImageTile::splat(Point2 film, int px, int py, std::uint32_t sample, const Spectrum& value, const Wavelengths& wavelengths,
                      int length) {
  const PixelArea& all = buffer_->sampled_area();
  // Light beside the pixels that are sampled is left out, as camera samples have none from there either: at the picture's
  // edge both estimate the same mean over the part of the filter that lies inside.
  if (!(film.x >= float(all.x0) && film.x < float(all.x1) && film.y >= float(all.y0) && film.y < float(all.y1))) return;
  Xyz color;
  BadKind kind = BadKind::not_a_number;
  if (to_color(value, wavelengths, color, kind)) [[likely]] {
    splats_.push_back({film, color, length});
    if (buffer_->largest_wanted_ > 0) [[unlikely]]
      note_large(
          {color.y * (double(buffer_->width) * double(buffer_->height) / double(pixels(all))), px, py, sample, film, true});
  } else {
    note(px, py, sample, kind);
  }
}

void ImageTile::features(int px, int py, const Features& f) {
  if (features_.empty() || !area_.contains(px, py)) return;
  double* sum =
      &features_[ImageBuffer::feature_values * (size_t(py - area_.y0) * size_t(area_.width()) + size_t(px - area_.x0))];
  if (!is_finite(f.albedo) || !is_finite(f.normal) || !std::isfinite(f.depth)) return;
  for (int i = 0; i < 3; ++i) {
    sum[i] += double(f.albedo[i]);
    sum[3 + i] += double(f.normal[i]);
  }
  if (f.depth > 0) {
    sum[6] += double(f.depth);
    sum[7] += 1;
  }
  if (sum[9] == 0) sum[8] = f.object;
  sum[9] += 1;
}

}  // namespace etendue
