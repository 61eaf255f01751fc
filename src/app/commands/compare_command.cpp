// etendue compare FILE…: measures which renderer has the smaller error at equal time or samples.

#include <fmt/format.h>

#include "app/interruption.h"
#include "check/compare/laboratory.h"
#include "check/compare/tables.h"
#include "check/compare/text.h"
#include "compare_options.h"
#include "compare_progress.h"
#include "files/output_files.h"
#include "files/whole_file.h"

namespace etendue {

using namespace comparing;

namespace {

/// Shows the progress, and ends the comparison at Ctrl-C.
class Watcher : public ComparisonWatcher {
 public:
  Watcher(ProgressDisplay::Kind kind, size_t runs) : progress_(kind, runs) {}

  std::shared_ptr<void> begin(const std::string& what, Render& render) override {
    progress_.begin(what);
    return std::make_shared<Interruption>(render);
  }
  void at(double fraction) override { progress_.at(fraction); }
  void end(double seconds) override { progress_.done(seconds); }
  void analysing() override { progress_.clear(); }
  bool go_on() override { return !Interruption::asked(); }

 private:
  CompareProgress progress_;
};

ComparisonOptions comparison(const CompareOptions& options) {
  ComparisonOptions comparison;
  comparison.budget = options.budget();
  comparison.reference_seconds = options.reference_seconds();
  comparison.variants = options.variants();
  comparison.insets = options.insets();
  comparison.runs = size_t(options.runs);
  comparison.tile = options.tile;
  comparison.significance = options.significance;
  comparison.threads = options.threads;
  comparison.state_folder = options.state_folder();
  comparison.pictures = !options.report.empty();
  for (size_t i = 0; i < options.files.size(); ++i) {
    const std::string& file = options.files[i];
    comparison.scenes.push_back({file, [&] { return options.load(file); }, {}});
    if (!options.references.empty()) comparison.scenes.back().reference_file = options.references[i];
  }
  return comparison;
}

void refuse_outputs(const CompareOptions& options) {
  OutputFiles files;
  for (const auto& [option, path] :
       {std::pair("--report", &options.report), std::pair("--csv", &options.csv), std::pair("--json", &options.json)})
    if (!path->empty()) files.add(*path, {intern(option), 0, 0});
  files.raise();
}

int run_compare(const CompareOptions& options) {
  Laboratory laboratory(comparison(options));
  refuse_outputs(options);
  bool complete = false;
  {
    Watcher watcher(ProgressDisplay::kind_for("auto", options.quiet), laboratory.all_runs());
    complete = laboratory.run(watcher);
  }
  if (!complete) {
    const std::string folder = options.state_folder();
    fmt::print(stderr, "{}\n",
               folder.empty() ? std::string("interrupted: no runs were stored, as there is no --state or --report")
                              : fmt::format("interrupted: {} of {} runs are stored in '{}'; the same command resumes",
                                            laboratory.stored_runs(), laboratory.all_runs(), folder));
    return exit_status::interrupted;
  }
  const std::string command = options.command_line();
  if (!options.report.empty()) write_whole_file(options.report, laboratory.html_report(command));
  if (!options.csv.empty()) write_whole_file(options.csv, results_csv(laboratory.results()));
  if (!options.json.empty()) write_whole_file(options.json, results_json(laboratory.results(), command));
  if (!options.quiet) fmt::print("{}", results_text(laboratory.results()));
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
  command.runs([options] { return run_compare(*options); });
}

}  // namespace etendue
