// A Metropolis renderer around a path tracer with a fault, built from the same parts as PrimarySampleMetropolis.

#include "etendue/transport/metropolis.h"
#include "etendue/transport/primary_sample_vectors.h"
#include "faults.h"

namespace etendue {
namespace {

class FaultyMetropolis final : public Renderer {
 public:
  Fault fault = Fault::none;
  Ref<Renderer> inner = ref_cast<Renderer>(Registry::instance().create("PathTracer"));

  static void describe(Description<FaultyMetropolis>& d) {
    d.summary("For tests: Metropolis light transport with something wrong.")
        .member<&FaultyMetropolis::inner>("inner", "", "whose paths are mutated");
    describe_fault<&FaultyMetropolis::fault>(d);
  }
  PathClasses finds() const override { return inner->finds(); }
  bool splats() const override { return true; }
  Estimator estimator() const override { return Estimator::correlated; }

 private:
  std::unique_ptr<RenderProcess> begin(const RenderContext&) const override;
};

class Process final : public RenderProcess {
  const Fault fault_;
  const std::unique_ptr<RenderProcess> inner_;
  static constexpr double large_steps = 0.3;
  static constexpr std::uint64_t chains = 64, pool_size = 128;  // chains per step; bootstrap paths per chain

  void evaluate(const NumberSource& numbers, Contribution& f, Arena& arena, bool direct) const {
    std::array<Spectrum, 3> lengths;
    PathSink sink;
    sink.lengths = lengths;
    const PixelArea whole{0, 0, context.image.width, context.image.height};
    const CameraSample s = inner_->path(whole, numbers, {}, arena, sink);
    f.clear();
    f.add({s.film, direct ? s.value : lengths[2], s.wavelengths, 0}, whole);
  }

  ChainStarts pool(std::uint64_t seed, Arena& arena, bool direct) const {
    Contribution f;
    std::vector<ChainStarts::Path> paths;
    for (std::uint64_t i = 0; i < pool_size; ++i) {
      evaluate(MutatedPrimarySamples(seed + i), f, arena, direct);
      if (fault_ == Fault::dark_paths_left_out && !(f.brightness({}) > 0)) continue;
      paths.push_back({i, f.brightness({}), 0});
    }
    return ChainStarts(paths);
  }

  void run(std::uint64_t seed, std::uint64_t states, ImageTile& tile, Arena& arena) const {
    const bool direct = fault_ == Fault::direct_light_twice;
    const ChainStarts own = pool(seed, arena, direct), other = pool(seed + 1000, arena, direct);
    ChoiceNumbers choices(seed + 2000);
    MutatedPrimarySamples numbers(seed + own.begin(0, 1, choices.next()));
    const StateWeights weights{own.mean(), other.mean(), large_steps};
    Contribution u, v;
    evaluate(numbers, u, arena, direct);
    numbers.accept();
    for (std::uint64_t i = 0; i < states; ++i) {
      const bool large = choices.next() < large_steps;
      large ? numbers.large_step() : numbers.small_step();
      evaluate(numbers, v, arena, direct);
      const double I = u.brightness({}), J = v.brightness({});
      const bool inverted = fault_ == Fault::acceptance_inverted;
      const double a = !(I > 0) ? 1 : !(J > 0) ? 0 : std::min(1.0, inverted ? I / J : J / I);
      if (fault_ != Fault::no_expected_values && I > 0) u.add_to(tile, weights.factor(false, 1 - a, I));
      if (J > 0)
        v.add_to(tile, weights.factor(large, a, J) + (large && fault_ == Fault::large_steps_twice ? 1 / large_steps : 0));
      if (choices.next() < a) {
        numbers.accept();
        std::swap(u, v);
      } else {
        numbers.reject();
      }
    }
  }

 public:
  Process(const FaultyMetropolis& r, const RenderContext& c)
      : RenderProcess(r, c), fault_(r.fault), inner_(r.inner->start(c)) {}

  Spectrum radiance(const Ray& ray, SampleContext& sample) const override {
    std::array<Spectrum, 3> lengths;
    sample.sink.lengths = lengths;
    inner_->radiance(ray, sample);
    return lengths[0] + lengths[1];
  }
  void step(Schedule& schedule, const Step& step) override {
    RenderProcess::step(schedule, step);
    const ImageBuffer& image = context.image;
    const auto all = std::uint64_t(image.width) * std::uint64_t(image.height) * (step.samples.end - step.samples.begin);
    schedule.film(chains, [&](std::uint64_t item, ImageTile& tile, Arena& arena) {
      tile.begin(image, {});
      run(mix_bits(context.seed + mix_bits(step.samples.begin * chains + item)), all / chains + (item < all % chains), tile,
          arena);
    });
  }
};

std::unique_ptr<RenderProcess> FaultyMetropolis::begin(const RenderContext& c) const {
  return std::make_unique<Process>(*this, c);
}

const Register<FaultyMetropolis> registered;

}  // namespace
}  // namespace etendue
