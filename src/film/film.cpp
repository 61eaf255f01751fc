// Film: collects the samples of each step.

#include "etendue/film/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <mutex>

#include "etendue/film/splat_label.h"
#include "files/regular_file.h"
#include "film_members.h"
#include "film_values.h"
#include "filter_window.h"
#include "tile_values.h"

namespace etendue {

namespace {

/// The least memory that a render of a picture needs [bytes]: the light of the current step, with bands, and its exact sums.
double least_memory(const PictureFormat& format) {
  const auto pixels = double(format.area.width()) * double(format.area.height());
  return pixels * double(2 * (list_stride(light_list, format) + list_stride(part_list, format)) * sizeof(double));
}

}  // namespace

Film::Film(const ImageBuffer& image, Estimator estimator) : members_(std::make_unique<Members>()) {
  members_->format = image.format();
  members_->estimator = estimator;
  const PictureFormat& format = *members_->format;
  require_memory(least_memory(format), fmt::format("a picture of {} x {} pixels", format.area.width(), format.area.height()));
}
Film::~Film() = default;

Estimator Film::estimator() const { return members_->estimator; }

bool Film::follow(const ImageBuffer& image, Estimator estimator) {
  const std::lock_guard lock(members_->mutex);
  const bool same = members_->format->collects_as(*image.format()) && members_->estimator == estimator;
  members_->format = image.format();
  members_->estimator = estimator;
  if (!same) members_->empty();
  return same;
}

void Film::clear() {
  const std::lock_guard lock(members_->mutex);
  members_->empty();
}

// Memory is allocated when it is first needed: a picture that is only described costs nothing.
void Film::Members::empty() {
  totals = {};
  before_step.reset();
  step = {};
  splatted.clear();
  largest.clear();
}

// ---- a step -------------------------------------------------------------------------------------------------------------

namespace {

[[noreturn]] void out_of_memory(const PictureFormat& format) {
  throw Error(
      fmt::format("there is not enough memory for a picture of {} x {} pixels", format.area.width(), format.area.height()));
}

}  // namespace

/// A list of the current step, allocated for all pixels.
std::vector<double>& Film::Members::list(List which) {
  std::vector<double>& list = step.lists[which];
  if (list.empty()) list.resize(format->pixels() * list_stride(which, *format));
  return list;
}

void Film::merge(const ImageTile& tile) {
  Members& m = *members_;
  const std::lock_guard lock(m.mutex);
  if (!tile.format_) return;  // begin was never called
  if (tile.format_ != m.format && !tile.format_->collects_as(*m.format)) throw Error("the tile is of another picture");
  try {
    if (m.step.begun && tile.block_ != m.step.block) {
      if (!m.before_step) m.before_step = std::make_unique<Totals>(m.totals);
      m.add_step();
    }
    m.step.begun = true;
    m.step.block = tile.block_;
    add_tile(tile);
  } catch (const std::bad_alloc&) {
    out_of_memory(*m.format);
  }
}

void Film::add_tile(const ImageTile& tile) {
  Members& m = *members_;
  const PictureFormat& format = *m.format;
  const auto add = [&](const PixelArea& part, List which, const std::vector<double>& from) {
    std::vector<double>& to = m.list(which);
    const size_t stride = list_stride(which, format), row = stride * size_t(part.width());
    for (int y = part.y0; y < part.y1; ++y) {
      const double* source = &from[size_t(y - part.y0) * row];
      double* target = &to[stride * format.index(part.x0, y)];
      bool good = true;
      for (size_t i = 0; i < row; ++i) {
        target[i] += source[i];
        good &= std::abs(target[i]) <= ExactSums::largest_addend;
      }
      if (!good) [[unlikely]]
        m.complain({target, row}, stride, part.x0, y);
    }
  };
  FilmCounts& counts = m.step.counts;
  if (counts.samples.empty()) counts.samples.resize(format.pixels());
  if (tile.lit_ && !tile.light_.empty()) add(tile.extent_, light_list, tile.light_);
  if (tile.lit_ && !tile.parts_.empty()) add(tile.extent_, part_list, tile.parts_);
  if (!tile.weights_.empty()) add(tile.area_, weight_list, tile.weights_);
  for (int y = tile.area_.y0; y < tile.area_.y1; ++y)
    for (int x = tile.area_.x0; x < tile.area_.x1; ++x)
      counts.samples[format.index(x, y)] += tile.samples_[tile.own_pixel(x, y)];
  if (!tile.splats_.empty()) add_splats(tile);
  for (const LargeSample& s : tile.largest_) ImageTile::keep_larger(m.step.largest, s, m.largest_wanted);
  counts.add_bad(tile.bad_);
  counts.paths += tile.paths_;
  counts.bad_count += tile.bad_count_;
}

namespace {

bool summable(double value) { return std::abs(value) <= ExactSums::largest_addend; }  // false for NaN

}  // namespace

void Film::Members::complain(std::span<const double> values, size_t stride, int x0, int y) const {
  const auto i = size_t(std::ranges::find_if_not(values, summable) - values.begin());
  throw Error(fmt::format("the light of pixel {},{} adds up to {}, which is too large to be summed", x0 + int(i / stride), y,
                          values[std::min(i, values.size() - 1)]));
}

// All splats of one sample are one random outcome: their sum in a pixel is squared, not each of them. Adding b to a sum a adds
// b (b + 2 a) to the square, as (a + b)^2 = a^2 + b (b + 2 a).
void Film::add_splats(const ImageTile& tile) {
  Members& m = *members_;
  const PictureFormat& format = *m.format;
  std::vector<double>& sums = m.list(splat_list);
  double* parts = format.triples() > 0 ? m.list(part_splat_list).data() : nullptr;
  std::vector<double>& of_path = m.splatted;  // sum of the current path so far; zero except in pixels it has reached
  if (of_path.empty()) of_path.resize(format.pixels());
  std::vector<size_t> reached;
  std::vector<SpectralBands::Value> measured;  // of the current splat, in the bands
  const auto end_path = [&] {
    for (const size_t pixel : reached) of_path[pixel] = 0;
    reached.clear();
  };
  const auto add = [&](const ImageTile::Splat& splat, int x, int y, double weight) {
    const size_t pixel = format.index(x, y);
    const Xyz value{weight * splat.value.x, weight * splat.value.y, weight * splat.value.z};
    double* sum = &sums[4 * pixel];
    sum[0] += value.x;
    sum[1] += value.y;
    sum[2] += value.z;
    sum[3] += value.y * (value.y + 2 * of_path[pixel]);
    if (!std::all_of(sum, sum + 4, summable)) [[unlikely]] {
      end_path();
      m.complain({sum, 4}, 4, x, y);
    }
    of_path[pixel] += value.y;
    reached.push_back(pixel);
    if (!parts) return;
    if (double* bands = &parts[3 * (format.triples() * pixel + format.parts())]; !measured.empty())
      for (const auto& [band, light] : measured) {
        bands[band] += weight * light;
        if (!summable(bands[band])) [[unlikely]] {
          end_path();
          m.complain({&bands[band], 1}, 1, x, y);
        }
      }
    const auto add_part = [&](size_t part) {
      double* at = &parts[3 * (format.triples() * pixel + part)];
      at[0] += value.x;
      at[1] += value.y;
      at[2] += value.z;
    };
    const SplatLabel label = SplatLabel::unpacked(splat.length, format.light_groups.size());
    if (label.length >= 1 && format.path_lengths > 0) add_part(size_t(std::min(label.length, format.path_lengths)) - 1);
    if (label.group >= 0) add_part(size_t(format.path_lengths) + size_t(label.group));
    if (label.matches != SplatLabel::unknown)
      for (size_t i = 0; i < format.path_layers.size(); ++i)
        if (label.matches & (1u << i)) add_part(size_t(format.path_lengths) + format.light_groups.size() + i);
  };
  constexpr int size = PictureFormat::table_size;
  const double* lights = tile.parts_.data() + pixel_values(format, tile.extent_);
  for (const ImageTile::Splat& splat : tile.splats_) {
    if (!splat.same_path) end_path();
    if (format.bands) {
      SpectralBands::Light light;
      std::memcpy(&light, lights, sizeof light);
      lights += splat_values(format);
      format.bands->measure(light, measured);
    }
    if (format.box) {
      add(splat, std::min(int(splat.film.x), format.area.x1 - 1), std::min(int(splat.film.y), format.area.y1 - 1),
          double(format.table[0]));
      continue;
    }
    const FilterWindow across(splat.film.x, format.radius, size, format.area.x0, format.area.x1);
    const FilterWindow down(splat.film.y, format.radius, size, format.area.y0, format.area.y1);
    for (int j = 0; j < down.count; ++j) {
      const float* row = &format.table[size_t(down.cells[size_t(j)]) * size];
      for (int i = 0; i < across.count; ++i) add(splat, across.first + i, down.first + j, double(row[across.cells[size_t(i)]]));
    }
  }
  end_path();
}

// ---- whole steps ----------------------------------------------------------------------------------------------------------

void Film::end_step() {
  Members& m = *members_;
  const std::lock_guard lock(m.mutex);
  try {
    if (m.step.begun) m.add_step();
  } catch (const std::bad_alloc&) {
    out_of_memory(*m.format);
  }
  m.before_step.reset();
  for (const LargeSample& s : m.step.largest) ImageTile::keep_larger(m.largest, s, m.largest_wanted);
  m.step.largest.clear();
}

void Film::drop_step() {
  Members& m = *members_;
  const std::lock_guard lock(m.mutex);
  if (!m.step.begun && !m.before_step) return;  // the lists keep their memory for the next step
  if (m.before_step) m.totals = std::move(*m.before_step);
  m.before_step.reset();
  m.step = {};
}

/// Computes the batch squares for the variance of correlated samples: for each pixel the square of the step's mean, times the
/// step's samples.
void Film::Members::note_batch(FilmSnapshot::Values& values) const {
  std::vector<double>& batches = values.lists[batch_list];
  batches.assign(format->pixels(), 0);
  const bool even = values.even();
  for (int y = format->area.y0; y < format->area.y1; ++y)
    for (int x = format->area.x0; x < format->area.x1; ++x) {
      const size_t pixel = format->index(x, y);
      const double mean = values.luminance(pixel, values.scales(x, y, even));
      batches[pixel] = double(values.counts.paths) * mean * mean;
    }
}

/// Adds the current step, or its current block, to the sums. Throws before anything changes.
void Film::Members::add_step() {
  if (totals.steps >= ExactSums::most_addends)
    throw Error(fmt::format("a film cannot take more than {} steps", ExactSums::most_addends));
  totals.counts.require_room_for(step.counts);
  if (estimator == Estimator::correlated) {
    FilmSnapshot::Values values{format, estimator, std::move(step.lists), std::move(step.counts), 1};
    note_batch(values);
    step.lists = std::move(values.lists);
    step.counts = std::move(values.counts);
  }
  for (size_t p = 0; p < planes.size(); ++p)
    if (!step.lists[planes[p].list].empty() && totals.sums[p].empty() && kept(planes[p], estimator))
      totals.sums[p] = ExactSums(format->pixels() * groups_per_pixel(planes[p], *format), planes[p].group);
  over_range(format->pixels(), [&](size_t begin, size_t end) {
    for (size_t p = 0; p < planes.size(); ++p) {
      const auto& [list, offset, group] = planes[p];
      if (step.lists[list].empty() || !kept(planes[p], estimator)) continue;
      const size_t stride = list_stride(list, *format), groups = groups_per_pixel(planes[p], *format);
      totals.sums[p].add(begin * groups, end * groups, step.lists[list].data() + begin * stride + offset, stride / groups);
    }
    for (size_t l = 0; l < list_count; ++l)
      if (const size_t stride = list_stride(List(l), *format); !step.lists[l].empty())
        std::fill(step.lists[l].begin() + std::ptrdiff_t(begin * stride), step.lists[l].begin() + std::ptrdiff_t(end * stride),
                  0.0);
  });
  totals.counts.add(step.counts);
  std::ranges::fill(step.counts.samples, 0);
  step.counts.paths = step.counts.bad_count = 0;
  step.counts.bad.clear();
  step.begun = false;
  ++totals.steps;
}

}  // namespace etendue
