// Checks of every renderer that reports no missed light for a scene: images of scenes with a known mean must have it.

#include <fmt/format.h>

#include "check/conform/fixtures/ray_bound.h"
#include "conformance.h"
#include "etendue/language/language.h"
#include "etendue/render/render.h"
#include "statistics.h"

namespace etendue::conform {
namespace {

/// A scene whose mean image value is known.
struct KnownScene {
  const char *name, *camera, *objects;
  double expected;
};

constexpr KnownScene known_scenes[] = {
    // Emitted radiance 1 everywhere, and a reflectance of 1/2: 1 / (1 - 1/2).
    {"a furnace", "PerspectiveCamera { from: [0.3, 0.1, 0.2], to: [0, 0, 1], fov: 90 }",
     "Sphere { shader: Lambertian { color: 0.5 }, emission: DiffuseEmission { radiance: 1, sides: back } }", 2},
    // A plane that reflects half of a uniform radiance of 1.
    {"a plane under an environment", "PerspectiveCamera { from: [0, 0, 2], to: [0, 0, 0], fov: 40 }",
     "Rectangle { corner: [-4, -4, 0], edge_u: [8, 0, 0], edge_v: [0, 8, 0], shader: Lambertian { color: 0.5 } }, "
     "Environment { emission: EnvironmentEmission { radiance: 1 } }",
     0.5},
    // An irradiance of pi gives a reflected radiance of 1/2, which leaves upwards and hits nothing else.
    {"a plane under a distant light", "PerspectiveCamera { from: [0, 0, 2], to: [0, 0, 0], fov: 40 }",
     "Rectangle { corner: [-4, -4, 0], edge_u: [8, 0, 0], edge_v: [0, 8, 0], shader: Lambertian { color: 0.5 } }, "
     "Distant { direction: [0, 0, -1], emission: DiffuseEmission { radiance: 3.14159265 } }",
     0.5},
    // The point's intensity of pi gives an irradiance of pi, so the reflected radiance is 1/2 and each further bounce adds half
    // of the one before: 1/2 + 1/4 + ... = 1.
    {"a hollow sphere around a point", "PerspectiveCamera { from: [0.3, 0.1, 0.2], to: [0, 0, 1], fov: 90 }",
     "Sphere { shader: Lambertian { color: 0.5 } }, Point { emission: DiffuseEmission { radiance: 3.14159265 } }", 1},
};

/// The mean of Y over pixels, for renders with different seeds. The spread between renders includes all correlation within a
/// render.
statistics::Mean picture_means(Render& render, int renders, std::uint64_t& bad) {
  statistics::Mean means;
  for (int i = 0; i < renders; ++i) {
    render.restart(std::uint64_t(i + 1));
    render.run();
    bad += render.film().bad_samples();
    const Image image = render.film().develop();
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) sum += image.at(x, y, 1);
    means.add(sum / (double(image.width) * image.height));
  }
  return means;
}

/// The most rays for all images of one scene, at the effort of CI: some seconds. A path tracer needs a fiftieth of this.
constexpr int most_rays = 40'000'000;

/// Returns the light that the renderer reports as missed; empty: the scene was tested. Throws the renderer's Errors.
std::string check_scene(Trial& trial, const KnownScene& known) {
  const std::string what = fmt::format("the value of {} is the known one", known.name);
  const Ref<Job> job = load_job_text(fmt::format("Job {{ camera: {}, image: ImageBuffer {{ width: 8, height: 8, filter: "
                                                 "BoxFilter {{}} }}, scene: BruteForceScene {{ objects: [ {} ] }} }}",
                                                 known.camera, known.objects),
                                     "known");
  const Ref<Renderer> renderer = ref_cast<Renderer>(parse_component(trial.text(), "drawn"));
  job->renderer = renderer;
  // Long paths, so that those cut off carry nothing.
  if (renderer->class_info().find("max_depth")) set(*renderer, "max_depth", Value(Number{64}));
  renderer->samples = trial.samples(16);
  const RayBound bound(*job, std::uint64_t(trial.samples(most_rays)));
  Render render(job, {.threads = 1});
  const std::vector<Advice> missed = renderer->misses(scene_traits(*job->scene, *job->camera));
  if (!missed.empty()) return missed.front().lost;
  // Student's distribution with 15 degrees of freedom exceeds 9.2 standard errors as rarely as the normal distribution exceeds
  // 5.33.
  constexpr double errors = 9.2;
  std::uint64_t bad = 0;
  statistics::Mean means;
  try {
    means = picture_means(render, 16, bad);
  } catch (const Error&) {
    if (!bound.exceeded()) throw;
    trial.not_tried(what, fmt::format("it takes more than {} rays for 16 pictures of 8 x 8 pixels with {} samples each",
                                      trial.samples(most_rays), renderer->samples));
    return {};
  }
  trial.expect(bad == 0, "no sample is not a number, infinite or negative", [&] { return fmt::format("{} are", bad); });
  if (means.error() > 0.05 * known.expected) {
    trial.not_tried(what, fmt::format("all is noise: {:.5f} ± {:.5f}", means.mean(), means.error()));
    return {};
  }
  const double rounding = 3e-4 + (renderer->expectation() == Expectation::unbiased ? 0 : 0.02);
  trial.expect(std::abs(means.mean() - known.expected) < errors * means.error() + rounding * known.expected, what,
               [&] { return fmt::format("{:.5f} ± {:.5f}, known to be {}", means.mean(), means.error(), known.expected); });
  return {};
}

void check_renderer(Trial& trial) {
  const Renderer& part = trial.part<Renderer>();
  const std::string what = "pictures of known value";
  if (part.expectation() == Expectation::biased) return trial.not_tried(what, "it says itself that its values are others");
  std::string missed;
  size_t tried = 0;
  for (const KnownScene& known : known_scenes) try {
      const std::string lost = check_scene(trial, known);
      if (lost.empty())
        ++tried;
      else
        missed = "misses " + lost;
    } catch (const Error& error) {  // it, or a renderer inside it, throws for members that cannot be combined
      if (!std::string(error.what()).starts_with(part.class_info().name) && std::string_view(error.location.file) != "drawn")
        throw;
      missed = error.what();
    }
  if (tried == 0) trial.not_tried(what, "of all of them the renderer says: " + missed);
}

const RegisterCheck<Renderer> registered(check_renderer);

}  // namespace
}  // namespace etendue::conform
