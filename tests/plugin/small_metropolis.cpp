// Metropolis light transport in primary sample space, in one file, out of tree, around any inner renderer.
//
// A path is a function of primary samples u in [0, 1); F(u) is its contribution to the film, and I(u) the luminance of F(u). A
// chain samples u with the pdf I / b, b being the integral of I, and adds b F(u) / I(u) to the film for each of its states
// (Kelemen et al. 2002, "A simple and robust mutation strategy for the Metropolis light transport algorithm"). Each chain
// starts with one of M independent paths, chosen in proportion to I, and uses the mean of their I for b: then its mean is exact
// from the first state on (Veach 1997, section 11.3.1). Both the state before a proposal and the proposal are added, weighted
// by 1 - a and a, the acceptance probability being a (expected values instead of the accepted state alone).
#include "etendue/render/renderer.h"
#include "etendue/transport/primary_sample_vectors.h"

using namespace etendue;

class SmallMetropolis final : public Renderer {
 public:
  Ref<Renderer> inner;
  int chains = 256, bootstrap = 64;
  float large_steps = 0.3f;

  static void describe(Description<SmallMetropolis>& d) {
    d.summary("Metropolis light transport in primary sample space, around another renderer.", "Kelemen et al. 2002")
        .member<&SmallMetropolis::inner>("inner", "", "the renderer whose paths are mutated", required)
        .member<&SmallMetropolis::chains>("chains", "1", "Markov chains of each step", range(1, 65536))
        .member<&SmallMetropolis::bootstrap>("bootstrap", "1", "paths a chain's first is chosen among", range(1, 65536))
        .member<&SmallMetropolis::large_steps>("large_steps", "1", "part of proposals that are wholly new", range(0.01, 1));
  }
  PathClasses finds() const override { return inner ? inner->finds() : no_paths; }
  Expectation expectation() const override { return inner ? inner->expectation() : Expectation::unbiased; }
  Estimator estimator() const override { return Estimator::correlated; }

 private:
  std::unique_ptr<RenderProcess> begin(const RenderContext&) const override;
};

class MetropolisProcess final : public RenderProcess {
  const SmallMetropolis& settings_;
  const std::unique_ptr<RenderProcess> inner_;

  /// F(u), with the film point of each part, and I(u).
  struct Contribution {
    std::vector<Splat> parts;
    double brightness = 0;
  };

  void evaluate(const MutatedPrimarySamples& numbers, Contribution& f, Arena& arena, const std::atomic<bool>* abort) const {
    const ImageBuffer& image = context.image;
    f.parts.clear();
    PathSink sink;
    sink.splats = &f.parts;
    sink.abort = abort;
    const CameraSample s = inner_->path({0, 0, image.width, image.height}, numbers, {}, arena, sink);
    f.parts.push_back({s.film, s.value, s.wavelengths, 0});
    f.brightness = 0;
    for (const Splat& part : f.parts) f.brightness += std::max(0.0, double(to_xyz(part.value, part.wavelengths).y));
    if (!std::isfinite(f.brightness)) f.brightness = 0;
  }

  /// Runs one chain of so many states.
  void run(std::uint64_t chain, std::uint64_t states, ImageTile& tile, Arena& arena, const std::atomic<bool>* abort) const {
    const auto bits = [&](std::uint64_t n) { return mix_bits(context.seed ^ mix_bits(chain + 0x5bd1e995u * (n + 1))); };
    const auto uniform = [&](std::uint64_t n) { return double(bits(n) >> 11) * 0x1p-53; };
    Contribution current, proposed;
    double b = 0;
    std::vector<double> brightness(size_t(settings_.bootstrap));
    for (size_t i = 0; i < brightness.size(); ++i) {
      const MutatedPrimarySamples numbers(bits(i));
      evaluate(numbers, current, arena, abort);
      b += brightness[i] = current.brightness;
    }
    for (std::uint64_t i = 0; i < states; ++i) tile.count_path();
    if (!(b > 0)) return;
    size_t first = 0;
    for (double rest = uniform(1u << 20) * b; first + 1 < brightness.size() && rest >= brightness[first]; ++first)
      rest -= brightness[first];
    b /= double(brightness.size());
    MutatedPrimarySamples numbers(bits(first));
    evaluate(numbers, current, arena, abort);

    const auto add = [&](const Contribution& f, double weight) {
      if (f.brightness > 0 && weight > 0)
        for (const Splat& part : f.parts)
          tile.splat(part.film, int(part.film.x), int(part.film.y), 0, part.value * float(weight * b / f.brightness),
                     part.wavelengths, part.length);
    };
    double held = 0;  // the weight of the current state that is not added yet
    for (std::uint64_t i = 0; i < states; ++i) {
      if (abort && abort->load(std::memory_order_relaxed)) return;
      if (uniform((2u << 20) + 2 * i) < double(settings_.large_steps))
        numbers.large_step();
      else
        numbers.small_step();
      evaluate(numbers, proposed, arena, abort);
      const double accept = std::min(1.0, proposed.brightness / current.brightness);
      held += 1 - accept;
      if (uniform((2u << 20) + 2 * i + 1) < accept) {
        numbers.accept();
        add(current, held);
        std::swap(current, proposed);
        held = accept;
      } else {
        numbers.reject();
        add(proposed, accept);
      }
    }
    add(current, held);
  }

 public:
  MetropolisProcess(const SmallMetropolis& r, const RenderContext& c)
      : RenderProcess(r, c), settings_(r), inner_(r.inner->start(c)) {
    if (!c.image.crop.empty()) r.fail({}, "renders whole pictures, no crops");
    const SampleKey one(1, 2, 3, 4), other(5, 6, 7, 8);
    if (c.wavelengths.sample(one, 0.3f)[0] != c.wavelengths.sample(other, 0.3f)[0])
      r.fail({}, "needs wavelengths that follow from a number, such as HeroWavelengths");
  }

  void prepare_step(Schedule& schedule, const Step& step) override { inner_->prepare_step(schedule, step); }

  CameraSample sample(int, int, std::uint32_t, Arena&, const PathSink&) const override {
    renderer.fail({}, "its samples are mutations of one another: none belongs to a pixel, and none can be replayed by itself");
  }

  void step(Schedule& schedule, const Step& step) override {
    const ImageBuffer& image = context.image;
    const auto chains = std::uint64_t(settings_.chains);
    const std::uint64_t all =
        std::uint64_t(image.width) * std::uint64_t(image.height) * (step.samples.end - step.samples.begin);
    schedule.film(chains, [&](std::uint64_t item, ImageTile& tile, Arena& arena) {
      tile.begin(image, {});  // the tile has splats only
      run(step.samples.begin * chains + item, all / chains + (item < all % chains), tile, arena, schedule.abort);
    });
  }
};

std::unique_ptr<RenderProcess> SmallMetropolis::begin(const RenderContext& context) const {
  return std::make_unique<MetropolisProcess>(*this, context);
}

static const Register<SmallMetropolis> registered;
