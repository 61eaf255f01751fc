#include "laboratory.h"

#include <fmt/format.h>

#include <filesystem>

#include "cells.h"
#include "check/verify/collect.h"
#include "check/verify/report_pictures.h"
#include "etendue/language/language.h"
#include "files/input_files.h"
#include "files/regular_file.h"
#include "report.h"

namespace etendue::comparing {
struct Laboratory::Members {
  ComparisonOptions options;
  ComparisonIdentity identity = {};
  double run_bytes = 0;  // memory for the images of one run of each variant on each scene
  std::unique_ptr<RunStore> store = {};
  std::vector<ReferenceSource> references = {};
  std::unique_ptr<SceneSubjects> only = {};  // of a single scene, so that it is not loaded twice
  Results results = {};
  std::vector<std::string> pictures = {};  // HTML of each scene's images, for the report

  std::unique_ptr<SceneSubjects> subjects_of(size_t scene) const;
  void look_at(size_t scene);
  ReferenceSource reference_of(size_t scene, const SceneSubjects&) const;
  void open_store();
  bool is_stored(const RunKey&) const;
  std::vector<RunKey> runs_of(size_t scene) const;
  bool render(size_t scene, SceneSubjects&, ComparisonWatcher&);
  void analyse(size_t scene, const SceneSubjects&);
};

std::unique_ptr<SceneSubjects> Laboratory::Members::subjects_of(size_t scene) const {
  return std::make_unique<SceneSubjects>(options.scenes[scene].load, options.variants, options.threads);
}

void Laboratory::Members::look_at(size_t scene) {
  const std::string& name = options.scenes[scene].name;
  std::unique_ptr<SceneSubjects> subjects = subjects_of(scene);
  const PixelArea& area = subjects->job().image->area();
  for (size_t v = 0; v < options.variants.size(); ++v) {
    note_inputs_of(subjects->ready(v).job());
    identity.parts.push_back({name, options.variants[v].name, subjects->identity(v)});
    run_bytes += 12.0 * area.width() * area.height();
  }
  identity.seed = subjects->job().seed;
  for (const PixelArea& inset : options.insets)
    if (inset.x1 > area.width() || inset.y1 > area.height())
      throw Error(fmt::format("the inset reaches beyond the {} x {} pixels of '{}'", area.width(), area.height(), name),
                  {intern("--inset"), 0, 0});
  references.push_back(reference_of(scene, *subjects));
  if (options.scenes.size() == 1) only = std::move(subjects);
}

ReferenceSource Laboratory::Members::reference_of(size_t scene, const SceneSubjects& subjects) const {
  const ComparedScene& compared = options.scenes[scene];
  const PixelArea& area = subjects.job().image->area();
  ReferenceSource source;
  if (!compared.reference_file.empty()) {
    source.picture = read_reference(compared.reference_file, area.width(), area.height());
    source.text = fmt::format("'{}', taken as exact", compared.reference_file);
  } else if (compared.reference) {
    source.picture = reference_from(*compared.reference, "the reference", area.width(), area.height());
    source.text = "a given picture, taken as exact";
  } else if (options.reference_seconds > 0) {
    source.variant = options.variants.size();
    source.runs = reference_runs;
    const std::optional<size_t> by = reference_variant(subjects);
    if (!by)
      throw Error(fmt::format("{}: no variant is unbiased and finds all light of the scene, so none can render a reference",
                              compared.name),
                  {intern("--reference-time"), 0, 0});
    source.text = fmt::format("{} separate runs of {}, {:.4g} s of CPU time together", reference_runs,
                              options.variants[*by].name, options.reference_seconds);
  } else if (!reference_variant(subjects)) {
    throw Error(
        fmt::format("{}: every variant is biased or misses light of the scene, so their mean is no reference; give "
                    "--reference, or add a variant that finds all light",
                    compared.name));
  }
  return source;
}

void Laboratory::Members::open_store() {
  if (!options.state_folder.empty()) {
    store = std::make_unique<RunStore>(options.state_folder, identity);
    return;
  }
  constexpr double usual_marks = 16;
  require_memory(run_bytes * usual_marks * double(options.runs),
                 "a comparison without --state or --report, which keeps its runs,");
  store = std::make_unique<RunStore>();
}

/// A run for the reference is of use only if it had its time.
bool Laboratory::Members::is_stored(const RunKey& key) const {
  if (!store->has(key)) return false;
  return key.variant < options.variants.size() ||
         store->run(key).marks.back().seconds >= options.reference_seconds / double(reference_runs);
}

/// All runs of a scene, in order. Variants take turns, so that other load of the machine affects all of them alike.
std::vector<RunKey> Laboratory::Members::runs_of(size_t scene) const {
  std::vector<RunKey> keys;
  if (references[scene].variant)
    for (size_t run = 0; run < reference_runs; ++run) keys.push_back({scene, options.variants.size(), run});
  for (size_t run = 0; run < options.runs; ++run)
    for (size_t v = 0; v < options.variants.size(); ++v) keys.push_back({scene, v, run});
  return keys;
}

/// Renders the scene's runs that are not stored. Returns false if the watcher ends it.
bool Laboratory::Members::render(size_t scene, SceneSubjects& subjects, ComparisonWatcher& watcher) {
  const CellRequest request{options.scenes[scene], options.variants, options.budget, options.reference_seconds,
                            options.threads};
  for (const RunKey& key : runs_of(scene)) {
    if (is_stored(key)) {
      watcher.end(store->run(key).wall_seconds);
      continue;
    }
    const auto keep = [&](RunResult result) {
      const double seconds = result.run.wall_seconds;
      store->keep(key, std::move(result));
      watcher.end(seconds);
    };
    if (!render_cell(request, subjects, identity.seed, key, watcher, keep) || !watcher.go_on()) return false;
  }
  return true;
}

void Laboratory::Members::analyse(size_t scene, const SceneSubjects& subjects) {
  const ImageBuffer& image = *subjects.job().image;
  SceneRuns runs;
  runs.scene = scene;
  runs.file = options.scenes[scene].name;
  runs.width = image.area().width();
  runs.height = image.area().height();
  runs.tile = options.tile > 0 ? options.tile : verify::default_tile(image);
  runs.subjects = subjects.subjects();
  runs.runs = options.runs;
  runs.budget = options.budget;
  runs.reference = references[scene];
  const double tests = double(options.scenes.size() * options.variants.size());
  SceneImages images;
  results.scenes.push_back(
      comparing::analyse(*store, runs, options.significance / tests, options.pictures ? &images : nullptr));
  if (!options.pictures) return;
  const Ref<ToneMap> tone_map = verify::display_tone_map(subjects.job());
  pictures.push_back(scene_pictures(results.scenes.back(), images, *tone_map, options.insets));
}

Laboratory::Laboratory(ComparisonOptions options) : members_(new Members{std::move(options)}) {
  std::vector<Error> errors;
  for (size_t scene = 0; scene < members_->options.scenes.size(); ++scene) {
    try {
      members_->look_at(scene);
    } catch (const Errors& several) {
      errors.insert(errors.end(), several.errors.begin(), several.errors.end());
    } catch (const Error& error) {
      errors.push_back(error);
    }
  }
  if (!errors.empty()) throw Errors(std::move(errors));
  members_->identity.budget = members_->options.budget;
  members_->results.significance = members_->options.significance;
}

Laboratory::~Laboratory() = default;

std::uint64_t Laboratory::seed() const { return members_->identity.seed; }

std::vector<RunKey> Laboratory::missing_runs() {
  members_->open_store();
  std::vector<RunKey> missing;
  for (size_t scene = 0; scene < members_->options.scenes.size(); ++scene)
    for (const RunKey& key : members_->runs_of(scene))
      if (!members_->is_stored(key)) missing.push_back(key);
  return missing;
}

size_t Laboratory::all_runs() const {
  const ComparisonOptions& options = members_->options;
  size_t runs = options.scenes.size() * options.variants.size() * options.runs;
  for (const ReferenceSource& reference : members_->references)
    if (reference.variant) runs += reference_runs;
  return runs;
}

size_t Laboratory::stored_runs() const { return members_->store ? members_->store->count() : 0; }

const Results& Laboratory::results() const { return members_->results; }

bool Laboratory::run(ComparisonWatcher& watcher) {
  Members& m = *members_;
  m.open_store();
  for (size_t scene = 0; scene < m.options.scenes.size(); ++scene) {
    const std::unique_ptr<SceneSubjects> subjects = m.only ? std::move(m.only) : m.subjects_of(scene);
    if (!m.render(scene, *subjects, watcher)) return false;
    watcher.analysing();
    m.analyse(scene, *subjects);
  }
  judge(m.results);
  return true;
}

std::string Laboratory::html_report(const std::string& command_line) const {
  return comparing::html_report(members_->results, members_->pictures, command_line);
}

}  // namespace etendue::comparing
