#include "etendue/render/learned_guide.h"

#include "etendue/core/warp.h"

namespace etendue {
namespace {

// The rest of the memory is for saved states of the guide, and copies of them being made.
GuideSettings within(GuideSettings settings, size_t memory) {
  settings.memory = memory / 8;
  return settings;
}

/// The fraction of a step's paths that are training paths: all in the first steps, later fewer, since training takes time.
double part_of(std::uint32_t step) { return std::max(std::min(8 / double(step + 1), 1.0), 0.125); }

}  // namespace

// Training samples get half of the memory, including temporary copies.
LearnedGuide::LearnedGuide(GuideSettings settings, size_t memory)
    : room_(double(memory) / 2 / (5 * sizeof(GuideSample))), guide_(within(settings, memory)) {}

void LearnedGuide::begin_step(const PixelArea& area, const Step& step, int longest) {
  const double paths = double(area.width()) * double(area.height()) * double(step.samples.end - step.samples.begin);
  taught_ = std::uint64_t(std::min(room_ / longest / std::max(paths, 1.0), part_of(step.number)) * 0x1p32);
}

bool LearnedGuide::teaches(const SampleContext& sample) const {
  const SampleKey key = sample.numbers.key();
  return sample.sink.records && (mix_bits(key.walk + key.sample) >> 32) < taught_;
}

void LearnedGuide::learn(Schedule& schedule, const std::vector<GuideSample>& samples) {
  if (schedule.aborted()) return;
  std::vector<size_t> end(guide_.regions() + 1, 0);
  for (const GuideSample& s : samples) ++end[s.region + 1];
  for (size_t r = 1; r < end.size(); ++r) end[r] += end[r - 1];
  std::vector<const GuideSample*> sorted(samples.size());
  for (const GuideSample& s : samples) sorted[end[s.region]++] = &s;
  // Now end[r] is the index where the samples of region r end and those of region r + 1 begin.
  const std::vector<Guide::Region> fitted =
      schedule.collect<Guide::Region>(guide_.regions(), [&](std::uint64_t item, std::vector<Guide::Region>& regions, Arena&) {
        const auto r = std::uint32_t(item);
        const size_t begin = r > 0 ? end[r - 1] : 0;
        regions.push_back(guide_.fitted(r, std::span(sorted).subspan(begin, end[r] - begin)));
      });
  if (schedule.aborted()) return;
  for (size_t r = 0; r < fitted.size(); ++r) guide_.replace(std::uint32_t(r), fitted[r]);
  guide_.divide();
}

ShownLobes LearnedGuide::lobes(const Point3& position, const Normal3& normal) const {
  const Guide::Region& region = guide_.at(position, normal);
  const SeenLobes seen(region.lobes(), position);
  ShownLobes shown{{}, region.share()};
  constexpr int parts = 4;  // subdivisions of a cell along each axis: lobes may be narrower than a cell
  for (int row = 0; row < ShownLobes::rows; ++row)
    for (int column = 0; column < ShownLobes::columns; ++column) {
      float sum = 0;
      for (int i = 0; i < parts * parts; ++i)
        sum +=
            seen.pdf(ShownLobes::direction(row, column, (float(i / parts) + 0.5f) / parts, (float(i % parts) + 0.5f) / parts));
      shown.pdf.push_back(shown.share > 0 ? sum / (parts * parts) : warp::sphere_pdf);
    }
  return shown;
}

}  // namespace etendue
