#include "algorithm_trial.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "etendue/render/guided_process.h"
#include "etendue/render/renderer.h"
#include "etendue/transport/bidirectional_subpaths.h"
#include "film/pixel_area.h"

namespace etendue {
namespace {

/// How many times as much a ray costs, over those of a path tracer: where a guide helps to choose its direction and learns from
/// it, and where vertices are stored and weighted against each other. Measured on ten scenes (docs/decisions/052-automatic.md).
constexpr double cost_of_guiding = 1.4, cost_of_two_ends = 1.1;

/// Numbers of a source, whose pairs are counted: those of the path's own walk, and those of its other walks.
class CountedNumbers final : public NumberSource {
 public:
  explicit CountedNumbers(const NumberSource& of) : of_(of) {}

  void begin(SampleKey key) {
    walk_ = key.walk;
    own_ = others_ = 0;
  }
  /// The cost of the path since `begin`. Paths with walks of other names start at both ends: their numbers are those of the
  /// luminaire's point and direction (2 pairs), of the vertices from there, of a luminaire for each camera vertex, and of the
  /// lens for each vertex from the luminaire.
  double cost() const {
    if (others_ == 0) return own_;
    const double joined = std::max((others_ - 2 - own_) / 2, 0.0);
    return cost_of_two_ends * (own_ + others_ + own_ * joined);
  }

  float number(SampleKey key, std::uint32_t dimension) const override { return of_.number(key, dimension); }
  Point2 pair(SampleKey key, std::uint32_t dimension) const override {
    count(key, 1);
    return of_.pair(key, dimension);
  }
  Pairs two_pairs(SampleKey key, std::uint32_t first, std::uint32_t second) const override {
    count(key, 2);
    return of_.two_pairs(key, first, second);
  }

 private:
  void count(SampleKey key, double pairs) const { (key.walk == walk_ ? own_ : others_) += pairs; }

  const NumberSource& of_;
  std::uint64_t walk_ = 0;
  mutable double own_ = 0, others_ = 0;  // one object belongs to one item of work
};

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
}

}  // namespace

/// The result of one item.
struct AlgorithmTrial::Part {
  std::vector<double> tiles;   // the sum of light in each tile, as part of its mean
  std::vector<double> excess;  // the sum of PathTracingExcess in each tile, as part of its mean
  double cost = 0;             // of all paths
  std::vector<GuideSample> lessons;

  void pack(std::vector<std::byte>& to) const {
    Packing::pack(to, tiles);
    Packing::pack(to, excess);
    Packing::pack(to, cost);
    Packing::pack(to, lessons);
  }
  static Part unpack(std::span<const std::byte>& from) {
    Part part;
    Packing::unpack(from, part.tiles);
    Packing::unpack(from, part.excess);
    Packing::unpack(from, part.cost);
    Packing::unpack(from, part.lessons);
    return part;
  }
};

AlgorithmTrial::AlgorithmTrial(const RenderContext& context, std::uint64_t seed, double paths)
    : context_(context), seed_(seed), area_(context.image.sampled_area()) {
  constexpr double fewest = 4, most_tiles = 1024;
  const double pixels = double(area_.width()) * double(area_.height()), of_batch = std::max(paths / batches, 1.0);
  const double tiles = std::clamp(of_batch / fewest, 1.0, most_tiles);
  side_ = std::max(int(std::ceil(std::sqrt(pixels / tiles))), 2);
  columns_ = (area_.width() + side_ - 1) / side_;
  rows_ = (area_.height() + side_ - 1) / side_;
  paths_ = std::clamp(int(std::lround(of_batch / (double(columns_) * rows_))), 1, side_ * side_);
}

PixelArea AlgorithmTrial::tile_area(int tile) const {
  const int x = area_.x0 + tile % columns_ * side_, y = area_.y0 + tile / columns_ * side_;
  return intersection({x, y, x + side_, y + side_}, area_);
}

/// The tile that a film point lies in; -1: none.
int AlgorithmTrial::tile_of(const Point2& film) const {
  const int x = int(std::floor(film.x)), y = int(std::floor(film.y));
  return area_.contains(x, y) ? (y - area_.y0) / side_ * columns_ + (x - area_.x0) / side_ : -1;
}

void AlgorithmTrial::trace(const RenderProcess& process, std::uint64_t seed, int tile, bool records,
                           const std::atomic<bool>* abort, Part& part, Arena& arena) const {
  const PixelArea area = tile_area(tile);
  const auto pixels = std::uint64_t(area.width()) * std::uint64_t(area.height());
  CountedNumbers numbers(*process.renderer.sampler);
  std::vector<Splat> splats;
  std::vector<PathTracingExcess> excess;
  const PathSink sink{.splats = &splats, .records = records ? RecordList(part.lessons) : RecordList(excess), .abort = abort};
  const auto light = [](const Spectrum& value, const Wavelengths& w) {
    const double y = to_xyz(value, w).y;
    return std::isfinite(y) ? std::max(y, 0.0) : 0.0;
  };
  // The chosen pixels do not depend on the algorithm or the batch: the fractions of a Weyl sequence from a random start.
  const std::uint64_t start = mix_bits(seed_ + std::uint64_t(tile));
  // What is splatted counts as part of the mean of the tile it falls on, as the share of all paths that its area is of the
  // film.
  const auto splat_share = [&](int to) {
    const PixelArea other = tile_area(to);
    return double(context_.image.width) * context_.image.height /
           (double(other.width()) * other.height() * columns_ * rows_ * paths_);
  };
  for (int i = 0; i < paths_; ++i) {
    const std::uint64_t fraction = start + std::uint64_t(i) * 0x9e3779b97f4a7c15ull;  // of 2^64: the golden ratio
    const auto pixel = int((fraction >> 32) * pixels >> 32);
    const int x = area.x0 + pixel % area.width(), y = area.y0 + pixel / area.width();
    const SampleKey key(seed, x, y, std::uint32_t(i));
    splats.clear();
    excess.clear();
    numbers.begin(key);
    const CameraSample s = process.path({x, y, x + 1, y + 1}, numbers, key, arena, sink);
    part.cost += numbers.cost();
    part.tiles[size_t(tile)] += light(s.value, s.wavelengths) / paths_;
    for (const Splat& splat : splats)
      if (const int to = tile_of(splat.film); to >= 0)
        part.tiles[size_t(to)] += light(splat.value, splat.wavelengths) * splat_share(to);
    if (!excess.empty()) part.excess.resize(part.tiles.size());
    for (const PathTracingExcess& each : excess)
      if (const int to = each.film ? tile_of(*each.film) : tile; to >= 0 && std::isfinite(each.value))
        part.excess[size_t(to)] += each.value * (each.film ? splat_share(to) : 1.0 / paths_);
  }
}

AlgorithmTrial::Measured AlgorithmTrial::measure(Schedule& schedule, RenderProcess& process, std::uint32_t number,
                                                 std::uint32_t& lessons) const {
  const int tiles = columns_ * rows_;
  auto* const pupil = dynamic_cast<LearnsFromPaths*>(&process);
  const bool learns = pupil && pupil->learns();
  Measured measured;
  measured.tiles.resize(size_t(tiles));
  measured.from_camera = !process.renderer.splats();
  measured.guided = learns;
  // Items of rows of tiles: few enough that their results, a number for each tile, stay small.
  constexpr int most_items = 64;
  const int each = (tiles + most_items - 1) / most_items, items = (tiles + each - 1) / each;
  for (std::uint32_t batch = 0; batch < batches; ++batch) {
    const std::uint64_t seed = mix_bits(seed_ + 1 + batch + std::uint64_t(number) * batches);
    if (learns) pupil->begin_learning(lessons++, tiles * paths_);
    const std::vector<Part> parts =
        schedule.collect<Part>(std::uint64_t(items), [&](std::uint64_t item, std::vector<Part>& out, Arena& arena) {
          Part part;
          part.tiles.resize(size_t(tiles));
          const int first = int(item) * each;
          for (int tile = first; tile < std::min(first + each, tiles) && !schedule.aborted(); ++tile)
            trace(process, seed, tile, learns, schedule.abort, part, arena);
          out.push_back(std::move(part));
        });
    if (schedule.aborted()) return measured;
    std::vector<GuideSample> taught;
    for (const Part& part : parts) {
      for (size_t t = 0; t < part.tiles.size(); ++t) measured.tiles[t][batch] += part.tiles[t];
      if (!part.excess.empty()) measured.excess.resize(size_t(tiles));
      for (size_t t = 0; t < part.excess.size(); ++t) measured.excess[t] += part.excess[t] / batches;
      measured.cost += part.cost / (double(tiles) * paths_ * batches);
      taught.insert(taught.end(), part.lessons.begin(), part.lessons.end());
    }
    if (learns) pupil->learn(schedule, taught);
  }
  if (learns) measured.cost *= cost_of_guiding;
  return measured;
}

/// r of each tile: the mean light of an algorithm in the tiles around it, of that algorithm for which it is the median.
std::vector<double> AlgorithmTrial::seen(const std::vector<Measured>& all) const {
  constexpr int reach = 2;
  std::vector<double> seen(all.front().tiles.size());
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column) {
      std::vector<double> means;
      for (const Measured& one : all) {
        double sum = 0, count = 0;
        for (int y = std::max(row - reach, 0); y <= std::min(row + reach, rows_ - 1); ++y)
          for (int x = std::max(column - reach, 0); x <= std::min(column + reach, columns_ - 1); ++x)
            for (const double b : one.tiles[size_t(y) * size_t(columns_) + size_t(x)]) sum += b, count += 1;
        means.push_back(sum / count);
      }
      seen[size_t(row) * size_t(columns_) + size_t(column)] = median(means);
    }
  return seen;
}

/// Sums over eight groups of the tiles, and the power mean of the groups' means.
struct AlgorithmTrial::Groups {
  static constexpr size_t count = 8;
  std::array<double, count> sum{}, tiles{};

  void add(size_t tile, double value) {
    const size_t group = mix_bits(tile) % count;
    sum[group] += value;
    tiles[group] += 1;
  }
  double mean() const {
    const double all = std::accumulate(tiles.begin(), tiles.end(), 0.0);
    return all > 0 ? std::accumulate(sum.begin(), sum.end(), 0.0) / all : 0;
  }
  double power_mean() const {
    double root = 0, groups = 0;
    for (size_t g = 0; g < count; ++g)
      if (tiles[g] > 0) root += std::sqrt(std::max(sum[g] / tiles[g], 0.0)), groups += 1;
    return groups > 0 ? (root / groups) * (root / groups) : 0;
  }
};

std::vector<double> AlgorithmTrial::errors(const std::vector<Measured>& all) const {
  const std::vector<double> r = seen(all);
  const double mean = std::accumulate(r.begin(), r.end(), 0.0) / double(r.size());
  std::vector<double> errors, means;
  double of_path_tracing = 0;  // V'
  for (const Measured& one : all) {
    Groups own, path_tracing;
    double light = 0;
    for (size_t t = 0; t < r.size(); ++t) {
      double b = 0, v = 0;
      for (const double k : one.tiles[t]) b += k / batches;
      for (const double k : one.tiles[t]) v += (k - b) * (k - b) * paths_ / (batches - 1);
      const double scale = r[t] * r[t] + 0.01 * mean * mean;
      light += scale > 0 ? b / std::sqrt(scale) / double(r.size()) : 0;
      own.add(t, scale > 0 ? v / scale : 0);
      if (!one.excess.empty()) path_tracing.add(t, scale > 0 ? (v + one.excess[t]) / scale : 0);
    }
    errors.push_back(own.power_mean());
    means.push_back(light);
    of_path_tracing = std::max(of_path_tracing, path_tracing.mean());
  }
  double times = 1;  // how much larger the error of path tracing is than what its own trial says
  for (size_t i = 0; i < all.size(); ++i)
    if (all[i].from_camera && !all[i].guided && errors[i] > 0) {
      times = std::max(times, of_path_tracing / errors[i]);
      errors[i] = std::max(errors[i], of_path_tracing);
    }
  for (size_t i = 0; i < all.size(); ++i)
    if (all[i].from_camera && all[i].guided) errors[i] *= times;
  return with_missed_light(errors, means);
}

/// The errors, where those of algorithms that have found significantly less light than another are at least what they must be
/// for that.
std::vector<double> AlgorithmTrial::with_missed_light(const std::vector<double>& errors,
                                                      const std::vector<double>& means) const {
  constexpr double significant = 3;  // standard errors
  const double n = double(columns_) * rows_ * paths_ * batches;
  std::vector<double> whole = errors;
  for (size_t i = 0; i < errors.size(); ++i)
    for (size_t o = 0; o < errors.size(); ++o) {
      const double missed = means[o] - means[i];
      if (missed > significant * std::sqrt((errors[i] + errors[o]) / n)) whole[i] = std::max(whole[i], n * missed * missed);
    }
  return whole;
}

}  // namespace etendue
