// MutatedPaths: Markov chains over the primary samples of another process.

#include <algorithm>
#include <array>

#include "etendue/render/primary_sample_chains.h"

namespace etendue {

MutatedPaths::MutatedPaths(const Renderer& r, const RenderContext& c, const ChainSettings& settings,
                           std::unique_ptr<RenderProcess> paths, std::unique_ptr<RenderProcess> direct, Ref<Renderer> held)
    : RenderProcess(r, c),
      settings_(settings),
      area_(c.image.sampled_area()),
      lengths_(size_t(std::max(c.image.path_lengths, direct_length + 1))),
      groups_(c.scene, c.image),
      held_(std::move(held)),
      paths_(std::move(paths)),
      direct_(std::move(direct)) {
  require_mutable(c.wavelengths, r);
}

void MutatedPaths::prepare_step(Schedule& schedule, const Step& step) {
  paths_->prepare_step(schedule, step);
  if (direct_) direct_->prepare_step(schedule, step);
  // Fails if the samples of the process are not paths, as those of another MutatedPaths.
  try {
    Arena arena;
    paths_->sample(area_.x0, area_.y0, step.samples.begin, arena);
  } catch (const Error& e) {
    renderer.fail({}, std::string("has no paths that could be mutated: ") + e.what());
  }
}

void MutatedPaths::step(Schedule& schedule, const Step& step) {
  if (direct_) RenderProcess::step(schedule, step);  // calls `radiance`
  const auto pixels = std::uint64_t(area_.width()) * std::uint64_t(area_.height());
  mutate_primary_samples(schedule, context.image, settings_, *this, mix_bits(context.seed + mix_bits(step.samples.begin)),
                         pixels * (step.samples.end - step.samples.begin), !direct_);
}

Spectrum MutatedPaths::radiance(const Ray& ray, SampleContext& sample) const {
  std::array<Spectrum, direct_length + 1> lengths;
  std::vector<Splat> splats;
  SampleContext own{
      sample.wavelengths, sample.numbers, sample.arena, {.lengths = lengths, .splats = &splats, .abort = sample.sink.abort}};
  if (groups_.any()) {
    std::vector<LightParts::Labelled> labelled;
    {
      LightParts parts(context.image, groups_);
      parts.keep_labelled();
      direct_->radiance(ray, own);
      labelled.assign(parts.labelled().begin(), parts.labelled().end());
    }
    for (const LightParts::Labelled& part : labelled)
      if (is_direct(part.label.length)) LightParts::add(part);
  } else {
    direct_->radiance(ray, own);
  }
  for (const Splat& s : splats)
    if (is_direct(length_of(s))) sample.sink.splat(s.film, s.value, s.wavelengths, s.length);
  Spectrum light;
  for (int length = 1; length <= direct_length; ++length) {
    light += lengths[size_t(length - 1)];
    sample.sink.light(length, lengths[size_t(length - 1)]);
  }
  return light;
}

CameraSample MutatedPaths::sample(int, int, std::uint32_t, Arena&, const PathSink&) const {
  renderer.fail({}, "its samples are mutations of one another: none belongs to a pixel, and none can be replayed by itself");
}

void MutatedPaths::add_labelled(const LightParts& parts, const CameraSample& s, float share, Contribution& f) const {
  parts.require_all(s.value, s.wavelengths);
  static thread_local std::vector<std::pair<int, Spectrum>> sums;
  sums.clear();
  for (const LightParts::Labelled& part : parts.labelled()) {
    if (is_direct(part.label.length)) continue;
    const int label = LightParts::packed(part.label);
    const auto same = std::ranges::find(sums, label, &std::pair<int, Spectrum>::first);
    if (same == sums.end())
      sums.emplace_back(label, part.light);
    else
      same->second += part.light;
  }
  for (const auto& [label, light] : sums) f.add({s.film, light * share, s.wavelengths, label}, area_);
}

void MutatedPaths::evaluate(const NumberSource& numbers, Arena& arena, const std::atomic<bool>* abort, Contribution& f) const {
  static thread_local std::vector<Splat> splats;
  static thread_local std::vector<Spectrum> lengths;
  splats.clear();
  lengths.assign(lengths_, {});
  f.clear();
  const PathSink sink{.lengths = lengths, .splats = &splats, .abort = abort};
  std::optional<LightParts> parts;
  if (groups_.any()) parts.emplace(context.image, groups_).keep_labelled();
  const CameraSample s = paths_->path(area_, numbers, {}, arena, sink);
  // The contribution of one path to the mean over the whole film, when all paths go through a crop of it.
  const auto share =
      float(double(area_.width()) * area_.height() / (double(context.image.width) * double(context.image.height)));
  const auto add = [&](const Spectrum& light, int length) { f.add({s.film, light * share, s.wavelengths, length}, area_); };
  if (parts) add_labelled(*parts, s, share, f);
  Spectrum told;
  for (size_t i = 0; !parts && i < lengths.size(); ++i) {
    told += lengths[i];
    if (!is_direct(int(i) + 1)) add(lengths[i], int(i) + 1);
  }
  // Light whose path length the process does not report is carried by the chains completely. Smaller differences are rounding
  // errors.
  const Spectrum untold = s.value + told * -1.0f;
  if (!parts && untold.maximum() > 1e-4f * s.value.maximum()) add(untold, 0);
  for (const Splat& splat : splats)
    if (!is_direct(length_of(splat)) && area_.contains(int(std::floor(splat.film.x)), int(std::floor(splat.film.y))))
      f.add(splat, area_);
}

}  // namespace etendue
