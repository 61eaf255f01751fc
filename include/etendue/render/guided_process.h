#pragma once
// GuidedProcess: a process whose camera subpaths sample directions from a guide that is learned from the paths of the steps so
// far (guiding/guide.h; Müller, Gross & Novák 2017; Vorba et al. 2014, "On-line learning of parametric mixture models for light
// transport simulation"). It is a decorator: `Base` renders a step, this class passes the training samples of its paths to the
// guide and saves the guide with the process.
//
//     class MyProcess final : public GuidedProcess<RenderProcess> { … guide() … };

#include <optional>

#include "etendue/render/learned_guide.h"
#include "etendue/render/process.h"
#include "etendue/render/shown_in_space.h"

namespace etendue {

/// A RenderProcess whose guide another process may train: one that renders its paths, and passes on what they recorded.
class LearnsFromPaths {
 public:
  /// Whether it has a guide; if not, nothing below may be called.
  virtual bool learns() const = 0;
  /// Chooses the training paths among the next `paths` paths. `number`: of earlier calls; training paths become fewer.
  virtual void begin_learning(std::uint32_t number, int paths) = 0;
  /// Trains the guide with the samples that these paths recorded (PathSink::records), in a fixed order.
  virtual void learn(Schedule&, const std::vector<GuideSample>&) = 0;

 protected:
  ~LearnsFromPaths() = default;
};

/// A RenderProcess that a studio can show in space. PhotonProcess is another.
class ShownProcess : public RenderProcess, public ShownInSpace {
 public:
  using RenderProcess::RenderProcess;
};

template <class Base>
class GuidedProcess : public Base, public LearnsFromPaths {
 public:
  /// Settings of a guide; `nullopt`: the process has no guide and is its base. `memory` in MiB. `longest`: the most training
  /// samples of one path.
  GuidedProcess(const Renderer& renderer_, const RenderContext& context_, const std::optional<GuideSettings>& settings,
                int memory, int longest)
      : Base(renderer_, context_), longest_(longest) {
    if (settings) guide_.emplace(*settings, size_t(memory) << 20);
  }

  void step(Schedule& schedule, const Step& step) override {
    if (!guide_) return Base::step(schedule, step);
    guide_->begin_step(this->context.image.sampled_area(), step, longest_);
    guide_->learn(schedule, this->template film_paths<GuideSample>(schedule, step));
  }
  bool learns() const override { return guide_.has_value(); }
  void begin_learning(std::uint32_t number, int paths) override {
    guide_->begin_step({0, 0, paths, 1}, {number, {0, 1}}, longest_);
  }
  void learn(Schedule& schedule, const std::vector<GuideSample>& samples) override { guide_->learn(schedule, samples); }
  std::optional<ShownLobes> lobes(const Point3& position, const Normal3& normal) const override {
    if (!guide_) return {};
    return guide_->lobes(position, normal);
  }
  std::vector<std::byte> save_state() const override { return guide_ ? guide_->save() : Base::save_state(); }
  void load_state(std::span<const std::byte> bytes) override {
    if (guide_)
      guide_->load(bytes);
    else
      Base::load_state(bytes);
  }

 protected:
  /// Null: there is none.
  const LearnedGuide* guide() const { return guide_ ? &*guide_ : nullptr; }

 private:
  const int longest_;
  std::optional<LearnedGuide> guide_;
};

}  // namespace etendue
