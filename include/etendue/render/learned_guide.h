#pragma once
// LearnedGuide: a path guide that a process trains with the paths of its own steps.
//
//     guide.begin_step(area, step, longest);               chooses the paths that are training paths
//     const auto samples = film_paths<GuideSample>(…);     each path calls `teaches`, and records its training samples
//     guide.learn(schedule, samples);
//
// The paths of a step use the guide as the steps before left it. The samples come in a fixed order and are sorted stably by
// region, and each region is trained with its own samples: so the guide is the same for any number of threads.

#include <vector>

#include "etendue/guiding/guide.h"
#include "etendue/render/process.h"
#include "etendue/render/shown_in_space.h"

namespace etendue {

/// Describes the limit of a guide's memory.
template <auto memory, class R, class... Conditions>
Description<R>& describe_guide_memory(Description<R>& d, Conditions... when) {
  return d.template member<memory>("memory", "1",
                                   "most that the guide, and what it learns from, take, in MiB; states that are saved are as "
                                   "large as the guide",
                                   range(4, 1 << 20), logarithmic, when...);
}

class LearnedGuide {
 public:
  /// `memory`: the upper bound for the guide, its saved states and its training samples together [bytes].
  LearnedGuide(GuideSettings, size_t memory);

  const Guide& guide() const { return guide_; }
  /// `longest`: the largest number of training samples of one path.
  void begin_step(const PixelArea&, const Step&, int longest);
  /// Whether the path of this sample is a training path.
  bool teaches(const SampleContext&) const;
  void learn(Schedule&, const std::vector<GuideSample>&);

  ShownLobes lobes(const Point3& position, const Normal3& normal) const;
  std::vector<std::byte> save() const { return guide_.save(); }
  void load(std::span<const std::byte> bytes) { guide_.load(bytes); }

  /// The samples per step of a renderer with a guide: fewer than usual, so that the guide is trained early.
  static std::uint32_t samples_per_step(std::uint32_t usual) { return std::max(usual / 64, 1u); }

 private:
  const double room_;  // memory for training samples, as their number
  Guide guide_;
  std::uint64_t taught_ = 0;  // the probability of a path to be a training path, times 2^32
};

/// Describes the member that switches the guide on, and its memory in MiB.
template <auto guided, auto memory, class R>
void describe_guide(Description<R>& d) {
  d.template member<guided>("guided", "",
                            "whether the camera's walk learns in which directions light is found that it is to find");
  describe_guide_memory<memory>(d, when("guided"));
}

}  // namespace etendue
