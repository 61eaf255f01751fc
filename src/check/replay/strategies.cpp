// Computes the images of single strategies from the records of all samples. It runs in one thread, so that sums are
// reproducible.

#include "strategies.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "replay.h"

namespace etendue {

namespace {

using Key = std::pair<int, std::string>;  // length, strategy

/// Accumulates contributions by strategy and path length.
class Shares {
 public:
  explicit Shares(const ImageBuffer& image) : image_(image), area_(image.area()) {
    constexpr size_t memory = size_t(256) << 20;  // for all images [bytes]
    const size_t one = size_t(area_.width()) * size_t(area_.height()) * 6 * sizeof(double);
    most_ = std::max<size_t>(8, memory / one);
  }

  void add(const PathRecord::Contribution& c, const Wavelengths& wavelengths, int x, int y) {
    if (c.splat) {
      if (!(c.film.x >= float(area_.x0) && c.film.y >= float(area_.y0))) return;
      x = int(std::floor(c.film.x));
      y = int(std::floor(c.film.y));
    }
    if (!area_.contains(x, y)) return;
    const double factor = c.splat ? splat_weight(image_) : 1;
    const Xyz light = to_xyz(max(c.value, 0), wavelengths);
    if (!std::isfinite(light.x + light.y + light.z)) return;
    // The record's last entry may stand for several omitted ones: "…, others before it left out".
    Key key(c.length, c.strategy.substr(0, c.strategy.find(", others")));
    if (all_.size() >= most_ && !all_.contains(key)) key = Key(0, "all others");
    const auto [place, is_new] = all_.try_emplace(key);
    if (is_new) {
      place->second = {key.second, key.first, Image(area_.width(), area_.height(), {"X", "Y", "Z"}),
                       Image(area_.width(), area_.height(), {"X", "Y", "Z"})};
    }
    const double v[3] = {light.x, light.y, light.z};
    for (size_t k = 0; k < 3; ++k) {
      place->second.weighted.at(x - area_.x0, y - area_.y0, k) += factor * v[k];
      if (c.weight > 0) place->second.unweighted.at(x - area_.x0, y - area_.y0, k) += factor * v[k] / double(c.weight);
    }
  }

  std::vector<StrategyPicture> divided_by(double samples) {
    std::vector<StrategyPicture> list;
    for (auto& [key, picture] : all_) {
      for (Image* image : {&picture.weighted, &picture.unweighted})
        for (double& v : image->values) v /= samples;
      list.push_back(std::move(picture));
    }
    return list;
  }

 private:
  const ImageBuffer& image_;
  const PixelArea area_;
  size_t most_ = 0;
  std::map<Key, StrategyPicture> all_;
};

}  // namespace

std::vector<StrategyPicture> strategy_pictures(const Render& render, std::uint32_t samples,
                                               const std::function<bool(double)>& going_on) {
  const Job& job = render.job();
  const PixelArea& area = job.image->sampled_area();
  Shares shares(*job.image);
  Arena arena;
  std::vector<Splat> splats;
  std::unique_ptr<RenderProcess> process;
  std::uint32_t done = 0;
  bool noted = false, light = false;
  for (bool wanted = true; wanted && done < samples; ++done) {
    if (done % render.samples_per_step() == 0) process = render.start_at(done);
    for (int y = area.y0; y < area.y1 && wanted; ++y) {
      wanted = going_on((done + double(y - area.y0) / area.height()) / samples);
      for (int x = area.x0; x < area.x1; ++x) {
        PathRecord record;
        PathSink sink;
        sink.record = &record;
        splats.clear();
        sink.splats = &splats;
        const CameraSample sample = process->sample(x, y, done, arena, sink);
        light |= !splats.empty();
        for (int i = 0; i < spectrum_size; ++i) light |= sample.value[i] > 0;
        noted |= !record.contributions.empty();
        for (const PathRecord::Contribution& c : record.contributions) shares.add(c, sample.wavelengths, x, y);
      }
    }
    if (!wanted) break;
  }
  if (light && !noted) throw Error(job.renderer->class_info().name + " does not tell its strategies apart");
  return shares.divided_by(std::max(done, 1u));
}

}  // namespace etendue
