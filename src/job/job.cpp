#include "etendue/job.h"

#include <chrono>

#include "job/pass_runner.h"

namespace etendue {

void Job::describe(Description<Job>& d) {
  d.summary("A whole render: what is seen, how it is computed, and where the picture goes.",
            "Demoreuille & Shaw 2002, section 3.2.2")
      .member<&Job::renderer>("renderer", "", "the algorithm")
      .member<&Job::camera>("camera", "", "where the picture is taken from", required)
      .member<&Job::scene>("scene", "", "what is in front of it", required, Effect::rebuild)
      .member<&Job::image>("image", "", "where samples are collected")
      .member<&Job::wavelengths>("wavelengths", "", "which wavelengths paths carry")
      .member<&Job::tone_map>("tone_map", "", "from radiance to display values", Effect::retone)
      .member<&Job::outputs>("outputs", "", "files to write", Effect::retone)
      .member<&Job::seed>("seed", "1", "chooses the random numbers", at_least(0))
      .member<&Job::time_limit>("time_limit", "s", "stops after the pass in which this time is over; 0: no limit", at_least(0),
                                Effect::retone)
      .member<&Job::error_limit>("error_limit", "1",
                                 "stops when the mean relative standard error of pixels is below this; 0: no limit",
                                 at_least(0), Effect::retone);
}
static const Register<Job> registered;

namespace {

template <class T>
Ref<T> created(const char* name) {
  return ref_cast<T>(Registry::instance().create(name));
}

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// Samples per pixel of each pass: few for large pictures, many for small ones. A function of the size alone, so that
/// passes are the same however a render is stopped or continued.
std::uint32_t samples_per_pass(const PixelArea& area) {
  constexpr std::uint64_t wanted = std::uint64_t(1) << 19;
  const auto pixels = std::uint64_t(area.width()) * std::uint64_t(area.height());
  return std::uint32_t(std::bit_floor(std::clamp<std::uint64_t>(wanted / std::max<std::uint64_t>(pixels, 1), 1, 1 << 14)));
}

}  // namespace

Job::Job()
    : renderer(created<Renderer>("PathTracer")),
      image(created<ImageBuffer>("ImageBuffer")),
      wavelengths(created<WavelengthSampler>("HeroWavelengths")),
      tone_map(created<ToneMap>("NoToneMap")) {}

Job::~Job() = default;

void Job::prepare() {
  if (!renderer) fail("renderer", "a job needs a renderer, such as PathTracer {}");
  if (!camera) fail("camera", "a job needs a camera, such as PerspectiveCamera { from: [0, 0, -5] m, to: [0, 0, 0] m }");
  if (!scene) fail("scene", "a job needs a scene, such as EmbreeScene { objects: [ Sphere {} ] }");
  if (!image) fail("image", "a job needs an image buffer, such as ImageBuffer { width: 512, height: 512 }");
  if (!wavelengths) fail("wavelengths", "a job needs a wavelength sampler, such as HeroWavelengths {}");
  if (camera->shutter_close < camera->shutter_open) camera->fail("shutter_close", "the shutter closes before it opens");
  for (const Ref<Output>& output : outputs)
    if (!output) fail("outputs", "an output is none");
  camera->set_film(image->width, image->height);
  prepared_ = true;
}

RenderContext Job::context() const { return {*scene, *camera, *image, *wavelengths, seed}; }

Ended Job::render() {
  if (!prepared_) prepare_tree(*this);
  const RenderContext context = this->context();
  image->clear();
  renderer->begin(context);
  samples_done_ = 0;
  stop_ = 0;

  const auto wanted = std::uint32_t(renderer->samples);
  const std::uint32_t step = samples_per_pass(image->area());
  const double pixels = double(image->area().width()) * image->area().height();
  const double begun = now();
  double shown = 0, error = 0;

  const auto report = [&](double in_pass, bool finished) {
    const double seconds = now() - begun;
    if (!on_progress || (!finished && seconds - shown < progress_interval)) return;
    shown = seconds;
    Progress p;
    p.samples = samples_done_;
    p.samples_wanted = wanted;
    p.seconds = seconds;
    p.error = error;
    p.finished = finished;
    const double samples = samples_done_ + in_pass * std::min(step, wanted - samples_done_);
    p.samples_per_second = samples * pixels / std::max(seconds, 1e-9);
    p.fraction = samples / wanted;
    if (time_limit > 0) p.fraction = std::max(p.fraction, seconds / time_limit);
    // The error falls with the root of the number of samples.
    if (error_limit > 0 && error > 0 && std::isfinite(error))
      p.fraction = std::max(p.fraction, square(float(error_limit / error)) * 1.0);
    p.fraction = std::min(p.fraction, 1.0);
    p.seconds_left = p.fraction > 0 ? seconds * (1 - p.fraction) / p.fraction : -1;
    on_progress(p);
  };

  PassRunner runner(*image, threads, stop_,
                    [&](std::uint64_t done, std::uint64_t count) { report(double(done) / double(count), false); });
  Ended ended = Ended::samples;
  while (samples_done_ < wanted) {
    runner.begin = samples_done_;
    runner.end = std::min(samples_done_ + step, wanted);
    renderer->pass(context, runner);
    if (stop_.load() == 2) return Ended::aborted;
    samples_done_ = runner.end;
    seconds_ = now() - begun;
    if (error_limit > 0) error = image->relative_error();
    if (samples_done_ == wanted) break;
    if (stop_.load() == 1) {
      ended = Ended::interrupted;
      break;
    }
    if (time_limit > 0 && seconds_ >= time_limit) {
      ended = Ended::time;
      break;
    }
    if (error_limit > 0 && error <= error_limit) {
      ended = Ended::error;
      break;
    }
  }
  report(0, true);
  return ended;
}

Image Job::picture() const {
  Image picture = image->develop();
  for (const auto& [key, text] : metadata) picture.metadata[key] = text;
  picture.metadata["seed"] = std::to_string(seed);
  picture.metadata["samples"] = std::to_string(samples_done_);
  picture.metadata["renderer"] = renderer->class_info().name;
  picture.metadata["version"] = ETENDUE_VERSION;
  return picture;
}

std::vector<std::string> Job::write_outputs(const std::string& default_stem) const {
  const Image radiance = picture();
  std::vector<std::string> written;
  for (const Ref<Output>& output : outputs) {
    const Ref<ToneMap>& tone = output->tone_map ? output->tone_map : (output->for_display() ? tone_map : output->tone_map);
    const std::string path = output->file.empty() ? default_stem + output->extension() : output->file.resolved();
    output->write_image(tone ? tone->apply(radiance) : radiance, path);
    written.push_back(path);
  }
  return written;
}

Point2 Job::replay(int x, int y, std::uint32_t sample, PathRecord& record) {
  if (!prepared_) prepare_tree(*this);
  if (!image->area().contains(x, y))
    throw Error("there is no pixel " + std::to_string(x) + "," + std::to_string(y) + " in the picture");
  const RenderContext context = this->context();
  renderer->begin(context);
  Arena arena;
  Renderer::Request request;
  request.record = &record;
  return renderer->camera_sample(context, x, y, sample, arena, request).film;
}

}  // namespace etendue
