#include "etendue/film/image_buffer.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <tuple>

#include "filter_window.h"
#include "pixel_area.h"

namespace etendue {
namespace {

const std::vector<std::string>& known_layers() {
  static const std::vector<std::string> names = {"albedo", "normal", "depth", "object", "variance", "samples"};
  return names;
}

}  // namespace

void ImageBuffer::describe(Description<ImageBuffer>& d) {
  d.summary("The film: collects samples as CIE XYZ in double precision.")
      .member<&ImageBuffer::width>("width", "1", "pixels in a row", range(1, 65536))
      .member<&ImageBuffer::height>("height", "1", "rows of pixels", range(1, 65536))
      .member<&ImageBuffer::filter>("filter", "", "reconstruction: how much a sample counts for the pixels around it")
      .member<&ImageBuffer::crop>("crop", "1",
                                  "rectangle to render and write, x0, y0, x1, y1 [pixels from the upper left, x1 and y1 "
                                  "excluded]; empty: the whole picture")
      .member<&ImageBuffer::layers>("layers", "",
                                    "further channels: of albedo, normal, depth, object (what camera paths meet first), "
                                    "variance (of the mean of Y), samples (per pixel)",
                                    known_layers())
      .member<&ImageBuffer::path_lengths>("path_lengths", "1",
                                          "further channels length_1.X, … by the number of segments of the paths that "
                                          "brought the light; the last holds all longer ones too",
                                          range(0, 64));
}

static const Register<ImageBuffer> registered;

ImageBuffer::ImageBuffer() : filter(ref_cast<Filter>(Registry::instance().create("GaussianFilter"))) {}
ImageBuffer::~ImageBuffer() = default;

bool ImageBuffer::wants(const std::string& layer) const {
  return std::find(layers.begin(), layers.end(), layer) != layers.end();
}

void ImageBuffer::prepare() {
  if (width < 1) fail("width", "must be at least 1");
  if (height < 1) fail("height", "must be at least 1");
  PixelArea area{0, 0, width, height};
  if (!crop.empty()) {
    if (crop.size() != 4) fail("crop", fmt::format("needs four numbers x0, y0, x1, y1, not {}", crop.size()));
    area = {crop[0], crop[1], crop[2], crop[3]};
    if (area.x0 < 0 || area.y0 < 0 || area.x1 > width || area.y1 > height || area.x0 >= area.x1 || area.y0 >= area.y1)
      fail("crop", fmt::format("[{}, {}, {}, {}] is not a rectangle within the picture of {} x {} pixels", crop[0], crop[1],
                               crop[2], crop[3], width, height));
  }
  for (size_t i = 0; i < layers.size(); ++i) {
    if (std::find(known_layers().begin(), known_layers().end(), layers[i]) == known_layers().end())
      fail("layers", fmt::format("no layer is called '{}'{}", layers[i], suggestion(layers[i], known_layers())));
    if (std::find(layers.begin(), layers.begin() + std::ptrdiff_t(i), layers[i]) != layers.begin() + std::ptrdiff_t(i))
      fail("layers", fmt::format("'{}' is named twice", layers[i]));
  }

  if (!filter) fail("filter", "is missing");
  const float radius = filter->radius();
  if (!(radius >= 0.5f && radius <= maximum_filter_radius))
    fail("filter", fmt::format("its radius is {} pixels; it must be from 0.5 to {}", radius, maximum_filter_radius));
  std::vector<float> table;
  table.reserve(table_size * table_size);
  double sum = 0;
  const float cell = radius / table_size;
  for (int y = 0; y < table_size; ++y)
    for (int x = 0; x < table_size; ++x) {
      table.push_back(filter->weight((float(x) + 0.5f) * cell, (float(y) + 0.5f) * cell));
      sum += double(table.back());
    }
  if (!(sum > 0 && sum < double(std::numeric_limits<float>::max())))
    fail("filter", "its weights do not add up to a positive number");

  const bool features = wants("albedo") || wants("normal") || wants("depth") || wants("object");
  // What was collected stays valid when the picture is prepared again after an edit of something else.
  const bool same = path_lengths == kept_lengths_ && area == area_ && table == filter_table_ && radius == filter_radius_ &&
                    features == wants_features_;
  area_ = area;
  wants_features_ = features;
  kept_lengths_ = path_lengths;
  filter_table_ = std::move(table);
  filter_radius_ = radius;
  find_filter_shares();
  box_ =
      radius == 0.5f && std::all_of(filter_table_.begin(), filter_table_.end(), [&](float w) { return w == filter_table_[0]; });
  sampled_area_ = intersection(widened(area_, reach()), {0, 0, width, height});
  if (!same) clear();
}

/// A sample at the edge of its pixel lies half a pixel from the centre, and counts for what is closer than the radius.
int ImageBuffer::reach() const { return box_ ? 0 : filter_reach_; }

void ImageBuffer::clear() {
  // Memory is taken when the first tile comes in: a picture that is only described costs nothing.
  sums_.clear();
  moments_.clear();
  features_.clear();
  splats_.clear();
  lengths_.clear();
  length_splats_.clear();
  largest_.clear();
  samples_ = bad_count_ = 0;
  bad_.clear();
}

void ImageBuffer::allocate() {
  const size_t pixels = size_t(area_.width()) * size_t(area_.height());
  try {
    sums_.resize(4 * pixels);
    moments_.resize(3 * pixels);
    if (wants_features_) features_.resize(feature_values * pixels);
    lengths_.resize(3 * size_t(path_lengths) * pixels);
  } catch (const std::bad_alloc&) {
    fail("width", fmt::format("there is not enough memory for {} x {} pixels", area_.width(), area_.height()));
  }
}

void ImageBuffer::merge(const ImageTile& tile) {
  if (sums_.empty()) allocate();
  const auto add = [&](const PixelArea& part, size_t values, const std::vector<double>& from, std::vector<double>& to) {
    const size_t row = values * size_t(part.width());
    for (int y = part.y0; y < part.y1; ++y) {
      const double* source = &from[size_t(y - part.y0) * row];
      double* target = &to[values * index(part.x0, y)];
      for (size_t i = 0; i < row; ++i) target[i] += source[i];
    }
  };
  if (!tile.sums_.empty()) add(tile.extent_, 4, tile.sums_, sums_);
  if (!tile.lengths_.empty()) add(tile.extent_, 3 * size_t(path_lengths), tile.lengths_, lengths_);
  if (!tile.moments_.empty()) add(tile.area_, 3, tile.moments_, moments_);
  if (!tile.features_.empty() && !features_.empty()) {
    const double* source = tile.features_.data();
    for (int y = tile.area_.y0; y < tile.area_.y1; ++y)
      for (int x = tile.area_.x0; x < tile.area_.x1; ++x, source += feature_values) {
        double* target = &features_[feature_values * index(x, y)];
        if (target[9] == 0) target[8] = source[8];  // of the first sample
        for (size_t i = 0; i < feature_values; ++i)
          if (i != 8) target[i] += source[i];
      }
  }
  for (const ImageTile::Splat& s : tile.splats_) add_splat(s);
  for (const LargeSample& s : tile.largest_) ImageTile::keep_larger(largest_, s, largest_wanted_);
  for (const BadSample& b : tile.bad_)
    if (bad_.size() < bad_samples_kept) bad_.push_back(b);
  samples_ += tile.paths_;
  bad_count_ += tile.bad_count_;
}

void ImageTile::keep_larger(std::vector<LargeSample>& kept, const LargeSample& s, size_t most) {
  // A heap with the least of them in front; ties are broken by place, so that the order of merging does not matter.
  const auto larger = [](const LargeSample& a, const LargeSample& b) {
    return std::tuple(-a.luminance, a.y, a.x, a.sample, a.film.y, a.film.x) <
           std::tuple(-b.luminance, b.y, b.x, b.sample, b.film.y, b.film.x);
  };
  if (kept.size() == most) {
    if (!larger(s, kept.front())) return;
    std::pop_heap(kept.begin(), kept.end(), larger);
    kept.pop_back();
  }
  kept.push_back(s);
  std::push_heap(kept.begin(), kept.end(), larger);
}

std::vector<LargeSample> ImageBuffer::largest_samples() const {
  std::vector<LargeSample> sorted = largest_;
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.luminance > b.luminance; });
  return sorted;
}

void ImageBuffer::add_splat(const ImageTile::Splat& splat) {
  const size_t pixels = size_t(area_.width()) * size_t(area_.height());
  if (splats_.empty()) {
    splats_.resize(4 * pixels);
    length_splats_.resize(3 * size_t(path_lengths) * pixels);
  }
  const Point2 film = splat.film;
  const Xyz& value = splat.value;
  const auto add = [&](int x, int y, double weight) {
    double* sum = &splats_[4 * index(x, y)];
    sum[0] += weight * value.x;
    sum[1] += weight * value.y;
    sum[2] += weight * value.z;
    sum[3] += weight * value.y * weight * value.y;
    if (path_lengths == 0 || splat.length < 1) return;
    double* part = &length_splats_[3 * (size_t(path_lengths) * index(x, y) + size_t(std::min(splat.length, path_lengths)) - 1)];
    part[0] += weight * value.x;
    part[1] += weight * value.y;
    part[2] += weight * value.z;
  };
  if (box_) {
    add(std::min(int(film.x), area_.x1 - 1), std::min(int(film.y), area_.y1 - 1), double(filter_table_[0]));
    return;
  }
  const FilterWindow across(film.x, filter_radius_, table_size, area_.x0, area_.x1);
  const FilterWindow down(film.y, filter_radius_, table_size, area_.y0, area_.y1);
  for (int j = 0; j < down.count; ++j) {
    const float* row = &filter_table_[size_t(down.cells[size_t(j)]) * table_size];
    for (int i = 0; i < across.count; ++i) add(across.first + i, down.first + j, double(row[across.cells[size_t(i)]]));
  }
}

}  // namespace etendue
