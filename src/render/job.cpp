#include "etendue/render/job.h"

#include <fmt/format.h>

#include <chrono>

#include "checkpoint.h"
#include "describe/guard.h"
#include "film/film_state.h"
#include "geometry/rendering_space.h"
#include "parallel_schedule.h"

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
      .member<&Job::error_limit>(
          "error_limit", "1",
          "stops when the mean relative standard error of pixels is below this; 0: no limit. A small bias: "
          "samples that hide their error, as those do that lack rare light, end it early",
          at_least(0), Effect::retone);
}
static const Register<Job> registered;

namespace {

template <class T>
Ref<T> created(const char* name) {
  return ref_cast<T>(Registry::instance().create(name));
}

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

}  // namespace

Job::Job()
    : renderer(created<Renderer>("PathTracer")),
      image(created<ImageBuffer>("ImageBuffer")),
      wavelengths(created<WavelengthSampler>("HeroWavelengths")),
      tone_map(created<ToneMap>("AgXToneMap")) {}

Job::~Job() = default;

void Job::count_from(const DoublePoint3& centre) {
  centre_ = centre;
  camera->world_centre = centre;
  etendue::count_from(*scene, centre, camera->shutter_open);
}

void Job::before_prepare() {
  if (!camera || !scene) return;
  const std::optional<DoublePoint3> place = camera->place();
  count_from(place && is_finite(*place) ? *place : DoublePoint3{});
}

namespace {

/// Media that differ from place to place count in the coordinates of their object; within another scene those are not known to
/// a path that is in the medium.
void refuse_uneven_media_within(const Scene& scene, bool nested) {
  for (const Ref<SceneObject>& object : scene.objects) {
    if (nested && object->interior && !object->interior->homogeneous())
      object->fail("interior",
                   "a medium that differs from place to place cannot stand in a scene within a scene; put the object "
                   "into the outer scene");
    if (const Scene* inner = scene_within(*object)) refuse_uneven_media_within(*inner, true);
  }
}

}  // namespace

void Job::prepare() {
  if (!renderer) fail("renderer", "a job needs a renderer, such as PathTracer {}");
  if (!camera) fail("camera", "a job needs a camera, such as PerspectiveCamera { from: [0, 0, -5] m, to: [0, 0, 0] m }");
  if (!scene) fail("scene", "a job needs a scene, such as EmbreeScene { objects: [ Sphere {} ] }");
  if (!image) fail("image", "a job needs an image buffer, such as ImageBuffer { width: 512, height: 512 }");
  if (!wavelengths) fail("wavelengths", "a job needs a wavelength sampler, such as HeroWavelengths {}");
  if (camera->shutter_close < camera->shutter_open) camera->fail("shutter_close", "the shutter closes before it opens");
  for (const Ref<Output>& output : outputs)
    if (!output) fail("outputs", "an output is none");
  // Seen from far away the scene would be coarse where the picture is fine.
  constexpr float far = 4;
  const Vector3 away = scene->centre() - Point3{};
  if (camera->place() && length(away) > far * scene->radius() && is_finite(away)) {
    count_from(centre_ + DoubleVector3(away));
    prepare_tree(*scene);
    camera->prepare();
  }
  refuse_uneven_media_within(*scene, false);
  camera->set_film(image->width, image->height);
  begin_film();
  prepared_ = true;
}

/// What was collected stays while it fits the description.
void Job::begin_film() {
  const Estimator estimator = renderer ? renderer->estimator() : Estimator::independent;
  if (film_ && film_->estimator() == estimator)
    film_->follow(*image);
  else
    film_ = std::make_unique<Film>(*image, estimator);
}

Film& Job::film() const {
  if (!film_) throw Error("a job that was not prepared has no film");
  return *film_;
}

RenderContext Job::context() const { return {*scene, *camera, *image, *wavelengths, seed}; }

std::uint32_t Job::samples_per_pass() const {
  const std::uint32_t usual = samples_per_step(image->area());
  return renderer ? std::max(renderer->samples_per_step(usual), 1u) : usual;
}

IndexRange Job::wanted_samples() const {
  const auto samples = std::uint32_t(renderer->samples);
  if (!passes) return {0, samples};
  const std::uint64_t step = samples_per_pass(), count = (samples + step - 1) / step;
  if (passes->begin >= passes->end)
    throw Error(fmt::format("passes {}:{} are none: the second number is the first pass left out", passes->begin, passes->end));
  if (passes->end > count)
    throw Error(fmt::format("there are no passes {}:{}: {} samples per pixel are {} pass{} of {} each", passes->begin,
                            passes->end, samples, count, count == 1 ? "" : "es", step));
  return {std::uint32_t(passes->begin * step), std::uint32_t(std::min<std::uint64_t>(passes->end * step, samples))};
}

Ended Job::render() { return run(nullptr, {}); }

Ended Job::resume(const std::string& checkpoint) {
  if (!prepared_) prepare_tree(*this);
  const Checkpoint from = read_checkpoint(checkpoint);
  return run(&from, checkpoint);
}

void Job::restore(const Checkpoint& c) {
  if (renderer)
    begin_film();
  else  // the picture alone
    film_ = std::make_unique<Film>(*image, estimator_of(c.state.image));
  film_->load_state(c.state.image);
  if (process_) process_->load_state(c.state.renderer);
  done_ = c.done;
  seconds_ = c.seconds;
}

namespace {

/// Throws Error when a checkpoint is not of this job or holds too much.
void require_continuable(const Checkpoint& from, const std::string& name, const Checkpoint& job) {
  std::string reason = mismatch(from, "the checkpoint", job, "this job");
  if (reason.empty() && !from.done.empty() && from.done.back().end > job.samples_wanted)
    reason = fmt::format("it holds {} of each pixel, but only {} are wanted", samples_text(from.done), job.samples_wanted);
  if (!reason.empty()) throw Error(fmt::format("cannot continue from '{}': {}", name, reason));
}

/// Does something in which any part of the job may throw: those of plugins whatever they like.
template <class Step>
auto rendering(const Job& job, Step step) {
  try {
    return step();
  } catch (...) {
    blame(job, "rendering");
  }
}

}  // namespace

Ended Job::run(const Checkpoint* from, const std::string& from_file) {
  if (!prepared_) prepare_tree(*this);
  const RenderContext context = this->context();
  const IndexRange part = wanted_samples();
  const std::uint32_t step = samples_per_pass();
  const bool keeps = !checkpoint_file.empty();
  Checkpoint kept;
  if (keeps || from) kept = empty_checkpoint(*this);
  if (from) require_continuable(*from, from_file, kept);
  if (keeps) remove_leftovers(checkpoint_file);
  checkpoint_failure_.clear();
  // What was asked of this render is not asked of the next one.
  struct Forgotten {
    std::atomic<bool>&finish, &abort;
    ~Forgotten() { finish = abort = false; }
  } const forgotten{finish_, abort_};

  begin_film();
  film_->clear();
  rendering(*this, [&] { process_ = renderer->start(context); });
  done_.clear();
  seconds_ = 0;
  if (from) {
    restore(*from);
    kept.before_short_pass = from->before_short_pass;
    if (from->before_short_pass && part.end > done_.back().end) {
      film_->load_state(from->before_short_pass->image);
      process_->load_state(from->before_short_pass->renderer);
      drop_short_pass(done_, step);
    }
  }
  std::vector<IndexRange> all = done_;
  insert(all, part);
  const std::uint32_t wanted = count(all);

  const double pixels = double(image->area().width()) * image->area().height();
  const double begun = now() - seconds_;
  double shown = seconds_, kept_at = now(), error = 0;
  bool written = from && from_file == checkpoint_file;
  IndexRange pass;

  const auto report = [&](double in_pass, bool finished) {
    const double seconds = now() - begun;
    if (!on_progress || (!finished && seconds - shown < progress_interval)) return;
    shown = seconds;
    Progress p;
    p.samples = count(done_);
    p.samples_wanted = wanted;
    p.seconds = seconds;
    p.error = error;
    p.finished = finished;
    const double samples = p.samples + in_pass * (pass.end - pass.begin);
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
  const auto keep = [&] {
    kept.done = done_;
    kept.seconds = seconds_;
    kept.state = {film_->save_state(), process_->save_state()};
    try {
      write_checkpoint(kept, checkpoint_file);
      checkpoint_failure_.clear();
    } catch (const Error& e) {  // a full disk must not end a render that may still write its picture
      checkpoint_failure_ = e.what();
      warn(checkpoint_failure_);
    }
    kept.state = {};
    kept_at = now();
    written = true;
  };
  /// What is learned from one pass to the next cannot be had from a part of them.
  const auto require_independent_passes = [&] {
    if (missing(done_, {0, pass.begin}).empty() || !renderer->steps_depend()) return;
    renderer->fail({}, "learns from one pass to the next, so passes cannot be rendered without those before them");
  };
  /// Whether a rule other than the number of samples says stop.
  const auto stopped = [&]() -> std::optional<Ended> {
    if (error_limit > 0) error = film_->relative_error();
    if (missing(done_, part).empty()) return Ended::samples;
    if (finish_.load()) return Ended::interrupted;
    if (time_limit > 0 && seconds_ >= time_limit) return Ended::time;
    if (error_limit > 0 && error <= error_limit) return Ended::error;
    return {};
  };

  ParallelSchedule schedule(*film_, threads, abort_,
                            [&](std::uint64_t done, std::uint64_t count) { report(double(done) / double(count), false); });
  std::optional<Ended> ended;
  if (from) ended = stopped();
  while (!ended) {
    const IndexRange rest = missing(done_, part).front();
    pass = {rest.begin, std::min(rest.end, (rest.begin / step + 1) * step)};
    require_independent_passes();
    kept.before_short_pass.reset();
    if (keeps && pass.end % step != 0 && pass.end == part.end)
      kept.before_short_pass = Checkpoint::State{film_->save_state(), process_->save_state()};
    {
      // A step that is not finished leaves nothing behind, whatever ends it.
      struct Step {
        Film& film;
        ~Step() { film.drop_step(); }
      } const open{*film_};
      rendering(*this, [&] {
        process_->prepare_step(schedule, pass);
        process_->step(schedule, pass);
      });
      if (abort_.load()) return Ended::aborted;
      film_->end_step();
    }
    insert(done_, pass);
    seconds_ = now() - begun;
    written = false;
    ended = stopped();
    if (keeps && !ended && now() - kept_at >= checkpoint_interval) keep();
  }
  pass = {};
  if (keeps && !written) keep();
  report(0, true);
  return *ended;
}

Image Job::picture() const {
  Image picture = film().develop();
  for (const auto& [key, text] : metadata) picture.metadata[key] = text;
  picture.metadata["seed"] = std::to_string(seed);
  picture.metadata["samples"] = std::to_string(count(done_));
  if (renderer) {
    picture.metadata["renderer"] = renderer->class_info().name;
    if (const std::string bias = renderer->bias(); !bias.empty()) picture.metadata["bias"] = bias;
  }
  picture.metadata["version"] = ETENDUE_VERSION;
  return picture;
}

std::vector<std::string> Job::write_outputs(const std::string& default_stem) const {
  const Image radiance = picture();
  std::vector<std::string> written;
  for (const Ref<Output>& output : outputs) {
    const Ref<ToneMap>& tone = output->tone_map ? output->tone_map : (output->for_display() ? tone_map : output->tone_map);
    const std::string path = output->path(default_stem);
    output->write_image(tone ? tone->apply(radiance) : radiance, path);
    written.push_back(path);
  }
  return written;
}

std::unique_ptr<RenderProcess> Job::start_at(std::uint32_t sample) {
  if (!prepared_) prepare_tree(*this);
  const std::uint32_t step = samples_per_pass(), begin = sample / step * step;
  Film film(*image);  // what steps before leave there is not looked at
  const std::atomic<bool> never{false};
  ParallelSchedule schedule(film, threads, never);
  return rendering(*this, [&] {
    std::unique_ptr<RenderProcess> process = renderer->start(context());
    for (std::uint32_t first = renderer->steps_depend() ? 0 : begin;; first += step) {
      process->prepare_step(schedule, {first, first + step});
      if (first == begin) return process;
      process->step(schedule, {first, first + step});
    }
  });
}

Point2 Job::replay(int x, int y, std::uint32_t sample, PathRecord& record) {
  if (!prepared_) prepare_tree(*this);
  if (!image->sampled_area().contains(x, y))
    throw Error("there is no pixel " + std::to_string(x) + "," + std::to_string(y) + " in the picture");
  const std::unique_ptr<RenderProcess> process = start_at(sample);
  Arena arena;
  PathRequest request;
  request.observe.record = &record;
  const Point2 film = rendering(*this, [&] { return process->sample(x, y, sample, arena, request); }).film;
  record.count_from_world(centre_);
  return film;
}

}  // namespace etendue
