// The algorithm chosen by itself, without bias.
//
// The picture begins with the first of several unbiased algorithms. Before the samples 8, 16, 32, 64, ... of each pixel those
// still in question are tried on the scene (algorithm_trial.h), with random numbers of their own, and the samples after it are
// taken by the one with the least error at equal cost, by all trials so far. A trial traces 1/256 of the paths so far with each
// algorithm, in small pictures up to 1/32, so trials take a few percent of the time; an algorithm that is found much worse than
// the best is tried no more. A preview of a few samples has no trial at all.
//
// The samples of an algorithm with less variance must count more: eight samples of a path tracer would spoil few, expensive
// ones of a bidirectional one. Let V_i be the variances of the samples of two independent means of n_i samples. The variance of
// their weighted mean is least for weights in proportion to n_i / V_i (inverse-variance weighting), so each sample counts
//     w = V_1 / V
// times, with V_1 the variance of the first algorithm's samples and V that of the chosen one's, as the trial estimated them:
// rounded down to a power of two from 1 to 64.
//
// Why this is unbiased: the choices and weights are functions of the trials' samples alone. The trials' samples are not in the
// picture, and independent of those that are. Given choices and weights, the picture is a mean with constant weights of samples
// each of which has the right expectation (those of a guided algorithm for any guide). So its expectation is right for each
// outcome of the trials, and in total. For this each algorithm with a guide has two: the one that is tried learns from trials
// alone; the one that renders begins with what that one knows, and learns from the picture.
//
// An estimate from the first samples that also shows them would not do: a render that happened to be dark has a small variance,
// and would be preferred.

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "algorithm_trial.h"
#include "etendue/describe/registry.h"
#include "etendue/render/guided_process.h"
#include "etendue/render/renderer.h"
#include "etendue/render/tells_choice.h"
#include "etendue/transport/light_groups.h"
#include "etendue/transport/renderer_members.h"
#include "etendue/transport/scene_traits.h"
#include "render/division.h"

namespace etendue {
namespace {

Ref<Renderer> made(const char* name) { return ref_cast<Renderer>(Registry::instance().create(name)); }

class Automatic final : public Renderer {
 public:
  std::vector<Ref<Renderer>> candidates{made("PathTracer"), made("GuidedPathTracer"), made("BidirectionalPathTracer")};
  int max_depth = 64;

  static void describe(Description<Automatic>& d) {
    d.summary(
         "Finds out by itself which of several algorithms suits the scene, and says so. It begins with the first of them; "
         "before the samples 8, 16, 32, 64, … of each pixel it tries all on a small part of the picture, and goes on with "
         "the one that has the least error for its cost. Trials take a few percent of the time. Without bias, since the "
         "samples "
         "of trials decide and are not shown. Costs are counted and not measured, so the choice is the same on all machines. "
         "Steps depend on those before, so parts cannot be rendered apart, and a crop may be rendered by another algorithm "
         "than the whole picture.",
         "Veach 1997, section 2.2: efficiency")
        .member<&Automatic::candidates>(
            "candidates", "",
            "the algorithms, which must be unbiased with independent samples; those that lose light that another finds in the "
            "scene are not used. How many samples there are, their sampler, the light sampler, the filter of maps and the "
            "longest path are said out here, and refused in there");
    describe_max_depth<&Automatic::max_depth>(d, stored_subpath_depth, range(1, longest_stored_subpath));
  }

  void prepare() override;
  std::uint32_t samples_per_step(std::uint32_t usual) const override {
    std::uint32_t least = usual;
    for (const Ref<Renderer>& c : candidates)
      if (c) least = std::min(least, c->samples_per_step(usual));
    return least;
  }
  bool steps_depend() const override { return true; }
  /// Steps are independent, but their samples have different weights, which only the variance between steps takes into account.
  Estimator estimator() const override { return Estimator::correlated; }
  bool splats() const override {
    return std::ranges::any_of(candidates, [](const Ref<Renderer>& c) { return c && c->splats(); });
  }
  PathClasses finds() const override {
    PathClasses all = no_paths;
    for (const Ref<Renderer>& c : candidates)
      if (c) all |= c->finds();
    return all;
  }

  /// The candidates with this renderer's sampler, light sampler, filter of maps and longest path.
  const std::vector<Ref<Renderer>>& used() const { return used_; }

 private:
  std::unique_ptr<RenderProcess> begin(const RenderContext&) const override;
  void require_candidates() const;

  std::vector<Ref<Renderer>> used_;
};

void Automatic::prepare() {
  used_.clear();
  for (const Ref<Renderer>& c : candidates) {
    if (!c) continue;
    const auto own = ref_cast<Renderer>(copy(*c));  // what is written stays as it is written
    if (own->class_info().find("max_depth")) set(*own, "max_depth", Value(Number{double(max_depth)}));
    prepare_tree(*own);
    own->sampler = sampler;
    own->light_sampler = light_sampler;
    own->map_filter = map_filter;
    used_.push_back(own);
  }
}

/// Throws Error for candidates that cannot be tried, and members of theirs that would have no effect.
void Automatic::require_candidates() const {
  if (candidates.empty()) fail("candidates", "needs at least one algorithm");
  for (const Ref<Renderer>& c : candidates) {
    if (!c) fail("candidates", "an algorithm is none");
    const std::string& name = c->class_info().name;
    if (c->expectation() != Expectation::unbiased)
      fail("candidates", name + " is biased: a choice among algorithms must not change what is seen");
    if (c->estimator() == Estimator::correlated)
      fail("candidates", name + " does not take its samples independent of each other");
    if (!c->origin) continue;
    for (const char* member : {"samples", "sampler", "light_sampler", "map_filter", "max_depth"})
      if (std::ranges::any_of(c->origin->members, [&](const auto& m) { return m.first == member; }))
        c->fail(member, "has no effect here: set it on the enclosing Automatic");
  }
}

/// The candidates that find as much of the scene's light as any other.
std::vector<const Renderer*> usable(const Automatic& r, const RenderContext& context) {
  const PathClasses there = paths_in(scene_traits(context.scene, context.camera));
  PathClasses best = r.used().front()->finds() & there;
  for (const Ref<Renderer>& c : r.used())
    if (const PathClasses found = c->finds() & there; (found & best) == best) best = found;
  std::vector<const Renderer*> all;
  for (const Ref<Renderer>& c : r.used())
    if ((c->finds() & there) == best) all.push_back(c.get());
  return all;
}

class AutomaticProcess final : public ShownProcess, public TellsChoice {
 public:
  AutomaticProcess(const Automatic& r, const RenderContext& c) : ShownProcess(r, c) {
    for (const Renderer* one : usable(r, c)) candidates_.push_back({.renderer = one});
    use(0, {});
  }

  void prepare_step(Schedule& schedule, const Step& step) override {
    const std::uint32_t due = trials_before(step.samples.begin);
    if (due > trials_ && in_question() > 1) hold_trial(schedule, step, due);
    if (!schedule.aborted()) film_->prepare_step(schedule, step);
  }
  void step(Schedule&, const Step&) override;

  Spectrum radiance(const Ray& ray, SampleContext& sample) const override { return film_->radiance(ray, sample); }
  Wavelengths wavelengths(SampleKey key, float u) const override { return film_->wavelengths(key, u); }
  float time(float u) const override { return film_->time(u); }
  CameraSample sample(int x, int y, std::uint32_t number, Arena& arena, const PathSink& sink) const override {
    return film_->sample(x, y, number, arena, sink);
  }
  std::optional<ShownLobes> lobes(const Point3& position, const Normal3& normal) const override {
    const auto* shown = dynamic_cast<const ShownInSpace*>(film_.get());
    return shown ? shown->lobes(position, normal) : std::nullopt;
  }

  std::vector<std::byte> save_state() const override;
  void load_state(std::span<const std::byte>) override;
  std::string told() const override;

 private:
  struct Candidate {
    const Renderer* renderer = nullptr;
    std::unique_ptr<RenderProcess> process = {};  // that is tried; null: not yet
    std::uint32_t lessons = 0;                    // how often its guide was trained,
    double taught = 0;                            // and with how many paths before trials
    bool out = false;                             // it was found much worse than another
    double error = 0, cost = 0;                   // V and C: the means of the trials it took part in,
    double paths = 0;                             // over so many paths
    double product() const { return error * cost; }
    void learn(double v, double c, double over) {
      paths += over;
      error += (v - error) * over / paths;
      cost += (c - cost) * over / paths;
    }
  };
  static constexpr std::uint32_t first_trial = 8, trial_factor = 2;

  /// The number of trials before a sample of each pixel.
  static std::uint32_t trials_before(std::uint64_t sample) {
    std::uint32_t count = 0;
    for (std::uint64_t at = first_trial; at <= sample; at *= trial_factor) ++count;
    return count;
  }
  std::ptrdiff_t in_question() const { return std::ranges::count(candidates_, false, &Candidate::out); }
  static LearnsFromPaths* pupil(RenderProcess& process) {
    auto* const p = dynamic_cast<LearnsFromPaths*>(&process);
    return p && p->learns() ? p : nullptr;
  }

  void teach(Schedule&, Candidate&, std::uint32_t number, std::uint32_t due, double paths);
  void hold_trial(Schedule&, const Step&, std::uint32_t due);
  void decide(const std::vector<size_t>& tried);
  void use(size_t candidate, std::span<const std::byte> state);

  std::vector<Candidate> candidates_;
  size_t chosen_ = 0;
  std::uint32_t weight_ = 1;             // w
  std::uint32_t trials_ = 0;             // due so far; those missed because steps are long are not made up for
  std::uint32_t trial_samples_ = 0;      // samples per pixel before the last trial; 0: there was none
  std::uint32_t lessons_ = 0;            // how often the guide that renders was trained
  std::unique_ptr<RenderProcess> film_;  // of the chosen algorithm
};

/// Renders with a candidate from now on.
void AutomaticProcess::use(size_t candidate, std::span<const std::byte> state) {
  chosen_ = candidate;
  film_ = candidates_[candidate].renderer->start(context);
  if (!state.empty()) film_->load_state(state);
  if (candidates_[candidate].renderer->steps_depend() && !pupil(*film_))
    renderer.fail("candidates", candidates_[candidate].renderer->class_info().name + " learns in a way that cannot be tried");
}

/// Lets the guide of a candidate learn before it is tried: what it is worth shows only then. It has learned most of what it can
/// after some ten thousand paths, whatever the picture's size (docs/decisions/052-automatic.md).
void AutomaticProcess::teach(Schedule& schedule, Candidate& one, std::uint32_t number, std::uint32_t due, double paths) {
  constexpr double enough = 1 << 16;
  paths = std::min(paths, enough - one.taught);
  if (!(paths >= 1)) return;
  const AlgorithmTrial lesson(context, mix_bits(context.seed ^ mix_bits(0x6c657373 + due)), paths);
  lesson.measure(schedule, *one.process, number, one.lessons);
  one.taught += paths;
}

void AutomaticProcess::hold_trial(Schedule& schedule, const Step& step, std::uint32_t due) {
  constexpr double share = 1.0 / 256, largest_share = 1.0 / 32, fewest = 1024, enough = 2048, most = 1 << 17;
  constexpr double lessons_share = 1.0 / 32;
  const PixelArea area = context.image.sampled_area();
  const double pixels = double(area.width()) * double(area.height());
  const double so_far = step.samples.begin * pixels,
               paths = std::clamp(share * so_far, std::min(enough, largest_share * so_far), most);
  trials_ = due;
  if (paths < fewest) return;
  const AlgorithmTrial trial(context, mix_bits(context.seed ^ mix_bits(0x7472696c + due)), paths);
  std::vector<size_t> tried;
  std::vector<AlgorithmTrial::Measured> measured;
  for (size_t c = 0; c < candidates_.size(); ++c) {
    Candidate& one = candidates_[c];
    if (one.out) continue;
    if (!one.process) one.process = one.renderer->start(context);
    one.process->prepare_step(schedule, step);
    if (pupil(*one.process)) teach(schedule, one, std::uint32_t(c), due, lessons_share * so_far);
    if (schedule.aborted()) return;
    measured.push_back(trial.measure(schedule, *one.process, std::uint32_t(c), one.lessons));
    tried.push_back(c);
    if (schedule.aborted()) return;
  }
  const std::vector<double> errors = trial.errors(measured);
  for (size_t i = 0; i < tried.size(); ++i) candidates_[tried[i]].learn(errors[i], measured[i].cost, paths);
  trial_samples_ = step.samples.begin;
  decide(tried);
}

void AutomaticProcess::decide(const std::vector<size_t>& tried) {
  constexpr double hold = 0.9;    // of the present algorithm's error: what is not better by this is not worth a change
  constexpr double hopeless = 4;  // times the best error: no longer tried,
  constexpr double known = 8192;  // if so many paths say so
  size_t best = chosen_;
  for (const size_t c : tried)
    if (candidates_[c].product() < candidates_[best].product()) best = c;
  if (!(candidates_[best].product() < hold * candidates_[chosen_].product())) best = chosen_;
  const double limit = hopeless * candidates_[best].product();
  for (const size_t c : tried)
    candidates_[c].out = c != best && c > 0 && candidates_[c].product() > limit && candidates_[c].paths >= known;
  if (best != chosen_) {
    const bool learns = pupil(*candidates_[best].process);
    lessons_ = candidates_[best].lessons;
    use(best, learns ? candidates_[best].process->save_state() : std::vector<std::byte>{});
  }
  constexpr double most = 64;
  const double less = candidates_[best].error > 0 ? candidates_[0].error / candidates_[best].error : 1;
  weight_ = best == 0 ? 1 : std::bit_floor(std::uint32_t(std::clamp(less, 1.0, most)));
}

void AutomaticProcess::step(Schedule& schedule, const Step& step) {
  const Division division(context.image, step.samples);
  const LightGroups groups(context.scene, context.image);
  LearnsFromPaths* const learner = pupil(*film_);
  const PixelArea all = context.image.sampled_area();
  if (learner) learner->begin_learning(lessons_++, all.width() * all.height() * int(step.samples.end - step.samples.begin));
  const auto work = [&](std::uint64_t item, ImageTile& tile, RecordList records, Arena& arena) {
    const auto [area, first, last, block] = division.item(item);
    tile.begin(context.image, area, block);
    std::vector<Splat> splats;
    LightParts parts(context.image, groups);
    const PathSink sink{.lengths = parts.lengths(), .splats = &splats, .records = records, .abort = schedule.abort};
    for (int y = area.y0; y < area.y1; ++y)
      for (int x = area.x0; x < area.x1; ++x)
        for (SampleKey key(context.seed, x, y, first); key.sample < last; ++key.sample) {
          if (schedule.aborted()) return;
          splats.clear();
          parts.clear();
          const CameraSample s = film_->path({x, y, x + 1, y + 1}, *renderer.sampler, key, arena, sink);
          // A sample that counts w times is w paths among those over which splats are averaged.
          for (std::uint32_t i = 0; i < weight_; ++i) tile.count_path();
          tile.contribute(s.film, x, y, key.sample, s.value, s.wavelengths, float(weight_), parts.all());
          for (const Splat& splat : splats)
            tile.splat(splat.film, x, y, key.sample, splat.value * float(weight_), splat.wavelengths, splat.length);
        }
  };
  if (learner) {
    const std::vector<GuideSample> found = schedule.film_and_collect<GuideSample>(
        division.count(), [&](std::uint64_t item, ImageTile& tile, std::vector<GuideSample>& records, Arena& arena) {
          work(item, tile, RecordList(records), arena);
        });
    learner->learn(schedule, found);
  } else {
    schedule.film(division.count(), [&](std::uint64_t item, ImageTile& tile, Arena& arena) { work(item, tile, {}, arena); });
  }
}

// ---- state
// -------------------------------------------------------------------------------------------------------------------

std::vector<std::byte> AutomaticProcess::save_state() const {
  std::vector<std::byte> bytes;
  for (const std::uint32_t n :
       {std::uint32_t(candidates_.size()), std::uint32_t(chosen_), weight_, trials_, trial_samples_, lessons_})
    Packing::pack(bytes, n);
  for (const Candidate& c : candidates_) {
    Packing::pack(bytes, c.lessons);
    Packing::pack(bytes, c.taught);
    Packing::pack(bytes, c.out);
    Packing::pack(bytes, c.error);
    Packing::pack(bytes, c.cost);
    Packing::pack(bytes, c.paths);
    Packing::pack(bytes, c.process ? c.process->save_state() : std::vector<std::byte>{});
  }
  Packing::pack(bytes, film_->save_state());
  return bytes;
}

void AutomaticProcess::load_state(std::span<const std::byte> bytes) {
  std::uint32_t count = 0, chosen = 0;
  for (std::uint32_t* const n : {&count, &chosen, &weight_, &trials_, &trial_samples_, &lessons_}) Packing::unpack(bytes, *n);
  if (count != candidates_.size() || chosen >= count || weight_ < 1 || weight_ > 64)
    throw Error("the state is not one of Automatic with these algorithms");
  std::vector<std::byte> state;
  for (Candidate& c : candidates_) {
    Packing::unpack(bytes, c.lessons);
    Packing::unpack(bytes, c.taught);
    std::uint8_t out = 0;
    Packing::unpack(bytes, out);
    c.out = out != 0;
    Packing::unpack(bytes, c.error);
    Packing::unpack(bytes, c.cost);
    Packing::unpack(bytes, c.paths);
    Packing::unpack(bytes, state);
    c.process = state.empty() ? nullptr : c.renderer->start(context);
    if (c.process) c.process->load_state(state);
  }
  Packing::unpack(bytes, state);
  if (!bytes.empty()) throw Error("the state of Automatic is too long");
  use(chosen, state);
}

// ---- what it says
// --------------------------------------------------------------------------------------------------------------

std::string AutomaticProcess::told() const {
  const auto name = [&](size_t c) { return candidates_[c].renderer->class_info().name; };
  if (candidates_.size() == 1)
    return fmt::format("{}, the only one of the algorithms that finds the light of this scene", name(0));
  if (trial_samples_ == 0) return {};
  std::string others;
  for (size_t c = 0; c < candidates_.size(); ++c)
    if (c != chosen_ && candidates_[c].product() > 0)
      others += fmt::format("{}{:.2g} times that of {}", others.empty() ? "" : " and ",
                            candidates_[chosen_].product() / candidates_[c].product(), name(c));
  return fmt::format("{}: trials up to sample {} of each pixel found its error at equal cost to be {}", name(chosen_),
                     trial_samples_, others.empty() ? "none" : others);
}

std::unique_ptr<RenderProcess> Automatic::begin(const RenderContext& context) const {
  require_candidates();
  return std::make_unique<AutomaticProcess>(*this, context);
}

const Register<Automatic> registered;

}  // namespace
}  // namespace etendue
