#pragma once
// LearnedGuide: a guide that a process learns from the paths of its steps.
//
//     guide.begin_step(area, step, longest);               which paths teach
//     const auto samples = film_paths<GuideSample>(…);     each asks `teaches`, and records what it found
//     guide.learn(schedule, samples);
//
// Samples of a step see the guide of the steps before. They come in a fixed order, are sorted by region without changing it,
// and each region learns from its own: the guide is the same for any number of threads.

#include <vector>

#include "etendue/guiding/guide.h"
#include "etendue/render/process.h"
#include "etendue/render/shown_in_space.h"

namespace etendue {

/// The most that a guide takes.
template <auto memory, class R, class... Conditions>
Description<R>& describe_guide_memory(Description<R>& d, Conditions... when) {
  return d.template member<memory>("memory", "1",
                                   "most that the guide, and what it learns from, take, in MiB; states that are saved are as "
                                   "large as the guide",
                                   range(4, 1 << 20), logarithmic, when...);
}

class LearnedGuide {
 public:
  /// `memory`: what the guide, its saved states and the samples it learns from may take [bytes].
  LearnedGuide(GuideSettings, size_t memory);

  const Guide& guide() const { return guide_; }
  /// `longest`: samples of a path, at most.
  void begin_step(const PixelArea&, const Step&, int longest);
  /// Whether it learns from a sample.
  bool teaches(const SampleContext&) const;
  void learn(Schedule&, const std::vector<GuideSample>&);

  ShownLobes lobes(const Point3& position, const Normal3& normal) const;
  std::vector<std::byte> save() const { return guide_.save(); }
  void load(std::span<const std::byte> bytes) { guide_.load(bytes); }

  /// Steps are to be smaller than usual: the sooner it begins to learn the better.
  static std::uint32_t samples_per_step(std::uint32_t usual) { return std::max(usual / 64, 1u); }

 private:
  const double room_;  // for samples
  Guide guide_;
  std::uint64_t taught_ = 0;  // of 2^32 paths so many teach
};

/// Whether directions are learned, and the memory it may take, in MiB.
template <auto guided, auto memory, class R>
void describe_guide(Description<R>& d) {
  d.template member<guided>("guided", "",
                            "whether the camera's walk learns in which directions light is found that it is to find");
  describe_guide_memory<memory>(d, when("guided"));
}

}  // namespace etendue
