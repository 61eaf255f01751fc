// The laboratory: verify, compare and conform. Each gives the text and the JSON that the program prints; the package makes
// tables of these (etendue/_laboratory.py).

#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <atomic>

#include "binding.h"
#include "check/compare/cells.h"
#include "check/compare/laboratory.h"
#include "check/compare/tables.h"
#include "check/compare/text.h"
#include "check/conform/conformance.h"
#include "check/verify/report.h"
#include "check/verify/report_pictures.h"
#include "check/verify/text.h"
#include "files/input_files.h"
#include "files/output_files.h"
#include "files/whole_file.h"
#include "watched_work.h"

namespace etendue::python {

namespace {

/// A render that another thread may abort for as long as it is known here.
class Abortable {
 public:
  void know(Render* render) {
    const std::lock_guard lock(mutex_);
    render_ = render;
    if (render_ && asked_) render_->abort();
  }
  void abort() {
    const std::lock_guard lock(mutex_);
    asked_ = true;
    if (render_) render_->abort();
  }
  bool asked() const { return asked_; }

 private:
  std::mutex mutex_;
  Render* render_ = nullptr;
  std::atomic<bool> asked_ = false;
};

/// Refuses a report that would be written over what is read, or where nothing can be written.
void refuse_output(const std::string& report) {
  if (report.empty()) return;
  OutputFiles files;
  files.add(report, {intern("report"), 0, 0});
  files.raise();
}

/// Renderers as given in Python: texts of the language, and parts with names.
using GivenRenderers = std::vector<std::pair<std::string, Ref<Renderer>>>;

GivenRenderers given_renderers(const nb::list& given) {
  GivenRenderers all;
  for (const nb::handle pair : given) {
    const nb::handle renderer = pair[1];
    all.emplace_back(nb::cast<std::string>(pair[0]),
                     renderer.is_none() ? Ref<Renderer>() : component_as<Renderer>(renderer, "a renderer"));
  }
  return all;
}

std::vector<verify::NamedRenderer> named(const Job& job, const GivenRenderers& given) {
  std::vector<verify::NamedRenderer> all;
  for (const auto& [name, renderer] : given)
    all.push_back({name, renderer ? ref_cast<Renderer>(copy(*renderer)) : named_renderer(job, name, "renderers")});
  return all;
}

// ---- verify ----------------------------------------------------------------------------------------------------------------

struct VerifyRequest {
  Ref<Job> job;
  GivenRenderers renderers;
  bool force = false;
  verify::CollectOptions collecting;
  int lengths = 8, tile = 0, threads = 0;
  double significance = 0.01;
  std::string report, title, call;
};

struct Texts {
  std::string text, json;
};

Texts verified(const VerifyRequest& request, Abortable& abortable, WorkProgress& progress) {
  if (!request.report.empty()) note_inputs_of(*request.job);
  refuse_output(request.report);
  verify::prepare_picture(*request.job, request.lengths + 1);
  Render render(request.job, {.threads = request.threads});
  verify::Choice choice = verify::choose_renderers(*request.job, named(*request.job, request.renderers), request.force);
  verify::require_two(choice);
  if (request.lengths == 0 || !verify::without_lengths(choice).empty())
    render.edit(*render.job().image, "path_lengths", Value(Number{0}));
  verify::CollectOptions collecting = request.collecting;
  collecting.leave_out_refusing = request.renderers.empty();
  collecting.go_on = [&](size_t renderer, size_t passes) {
    const double of_renderer = collecting.seconds > 0 ? 0 : double(passes) / double(collecting.passes);
    progress.set((double(renderer) + of_renderer) / double(choice.candidates.size()), choice.candidates[renderer].name);
    return !abortable.asked();
  };
  const int tile = request.tile > 0 ? request.tile : verify::default_tile(*request.job->image);
  abortable.know(&render);
  const verify::Collected collected = verify::collect(render, choice.candidates, tile, collecting);
  abortable.know(nullptr);
  if (!collected.complete) return {};
  verify::leave_out_refused(choice, collected);
  const verify::Agreement agreement = verify::compare(collected.layout, collected.measured, request.significance);
  if (!request.report.empty()) {
    const Ref<ToneMap> tone_map = verify::display_tone_map(*request.job);
    write_whole_file(request.report,
                     verify::html_report({request.title, request.call, tone_map.get()}, choice, collected, agreement));
  }
  progress.set(1, "");
  return {verify::results_text(choice, collected, agreement), verify::results_json(choice, collected, agreement)};
}

nb::tuple verify_job(nb::handle job, const nb::list& renderers, bool force, int samples, int passes, double seconds,
                     int lengths, int tile, double significance, double inject, int threads, const std::string& report,
                     const std::string& title, const std::string& call, nb::object told) {
  VerifyRequest request;
  request.job = component_as<Job>(job, "a Job");
  request.renderers = given_renderers(renderers);
  request.force = force;
  request.collecting.passes = passes;
  request.collecting.samples = std::max(1, samples / passes);
  request.collecting.seconds = seconds;
  request.collecting.inject = inject;
  request.lengths = lengths;
  request.tile = tile;
  request.threads = threads;
  request.significance = significance;
  request.report = report;
  request.title = title;
  request.call = call;
  Abortable abortable;
  WorkProgress progress;
  Texts texts;
  do_watched([&] { texts = verified(request, abortable, progress); }, [&] { abortable.abort(); }, progress, std::move(told));
  return nb::make_tuple(texts.text, texts.json);
}

// ---- compare ---------------------------------------------------------------------------------------------------------------

class Watcher : public comparing::ComparisonWatcher {
 public:
  Watcher(Abortable& abortable, WorkProgress& progress, size_t runs)
      : abortable_(abortable), progress_(progress), runs_(runs) {}

  std::shared_ptr<void> begin(const std::string& what, Render& render) override {
    what_ = what;
    at(0);
    abortable_.know(&render);
    return {&abortable_, [](Abortable* known) { known->know(nullptr); }};
  }
  void at(double fraction) override {
    progress_.set((double(done_) + std::min(fraction, 1.0)) / double(std::max<size_t>(runs_, 1)), what_);
  }
  void end(double) override {
    ++done_;
    at(0);
  }
  void analysing() override {}
  bool go_on() override { return !abortable_.asked(); }

 private:
  Abortable& abortable_;
  WorkProgress& progress_;
  size_t runs_, done_ = 0;
  std::string what_;
};

/// Linear values of Rec. 709 or, `xyz`, of the CIE observer, shape (height, width, 3).
using Pixels = nb::ndarray<const double, nb::numpy, nb::c_contig, nb::shape<-1, -1, 3>>;

Image image_of(const Pixels& pixels, bool xyz) {
  const std::vector<std::string> channels =
      xyz ? std::vector<std::string>{"X", "Y", "Z"} : std::vector<std::string>{"R", "G", "B"};
  Image image(int(pixels.shape(1)), int(pixels.shape(0)), channels);
  image.metadata["color_space"] = xyz ? "xyz" : "rec709";
  image.values.assign(pixels.data(), pixels.data() + pixels.size());
  return image;
}

/// (name, job, reference), where the reference is a file's name, (an array, whether it is X Y Z), or None.
std::vector<comparing::ComparedScene> compared_scenes(const nb::list& scenes) {
  std::vector<comparing::ComparedScene> all;
  for (const nb::handle given : scenes) {
    const Ref<Job> job = component_as<Job>(given[1], "a Job");
    comparing::ComparedScene scene{nb::cast<std::string>(given[0]), [job] { return ref_cast<Job>(copy(*job)); }, {}};
    const nb::handle reference = given[2];
    if (nb::isinstance<nb::str>(reference))
      scene.reference_file = nb::cast<std::string>(reference);
    else if (!reference.is_none())
      scene.reference = image_of(nb::cast<Pixels>(reference[0]), nb::cast<bool>(reference[1]));
    all.push_back(std::move(scene));
  }
  return all;
}

/// (name, renderer or its expression or None, [(path, expression)]).
std::vector<comparing::Variant> compared_variants(const nb::list& variants) {
  std::vector<comparing::Variant> all;
  for (const nb::handle given : variants) {
    comparing::Variant variant{nb::cast<std::string>(given[0]), {}};
    const nb::handle renderer = given[1];
    if (nb::isinstance<nb::str>(renderer))
      variant.sets.emplace_back("renderer", nb::cast<std::string>(renderer));
    else if (!renderer.is_none())
      variant.renderer = component_as<Renderer>(renderer, "a renderer");
    for (const nb::handle set : given[2])
      variant.sets.emplace_back(nb::cast<std::string>(set[0]), nb::cast<std::string>(set[1]));
    all.push_back(std::move(variant));
  }
  return all;
}

/// What a comparison is of: the arguments of compare_jobs and missing_runs, in this order.
struct ComparisonArguments {
  const nb::list& scenes;
  const nb::list& variants;
  std::uint32_t samples;
  double seconds;
  size_t runs;
  double reference_seconds;
  int tile;
  double significance;
  int threads;
  const std::vector<std::tuple<int, int, int, int>>& insets;
  const std::string &state, &report;
};

comparing::ComparisonOptions options_of(const ComparisonArguments& given) {
  comparing::ComparisonOptions options;
  options.scenes = compared_scenes(given.scenes);
  options.variants = compared_variants(given.variants);
  options.budget = {given.samples, given.seconds};
  options.runs = given.runs;
  options.reference_seconds = given.reference_seconds;
  options.tile = given.tile;
  options.significance = given.significance;
  options.threads = given.threads;
  options.state_folder = given.state;
  options.pictures = !given.report.empty();
  for (const auto& [x, y, width, height] : given.insets) options.insets.push_back({x, y, x + width, y + height});
  return options;
}

nb::tuple compare_jobs(const nb::list& scenes, const nb::list& variants, std::uint32_t samples, double seconds, size_t runs,
                       double reference_seconds, int tile, double significance, int threads,
                       const std::vector<std::tuple<int, int, int, int>>& insets, const std::string& state,
                       const std::string& report, const std::string& call, nb::object told) {
  comparing::ComparisonOptions options = options_of(
      {scenes, variants, samples, seconds, runs, reference_seconds, tile, significance, threads, insets, state, report});
  Abortable abortable;
  WorkProgress progress;
  Texts texts;
  std::string csv;
  const auto work = [&] {
    comparing::Laboratory laboratory(std::move(options));
    refuse_output(report);
    Watcher watcher(abortable, progress, laboratory.all_runs());
    if (!laboratory.run(watcher)) return;
    const comparing::Results& results = laboratory.results();
    if (!report.empty()) write_whole_file(report, laboratory.html_report(call));
    texts = {comparing::results_text(results), comparing::results_json(results, call)};
    csv = comparing::results_csv(results);
  };
  do_watched(work, [&] { abortable.abort(); }, progress, std::move(told));
  return nb::make_tuple(texts.text, texts.json, csv);
}

/// The seed of a comparison, the number of all its runs, and those that are not in its folder: (scene, variant, run, file's
/// name).
nb::tuple missing_runs(const nb::list& scenes, const nb::list& variants, std::uint32_t samples, double seconds, size_t runs,
                       double reference_seconds, int tile, double significance, int threads,
                       const std::vector<std::tuple<int, int, int, int>>& insets, const std::string& state,
                       const std::string& report) {
  comparing::ComparisonOptions options = options_of(
      {scenes, variants, samples, seconds, runs, reference_seconds, tile, significance, threads, insets, state, report});
  std::uint64_t seed = 0;
  size_t all = 0;
  std::vector<comparing::RunKey> keys;
  WorkProgress progress;
  const auto work = [&] {
    comparing::Laboratory laboratory(std::move(options));
    refuse_output(report);
    keys = laboratory.missing_runs();
    seed = laboratory.seed();
    all = laboratory.all_runs();
  };
  do_watched(work, [] {}, progress, nb::none());
  nb::list missing;
  for (const comparing::RunKey& key : keys)
    missing.append(nb::make_tuple(key.scene, key.variant, key.run, comparing::run_file_name(key)));
  return nb::make_tuple(seed, all, missing);
}

/// A scene's runs, one at a time.
class Cells {
 public:
  Cells(const std::string& name, nb::handle job, const nb::list& variants, std::uint32_t samples, double seconds,
        double reference_seconds, int threads) {
    nb::list scenes;
    scenes.append(nb::make_tuple(name, job, nb::none()));
    comparing::CellRequest request{
        compared_scenes(scenes).front(), compared_variants(variants), {samples, seconds}, reference_seconds, threads};
    WorkProgress progress;
    do_watched([&] { renderer_ = std::make_unique<comparing::CellRenderer>(std::move(request)); }, [] {}, progress, nb::none());
  }
  nb::bytes render(std::uint64_t seed, size_t scene, size_t variant, size_t run, nb::object told) {
    Abortable abortable;
    WorkProgress progress;
    std::optional<std::string> bytes;
    const auto work = [&] {
      Watcher watcher(abortable, progress, 1);
      bytes = renderer_->render(seed, {scene, variant, run}, watcher);
    };
    do_watched(work, [&] { abortable.abort(); }, progress, std::move(told));
    if (!bytes) throw Error("the run was ended");
    return nb::bytes(bytes->data(), bytes->size());
  }

 private:
  std::unique_ptr<comparing::CellRenderer> renderer_;
};

// ---- conform ---------------------------------------------------------------------------------------------------------------

const char* name(conform::Result result) {
  switch (result) {
    case conform::Result::passed: return "passed";
    case conform::Result::failed: return "failed";
    case conform::Result::not_tried: break;
  }
  return "not tried";
}

nb::tuple conform_classes(const std::vector<std::string>& classes, const std::string& effort, int drawn, std::uint64_t seed,
                          int threads, const std::string& report, const std::string& call, nb::object told) {
  std::atomic<bool> stopped = false;
  WorkProgress progress;
  conform::Options options;
  options.classes = classes;
  options.effort = effort == "quick"      ? conform::Effort::quick
                   : effort == "thorough" ? conform::Effort::thorough
                                          : conform::Effort::standard;
  options.drawn = drawn;
  options.seed = seed;
  options.threads = threads;
  options.progress = [&](const std::string& class_name, int done, int of) { progress.set(double(done) / of, class_name); };
  options.go_on = [&] { return !stopped; };
  std::vector<conform::Outcome> outcomes;
  std::string text;
  const auto work = [&] {
    refuse_output(report);
    outcomes = conform::conform(options);
    if (stopped) return;
    text = conform::results_text(outcomes);
    if (!report.empty()) write_whole_file(report, conform::html_report(outcomes, call));
  };
  do_watched(work, [&] { stopped = true; }, progress, std::move(told));
  nb::list rows;
  for (const conform::Outcome& o : outcomes)
    rows.append(nb::make_tuple(o.class_name, o.check, o.part, o.detail, name(o.result)));
  return nb::make_tuple(text, rows);
}

}  // namespace

void bind_laboratory(nb::module_& m) {
  m.def("verify", &verify_job, nb::arg("job"), nb::arg("renderers"), nb::arg("force"), nb::arg("samples"), nb::arg("passes"),
        nb::arg("seconds"), nb::arg("lengths"), nb::arg("tile"), nb::arg("significance"), nb::arg("inject"), nb::arg("threads"),
        nb::arg("report"), nb::arg("title"), nb::arg("call"), nb::arg("progress").none(),
        "The text and the JSON of `etendue verify`. The job is changed: give a copy.");
  m.def("compare", &compare_jobs, nb::arg("scenes"), nb::arg("variants"), nb::arg("samples"), nb::arg("seconds"),
        nb::arg("runs"), nb::arg("reference_seconds"), nb::arg("tile"), nb::arg("significance"), nb::arg("threads"),
        nb::arg("insets"), nb::arg("state"), nb::arg("report"), nb::arg("call"), nb::arg("progress").none(),
        "The text, the JSON and the CSV of `etendue compare`.");
  m.def("missing_runs", &missing_runs);
  nb::class_<Cells>(m, "Cells", "Renders single runs of a comparison on a scene.")
      .def(nb::init<const std::string&, nb::handle, const nb::list&, std::uint32_t, double, double, int>())
      .def("render", &Cells::render, nb::arg("seed"), nb::arg("scene"), nb::arg("variant"), nb::arg("run"),
           nb::arg("progress").none());
  m.def("conform", &conform_classes, nb::arg("classes"), nb::arg("effort"), nb::arg("drawn"), nb::arg("seed"),
        nb::arg("threads"), nb::arg("report"), nb::arg("call"), nb::arg("progress").none(),
        "The text of `etendue conform`, and its outcomes.");
}

}  // namespace etendue::python
