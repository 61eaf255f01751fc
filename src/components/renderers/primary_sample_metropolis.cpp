// Metropolis light transport in the space of numbers (Kelemen, Szirmay-Kalos, Antal & Csonka 2002, "A simple and robust
// mutation strategy for the Metropolis light transport algorithm"), around any renderer.
//
// A path is a function of numbers u in [0, 1): those of its place on the film, its lens point, time and wavelengths, and all
// that the algorithm inside draws (RenderProcess::path). F(u) is what it brings to the film. Chains of vectors u find it where
// there is much of it (render/number_chains.h), with the mean that the renderer inside has.
//
// What paths of one and two segments bring (luminaires seen, and light straight from them) is better found by samples that are
// well spread over the film: `direct` has the renderer inside find it that way, and the chains carry the rest.

#include <array>

#include "etendue/render/number_chains.h"
#include "etendue/render/renderer.h"

namespace etendue {

class PrimarySampleMetropolis final : public Renderer {
 public:
  Ref<Renderer> inner = ref_cast<Renderer>(Registry::instance().create("BidirectionalPathTracer"));
  bool direct = true;
  int chains = ChainSettings().chains;
  float bootstrap = ChainSettings().bootstrap, large_steps = ChainSettings().large_steps, deviation = ChainSettings().deviation;
  bool even_errors = ChainSettings().even_errors;

  static void describe(Description<PrimarySampleMetropolis>& d) {
    d.summary(
         "Metropolis light transport in primary sample space: mutates the numbers that another renderer's paths are made of.",
         "Kelemen et al. 2002; Veach & Guibas 1997")
        .member<&PrimarySampleMetropolis::inner>("inner", "", "the renderer whose paths are mutated")
        .member<&PrimarySampleMetropolis::direct>(
            "direct", "",
            "whether paths of one or two segments are found by the renderer inside, sample by sample, and not by chains");
    describe_chains<&PrimarySampleMetropolis::chains, &PrimarySampleMetropolis::bootstrap,
                    &PrimarySampleMetropolis::large_steps, &PrimarySampleMetropolis::deviation,
                    &PrimarySampleMetropolis::even_errors>(d);
  }

  PathClasses finds() const override { return inner ? inner->finds() : no_paths; }
  Expectation expectation() const override { return inner ? inner->expectation() : Expectation::unbiased; }
  bool splats() const override { return true; }
  Estimator estimator() const override { return Estimator::correlated; }

 private:
  std::unique_ptr<RenderProcess> begin(const RenderContext&) const override;
};

namespace {

/// Paths up to so many segments are `direct`.
constexpr int direct_length = 2;

/// The same algorithm for those alone, as far as it has such a limit.
Ref<Renderer> for_direct_light(const Renderer& inner) {
  const Ref<Renderer> renderer = ref_cast<Renderer>(copy(inner));
  if (renderer->class_info().find("max_depth")) {
    const Value written = get(*renderer, "max_depth");
    const auto* longest = written.as<Number>();
    if (longest && longest->value > direct_length) set(*renderer, "max_depth", Value(Number{direct_length}));
  }
  prepare_tree(*renderer);
  return renderer;
}

class PrimarySampleProcess final : public RenderProcess, PathFunction {
 public:
  PrimarySampleProcess(const PrimarySampleMetropolis& r, const RenderContext& c)
      : RenderProcess(r, c),
        settings_{r.chains, r.bootstrap, r.large_steps, r.deviation, r.even_errors},
        area_(c.image.sampled_area()),
        lengths_(size_t(std::max(c.image.path_lengths, direct_length + 1))),
        inner_(r.inner->start(c)),
        direct_renderer_(r.direct ? for_direct_light(*r.inner) : nullptr),
        direct_(r.direct ? direct_renderer_->start(c) : nullptr) {
    if (r.inner->steps_depend()) r.fail("inner", "learns in its own steps, of which none are taken here: only its paths are");
    require_mutable(c.wavelengths, r);
  }

  void prepare_step(Schedule& schedule, const Step& step) override {
    inner_->prepare_step(schedule, step);
    if (direct_) direct_->prepare_step(schedule, step);
    // One whose samples are no paths by themselves, such as another of this kind, says so.
    try {
      Arena arena;
      inner_->sample(area_.x0, area_.y0, step.samples.begin, arena);
    } catch (const Error& e) {
      renderer.fail("inner", std::string("has no paths that could be mutated: ") + e.what());
    }
  }

  void step(Schedule& schedule, const Step& step) override {
    if (direct_) RenderProcess::step(schedule, step);  // asks for `radiance`
    const auto pixels = std::uint64_t(area_.width()) * std::uint64_t(area_.height());
    mutate_numbers(schedule, context.image, settings_, *this, mix_bits(context.seed + mix_bits(step.samples.begin)),
                   pixels * (step.samples.end - step.samples.begin), !direct_);
  }

  /// Direct light.
  Spectrum radiance(const Ray& ray, SampleContext& sample) const override {
    std::array<Spectrum, direct_length + 1> lengths;
    std::vector<Splat> splats;
    SampleContext own{sample.wavelengths, sample.numbers, sample.arena, {sample.observe.features, nullptr, lengths}, &splats,
                      sample.abort};
    direct_->radiance(ray, own);
    for (const Splat& s : splats)
      if (is_direct(s.length)) sample.splat(s.film, s.value, s.wavelengths, s.length);
    Spectrum light;
    for (int length = 1; length <= direct_length; ++length) {
      light += lengths[size_t(length - 1)];
      sample.observe.light(length, lengths[size_t(length - 1)]);
    }
    return light;
  }

  CameraSample sample(int, int, std::uint32_t, Arena&, const PathRequest&) const override {
    renderer.fail({}, "its samples are mutations of one another: none belongs to a pixel, and none can be replayed by itself");
  }

 private:
  const ChainSettings settings_;
  const PixelArea area_;
  const size_t lengths_;  ///< that are told apart, the last for all longer ones
  const std::unique_ptr<RenderProcess> inner_;
  const Ref<Renderer> direct_renderer_;
  const std::unique_ptr<RenderProcess> direct_;

  bool is_direct(int length) const { return direct_ && length >= 1 && length <= direct_length; }

  /// F(u), without what is direct.
  void evaluate(const NumberSource& numbers, Arena& arena, const std::atomic<bool>* abort, Contribution& f) const override {
    static thread_local std::vector<Splat> splats;
    static thread_local std::vector<Spectrum> lengths;
    splats.clear();
    lengths.assign(lengths_, {});
    f.clear();
    PathRequest request;
    request.observe.lengths = lengths;
    request.splats = &splats;
    request.abort = abort;
    const CameraSample s = inner_->path(area_, numbers, {}, arena, request);
    // What one path brings to the mean over the whole film, of a crop that all of them go through.
    const auto share =
        float(double(area_.width()) * area_.height() / (double(context.image.width) * double(context.image.height)));
    const auto add = [&](const Spectrum& light, int length) { f.add({s.film, light * share, s.wavelengths, length}, area_); };
    Spectrum told;
    for (size_t i = 0; i < lengths.size(); ++i) {
      told += lengths[i];
      if (!is_direct(int(i) + 1)) add(lengths[i], int(i) + 1);
    }
    // Light of which the renderer inside does not tell the length is the chains', all of it. Less is rounding.
    const Spectrum untold = s.value + told * -1.0f;
    if (untold.maximum() > 1e-4f * s.value.maximum()) add(untold, 0);
    for (const Splat& splat : splats)
      if (!is_direct(splat.length) && area_.contains(int(std::floor(splat.film.x)), int(std::floor(splat.film.y))))
        f.add(splat, area_);
  }
};

}  // namespace

std::unique_ptr<RenderProcess> PrimarySampleMetropolis::begin(const RenderContext& context) const {
  if (!inner) fail("inner", "needs a renderer whose paths it mutates");
  return std::make_unique<PrimarySampleProcess>(*this, context);
}

static const Register<PrimarySampleMetropolis> registered;

}  // namespace etendue
