// etendue compare FILE…: measures which renderer has the smaller error at equal time or samples.

#include <fmt/format.h>

#include "app/interruption.h"
#include "app/text.h"
#include "check/compare/report.h"
#include "check/compare/tables.h"
#include "check/verify/collect.h"
#include "compare_options.h"
#include "compare_progress.h"
#include "compare_text.h"
#include "display_tone_map.h"
#include "etendue/language/language.h"
#include "files/input_files.h"
#include "files/output_files.h"
#include "files/regular_file.h"
#include "files/whole_file.h"

namespace etendue {

using namespace comparing;

namespace {

constexpr size_t reference_runs = 8;

class Laboratory {
 public:
  explicit Laboratory(const CompareOptions& options)
      : options_(options),
        budget_(options.budget()),
        reference_seconds_(options.reference_seconds()),
        variants_(options.variants()),
        insets_(options.insets()),
        runs_(size_t(options.runs)) {}

  int run();

 private:
  std::function<Ref<Job>()> loader(size_t scene) const {
    return [this, scene] { return options_.load(options_.files[scene]); };
  }
  void look_at_all();
  void refuse_outputs() const;
  void open_store();
  bool render(size_t scene, SceneSubjects&);
  bool render_one(const RunKey&, SceneSubjects&, size_t subject, const Budget&);
  std::optional<size_t> reference_variant(const SceneSubjects&) const;
  void analyse(size_t scene, const SceneSubjects&);
  void write() const;

  const CompareOptions& options_;
  const Budget budget_;
  const double reference_seconds_;
  const std::vector<Variant> variants_;
  const std::vector<PixelArea> insets_;
  const size_t runs_;
  ComparisonIdentity identity_;
  double run_bytes_ = 0;  // memory for the images of one run of each variant on each scene
  std::unique_ptr<RunStore> store_;
  std::unique_ptr<CompareProgress> progress_;
  std::vector<ReferenceSource> references_;
  std::unique_ptr<SceneSubjects> only_;  // of a single scene, so that it is not loaded twice
  Results results_;
  std::vector<std::string> pictures_;  // HTML of each scene's images, for the report
};

std::optional<size_t> Laboratory::reference_variant(const SceneSubjects& subjects) const {
  for (size_t v = 0; v < subjects.subjects().size(); ++v)
    if (subjects.subjects()[v].reaches_truth()) return v;
  return {};
}

/// Loads all scenes and finds their references, so that errors are thrown before anything is rendered.
void Laboratory::look_at_all() {
  std::vector<Error> errors;
  for (size_t scene = 0; scene < options_.files.size(); ++scene) {
    try {
      auto subjects = std::make_unique<SceneSubjects>(loader(scene), variants_, options_.threads);
      const PixelArea& area = subjects->job().image->area();
      for (size_t v = 0; v < variants_.size(); ++v) {
        note_inputs_of(subjects->ready(v).job());
        identity_.parts.push_back({options_.files[scene], variants_[v].name, subjects->identity(v)});
        run_bytes_ += 12.0 * area.width() * area.height();
      }
      identity_.seed = subjects->job().seed;
      for (const PixelArea& inset : insets_)
        if (inset.x1 > area.width() || inset.y1 > area.height())
          throw Error(fmt::format("the inset reaches beyond the {} x {} pixels of '{}'", area.width(), area.height(),
                                  options_.files[scene]),
                      {intern("--inset"), 0, 0});
      ReferenceSource source;
      if (!options_.references.empty()) {
        source.picture = read_reference(options_.references[scene], area.width(), area.height());
        source.text = fmt::format("'{}', taken as exact", options_.references[scene]);
      } else if (reference_seconds_ > 0) {
        source.variant = variants_.size();
        source.runs = reference_runs;
        const std::optional<size_t> by = reference_variant(*subjects);
        if (!by)
          throw Error(fmt::format("{}: no variant is unbiased and finds all light of the scene, so none can render a reference",
                                  options_.files[scene]),
                      {intern("--reference-time"), 0, 0});
        source.text = fmt::format("{} separate runs of {}, {:.4g} s of CPU time together", reference_runs, variants_[*by].name,
                                  reference_seconds_);
      } else if (!reference_variant(*subjects)) {
        throw Error(
            fmt::format("{}: every variant is biased or misses light of the scene, so their mean is no reference; give "
                        "--reference, or add a variant that finds all light",
                        options_.files[scene]));
      }
      references_.push_back(std::move(source));
      if (options_.files.size() == 1) only_ = std::move(subjects);
    } catch (const Errors& several) {
      errors.insert(errors.end(), several.errors.begin(), several.errors.end());
    } catch (const Error& error) {
      errors.push_back(error);
    }
  }
  if (!errors.empty()) throw Errors(std::move(errors));
  identity_.budget = budget_;
}

void Laboratory::refuse_outputs() const {
  OutputFiles files;
  for (const auto& [option, path] :
       {std::pair("--report", &options_.report), std::pair("--csv", &options_.csv), std::pair("--json", &options_.json)})
    if (!path->empty()) files.add(*path, {intern(option), 0, 0});
  files.raise();
}

void Laboratory::open_store() {
  const std::string folder = options_.state_folder();
  if (!folder.empty()) {
    store_ = std::make_unique<RunStore>(folder, identity_);
    return;
  }
  constexpr double usual_marks = 16;
  require_memory(run_bytes_ * usual_marks * double(runs_), "a comparison without --state or --report, which keeps its runs,");
  store_ = std::make_unique<RunStore>();
}

/// Renders one run unless it is stored. Returns false when interrupted.
bool Laboratory::render_one(const RunKey& key, SceneSubjects& subjects, size_t subject, const Budget& budget) {
  const bool for_reference = key.variant == variants_.size();
  if (store_->has(key) && !(for_reference && store_->run(key).marks.back().seconds < budget.seconds)) {
    progress_->done(store_->run(key).wall_seconds);
    return true;
  }
  Render& render = subjects.ready(subject);
  const Interruption interruption(render);
  progress_->begin(fmt::format("{}: {} run {}", stem_of(options_.files[key.scene]),
                               for_reference ? "reference," : variants_[subject].name + ",", key.run + 1));
  const double began = processor_seconds();
  std::optional<RunResult> result = render_run(render, seed_of(identity_.seed, key), budget, [&] {
    const double part = budget.seconds > 0 ? (processor_seconds() - began) / budget.seconds
                                           : double(render.progress().samples) / double(budget.samples);
    progress_->at(part);
    return !Interruption::asked();
  });
  if (!result) return false;
  if (for_reference) {  // only the final image is used
    result->run.marks.erase(result->run.marks.begin(), result->run.marks.end() - 1);
    result->pictures.erase(result->pictures.begin(), result->pictures.end() - 1);
  }
  progress_->done(result->run.wall_seconds);
  store_->keep(key, std::move(*result));
  return !Interruption::asked();
}

bool Laboratory::render(size_t scene, SceneSubjects& subjects) {
  if (references_[scene].variant)
    for (size_t run = 0; run < reference_runs; ++run)
      if (!render_one({scene, variants_.size(), run}, subjects, *reference_variant(subjects),
                      {0, reference_seconds_ / double(reference_runs)}))
        return false;
  // Variants take turns, so that other load of the machine affects all of them alike.
  for (size_t run = 0; run < runs_; ++run)
    for (size_t v = 0; v < variants_.size(); ++v)
      if (!render_one({scene, v, run}, subjects, v, budget_)) return false;
  return true;
}

void Laboratory::analyse(size_t scene, const SceneSubjects& subjects) {
  const ImageBuffer& image = *subjects.job().image;
  SceneRuns runs;
  runs.scene = scene;
  runs.file = options_.files[scene];
  runs.width = image.area().width();
  runs.height = image.area().height();
  runs.tile = options_.tile > 0 ? options_.tile : verify::default_tile(image);
  runs.subjects = subjects.subjects();
  runs.runs = runs_;
  runs.budget = budget_;
  runs.reference = references_[scene];
  const double tests = double(options_.files.size() * variants_.size());
  const bool drawn = !options_.report.empty();
  SceneImages images;
  results_.scenes.push_back(comparing::analyse(*store_, runs, options_.significance / tests, drawn ? &images : nullptr));
  if (!drawn) return;
  const Ref<ToneMap> tone_map = display_tone_map(subjects.job());
  pictures_.push_back(scene_pictures(results_.scenes.back(), images, *tone_map, insets_));
}

void Laboratory::write() const {
  const std::string command = options_.command_line();
  if (!options_.report.empty()) write_whole_file(options_.report, html_report(results_, pictures_, command));
  if (!options_.csv.empty()) write_whole_file(options_.csv, results_csv(results_));
  if (!options_.json.empty()) write_whole_file(options_.json, results_json(results_, command));
  if (!options_.quiet) fmt::print("{}", compare_text(results_));
}

int Laboratory::run() {
  look_at_all();
  refuse_outputs();
  open_store();
  results_.significance = options_.significance;
  size_t all_runs = options_.files.size() * variants_.size() * runs_;
  if (reference_seconds_ > 0) all_runs += options_.files.size() * reference_runs;
  progress_ = std::make_unique<CompareProgress>(ProgressDisplay::kind_for("auto", options_.quiet), all_runs);
  for (size_t scene = 0; scene < options_.files.size(); ++scene) {
    std::unique_ptr<SceneSubjects> subjects = std::move(only_);
    if (!subjects) subjects = std::make_unique<SceneSubjects>(loader(scene), variants_, options_.threads);
    if (!render(scene, *subjects)) {
      progress_->clear();
      const std::string folder = options_.state_folder();
      fmt::print(stderr, "{}\n",
                 folder.empty() ? std::string("interrupted: no runs were stored, as there is no --state or --report")
                                : fmt::format("interrupted: {} of {} runs are stored in '{}'; the same command resumes",
                                              store_->count(), all_runs, folder));
      return exit_status::interrupted;
    }
    progress_->clear();
    analyse(scene, *subjects);
  }
  judge(results_);
  write();
  return exit_status::done;
}

}  // namespace

void add_compare_command(Command& program) {
  Command command = program.add_command("compare", "Measure which algorithm is better on a scene, at equal time and samples");
  auto options = std::make_shared<CompareOptions>();
  options->add_to(command);
  command.footer(
      "\nExamples\n"
      "  etendue compare box.etd --renderers PathTracer,BidirectionalPathTracer --time 1m --report box.html\n"
      "  etendue compare box.etd --variant 'as it is:' --variant 'short: renderer.max_depth=4' --samples 256\n"
      "  etendue compare a.etd b.etd --renderers 'PathTracer,PathTracer{next_event: false}' --samples 64 --csv errors.csv\n"
      "  etendue compare box.etd --renderers LightTracer,PathTracer --time 30s --reference box-converged.exr\n"
      "\nEvery variant makes independent runs; their errors are compared at equal CPU time and at equal samples, with\n"
      "confidence bands, and bias and variance separately. The first Ctrl-C keeps finished runs. See docs/compare.md.");
  command.runs([options] { return Laboratory(*options).run(); });
}

}  // namespace etendue
