// Renders: the functions of the class Render of the package (etendue/_render.py), and denoising.

#include <fmt/format.h>

#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <filesystem>
#include <set>
#include <sstream>

#include "check/warnings/advice.h"
#include "check/warnings/scene_warnings.h"
#include "etendue/denoised_output.h"
#include "etendue/describe/reflection.h"
#include "etendue/language/language.h"
#include "files/output_files.h"
#include "live_render.h"
#include "paths.h"
#include "picture.h"
#include "render/checkpoint.h"
#include "render/denoising.h"
#include "render/file_hash.h"
#include "render/team/message_library.h"
#include "shaped_arrays.h"

namespace etendue::python {

namespace {

nb::object name_of(std::optional<Ended> ended) {
  if (!ended) return nb::none();
  switch (*ended) {
    case Ended::samples: return nb::str("samples");
    case Ended::time: return nb::str("time");
    case Ended::error: return nb::str("error");
    case Ended::interrupted: return nb::str("interrupted");
    case Ended::aborted: return nb::str("aborted");
  }
  return nb::none();
}

nb::dict progress_dict(const Progress& p) {
  nb::dict d;
  d["samples"] = p.samples;
  d["samples_wanted"] = p.samples_wanted;
  d["fraction"] = p.fraction;
  d["seconds"] = p.seconds;
  d["seconds_left"] = p.seconds_left < 0 ? nb::none() : nb::object(nb::float_(p.seconds_left));
  d["samples_per_second"] = p.samples_per_second;
  d["error"] = p.error > 0 ? nb::object(nb::float_(p.error)) : nb::none();
  d["finished"] = p.finished;
  return d;
}

// ---- making, running -------------------------------------------------------------------------------------------------------

void make_render(LiveRender* self, nb::handle job, int threads, const std::optional<std::string>& checkpoint,
                 std::optional<double> checkpoint_interval, std::optional<std::pair<std::uint32_t, std::uint32_t>> steps) {
  RenderSettings settings;
  settings.threads = threads;
  if (checkpoint) settings.checkpoint_file = *checkpoint;
  if (checkpoint_interval) settings.checkpoint_interval = *checkpoint_interval;
  if (steps) settings.steps = IndexRange{steps->first, steps->second};
  const Ref<Job> rendered = component_as<Job>(job, "a Job");
  const std::string file = rendered->location_of().file;
  std::error_code ignored;
  if (std::filesystem::is_regular_file(file, ignored)) rendered->metadata.try_emplace("file", file);
  new (self) LiveRender(rendered, settings);
}

nb::object run(LiveRender& live, const nb::callable& wake) {
  Ended ended{};
  live.run([&](Render& render) { ended = render.run(); }, wake);
  return name_of(ended);
}

nb::object step(LiveRender& live, const nb::callable& wake) {
  std::optional<Ended> ended;
  live.run([&](Render& render) { ended = render.step(); }, wake);
  return name_of(ended);
}

/// Calls a function with the render, without the interpreter's lock.
template <class F>
auto with(LiveRender& live, F&& work) {
  const LiveRender::Use use(live);
  return released([&] { return work(*use); });
}

nb::tuple snapshot(LiveRender& live) {
  std::optional<Image> image;
  Progress progress;
  with(live, [&](Render& render) {
    const RenderSnapshot now = render.snapshot();
    image = now.picture();
    progress = now.progress;
  });
  return nb::make_tuple(Picture(std::move(*image)), progress_dict(progress));
}

/// Warns of what the program warns of before it renders, and of light that the renderer cannot find.
void warn_of_scene(LiveRender& live) {
  live.unedited([](Render& render) {
    show_warnings(scene_warnings(render.job()));
    advise(render.job());
  });
}

/// Warns of a picture that is black, and, with the job's outputs, of one that they show as black or white.
void warn_of_picture(LiveRender& live, bool with_outputs) {
  live.unedited([&](Render& render) {
    const std::vector<Ref<Output>> none;
    show_warnings(picture_warnings(render.job(), with_outputs ? render.job().outputs : none, render.picture()));
  });
}

/// The files name, in their metadata, the files that the picture was made of, and the description of the job as it is.
std::vector<std::string> write_outputs(LiveRender& live, const std::string& stem) {
  const Ref<Job>& job = live.job();
  return live.unedited([&](Render& render) {
    const std::string file = job->location_of().file;
    std::error_code ignored;
    std::set<std::string> read;
    if (std::filesystem::is_regular_file(file, ignored)) read.insert(std::filesystem::absolute(file).string());
    const std::string description = write_description(*job, false, "");
    job->metadata["file_hash"] = file_hash(*job, read, {&description, 1});
    return render.write_outputs(stem);
  });
}

// ---- editing, state --------------------------------------------------------------------------------------------------------

void edit(LiveRender& live, const nb::list& given) {
  const Location at = calling_line();
  std::vector<LiveRender::Change> changes;
  for (const nb::handle entry : given) {
    const Ref<Component> part = component_of(entry[0]);
    const auto name = nb::cast<std::string>(entry[1]);
    const Member* member = part->class_info().find(name);
    if (!member) get(*part, name);  // throws Error with the list of members
    for (Given& g : given_values(*part, *member, entry[2], at)) changes.push_back({part, g.member, std::move(g.value)});
  }
  live.edit(changes);
}

nb::bytes save_bytes(LiveRender& live) {
  const std::string bytes = live.unedited([](Render& render) {
    std::ostringstream to;
    render.save(to);
    return std::move(to).str();
  });
  return nb::bytes(bytes.data(), bytes.size());
}

void load_bytes(LiveRender& live, const nb::bytes& bytes) {
  std::istringstream from(std::string(bytes.c_str(), bytes.size()));
  live.unedited([&](Render& render) { render.load(from); });
}

void add_bytes(LiveRender& live, const nb::bytes& bytes) {
  std::istringstream from(std::string(bytes.c_str(), bytes.size()));
  live.unedited([&](Render& render) { render.add(from); });
}

// ---- results ---------------------------------------------------------------------------------------------------------------

nb::dict replay(LiveRender& live, int x, int y, std::uint32_t sample) {
  PathRecord record;
  Point2 film;
  live.unedited([&](Render& render) { film = render.replay(x, y, sample, record); });
  return path_dict(record, film);
}

nb::list samples_done(LiveRender& live) {
  const LiveRender::Use use(live);
  nb::list ranges;
  for (const IndexRange& range : use->samples_done()) ranges.append(nb::make_tuple(range.begin, range.end));
  return ranges;
}

nb::tuple bad_samples(LiveRender& live) {
  const LiveRender::Use use(live);
  nb::list first;
  const std::vector<BadSample> bad = released([&] { return use->film().first_bad_samples(); });
  for (const BadSample& b : bad) {
    const char* kinds[] = {"not a number", "infinite", "negative"};
    first.append(nb::make_tuple(b.x, b.y, b.sample, kinds[size_t(b.kind)]));
  }
  return nb::make_tuple(use->film().bad_samples(), use->film().samples(), first);
}

/// Refuses outputs that cannot be written, or would overwrite what the job reads, before anything is rendered.
void require_outputs(nb::handle job_object, const std::string& stem) {
  const Ref<Job> job = component_as<Job>(job_object, "a Job");
  const Location at = calling_line();
  released([&] {
    note_inputs_of(*job);
    OutputFiles files;
    for (const Ref<Output>& output : job->outputs) {
      if (!output) continue;  // preparing reports it
      const Location written = output->location_of("file");
      files.add(output->path(stem), written.known() ? written : at);
    }
    for (const std::string& path : denoised_paths(job->outputs, stem)) files.add(path, at);
    files.raise();
    require_denoisers(job->outputs);
  });
}

// ---- denoising -------------------------------------------------------------------------------------------------------------

/// A prepared copy of a denoiser; None: of the one that outputs have by default.
Ref<Denoiser> prepared_denoiser(nb::handle part, bool guided) {
  const Ref<Denoiser> given = part.is_none() ? make<DenoisedOutput>()->denoiser : component_as<Denoiser>(part, "a denoiser");
  const Ref<Denoiser> denoiser = ref_cast<Denoiser>(copy(*given));
  if (!guided) denoiser->guide_samples = 0;
  use_threads();
  released([&] {
    prepare_tree(*denoiser);
    denoiser->require();
  });
  return denoiser;
}

Picture denoise(const Picture& picture, nb::handle part, int threads) {
  const Ref<Denoiser> denoiser = prepared_denoiser(part, false);
  const Ref<Job> none = make<Job>();  // without guides nothing of the job is used
  return Picture(released([&] { return denoised(*denoiser, *none, *picture.image, threads); }));
}

Picture denoise_guided(LiveRender& live, const Picture& picture, nb::handle part, int threads) {
  const Ref<Denoiser> denoiser = prepared_denoiser(part, true);
  return Picture(live.unedited([&](Render& render) {
    const PixelArea& area = render.job().image->area();
    if (picture.image->width != area.width() || picture.image->height != area.height())
      throw Error(fmt::format("the picture has {} x {} pixels, but the job's have {} x {}: the guides would not fit",
                              picture.image->width, picture.image->height, area.width(), area.height()));
    return denoised(*denoiser, render.job(), *picture.image, threads);
  }));
}

/// A checkpoint of a job that holds no samples, and names no size of a step: what determines its samples, with the contents of
/// its files.
Checkpoint bare_checkpoint(const Job& job) {
  if (!job.renderer || !job.image) throw Error("the job has no renderer or no image");
  return empty_checkpoint(job, identity_of(job), 1);
}

nb::bytes identity_bytes(nb::handle object) {
  const Ref<Job> job = component_as<Job>(object, "a Job");
  const std::string bytes = reading(*job, [&] {
    std::ostringstream to;
    write_checkpoint(bare_checkpoint(*job), to);
    return std::move(to).str();
  });
  return nb::bytes(bytes.data(), bytes.size());
}

/// Why samples of a job must not be added to those of the job that `identity_bytes` was taken of; empty: they may.
std::string identity_mismatch(nb::handle object, const std::string& whose, const nb::bytes& identity,
                              const std::string& other) {
  const Ref<Job> job = component_as<Job>(object, "a Job");
  std::istringstream from(std::string(identity.c_str(), identity.size()));
  return reading(*job, [&] { return mismatch(bare_checkpoint(*job), whose, read_checkpoint(from), other); });
}

/// A job of the same parts, whose members can be set without changing the other.
nb::object shallow_copy(nb::handle object) {
  const Ref<Component> from = component_of(object);
  const Ref<Component> to = from->class_info().create();
  for (const Member& member : from->class_info().members) set(*to, member.name, member.get(*from, member));
  if (from->origin) to->origin = std::make_unique<Component::Origin>(*from->origin);
  if (const Ref<Job> job = ref_cast<Job>(from)) ref_cast<Job>(to)->metadata = job->metadata;
  return wrap(to);
}

void bind_live_render(nb::module_& m) {
  using namespace nb::literals;
  nb::class_<LiveRender>(m, "Render", "A render of the library; etendue.Render is the comfortable one.")
      .def("__init__", &make_render, "job"_a, "threads"_a, "checkpoint"_a.none(), "checkpoint_interval"_a.none(),
           "steps"_a.none())
      .def("run", &run)
      .def("step", &step)
      .def("stop", [](LiveRender& live) { LiveRender::Use(live)->stop(); })
      .def("abort", [](LiveRender& live) { LiveRender::Use(live)->abort(); })
      .def("close", &LiveRender::close)
      .def_prop_ro("closed", &LiveRender::closed)
      .def(
          "restart",
          [](LiveRender& live, std::optional<std::uint64_t> seed) {
            live.unedited([&](Render& render) { render.restart(seed); });
          },
          "seed"_a.none())
      .def("progress", [](LiveRender& live) { return progress_dict(with(live, [](Render& r) { return r.progress(); })); })
      .def("take_progress",
           [](LiveRender& live) -> nb::object {
             const std::optional<Progress> p = live.take_progress();
             if (!p) return nb::none();
             return progress_dict(*p);
           })
      .def("snapshot", &snapshot)
      .def("edit", &edit)
      .def("save_bytes", &save_bytes)
      .def("save_file",
           [](LiveRender& live, const std::string& file) { live.unedited([&](Render& render) { render.save(file); }); })
      .def("load_bytes", &load_bytes)
      .def("load_file",
           [](LiveRender& live, const std::string& file) { live.unedited([&](Render& render) { render.load(file); }); })
      .def("add_bytes", &add_bytes)
      .def("select_steps",
           [](LiveRender& live, std::uint32_t begin, std::uint32_t end) {
             with(live, [&](Render& render) { render.select_steps(IndexRange{begin, end}); });
           })
      .def("steps_depend",
           [](LiveRender& live) { return with(live, [](Render& r) { return r.job().renderer->steps_depend(); }); })
      .def("replay", &replay)
      .def("samples_done", &samples_done)
      .def("samples_per_step", [](LiveRender& live) { return with(live, [](Render& r) { return r.samples_per_step(); }); })
      .def("relative_error", [](LiveRender& live) { return with(live, [](Render& r) { return r.film().relative_error(); }); })
      .def("bad_samples", &bad_samples)
      .def("checkpoint_failure", [](LiveRender& live) { return LiveRender::Use(live)->checkpoint_failure(); })
      .def("write_outputs", &write_outputs)
      .def("warn_of_scene", &warn_of_scene)
      .def("warn_of_picture", &warn_of_picture)
      .def("denoise", &denoise_guided, "picture"_a, "denoiser"_a.none(), "threads"_a);
}

}  // namespace

void bind_render(nb::module_& m) {
  using namespace nb::literals;
  bind_live_render(m);
  m.def("require_outputs", &require_outputs);
  m.def("denoise", &denoise, "picture"_a, "denoiser"_a.none(), "threads"_a);
  m.def("identity_bytes", &identity_bytes);
  m.def("identity_mismatch", &identity_mismatch, "job"_a, "whose"_a, "identity"_a, "other"_a);
  m.def("shallow_copy", &shallow_copy);
  m.def("has_member",
        [](nb::handle part, const std::string& name) { return component_of(part)->class_info().find(name) != nullptr; });
  m.def("file_of", [](nb::handle part) { return std::string(component_of(part)->location_of().file); });
  m.def("processes_started", &processes_started);
  m.def("leave_all_renders", &leave_all_renders);
  m.def(
      "fail", [](const std::string& message) { throw Error(message, calling_line()); },
      "Raises Error at the line that called the package.");
}

}  // namespace etendue::python
