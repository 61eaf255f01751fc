#include "cells.h"

#include <fmt/format.h>

#include <filesystem>

namespace etendue::comparing {

std::optional<size_t> reference_variant(const SceneSubjects& subjects) {
  for (size_t v = 0; v < subjects.subjects().size(); ++v)
    if (subjects.subjects()[v].reaches_truth()) return v;
  return {};
}

bool render_cell(const CellRequest& request, SceneSubjects& subjects, std::uint64_t seed, const RunKey& key,
                 ComparisonWatcher& watcher, const std::function<void(RunResult)>& keep) {
  const bool for_reference = key.variant == request.variants.size();
  const std::optional<size_t> subject = for_reference ? reference_variant(subjects) : std::optional(key.variant);
  if (!subject || *subject >= request.variants.size())
    throw Error(fmt::format("{}: there is no such run of the comparison", request.scene.name));
  const Budget budget = for_reference ? Budget{0, request.reference_seconds / double(reference_runs)} : request.budget;
  Render& render = subjects.ready(*subject);
  const std::shared_ptr<void> stoppable =
      watcher.begin(fmt::format("{}: {} run {}", std::filesystem::path(request.scene.name).stem().string(),
                                for_reference ? "reference," : request.variants[*subject].name + ",", key.run + 1),
                    render);
  const double began = processor_seconds();
  std::optional<RunResult> result = render_run(render, seed_of(seed, key), budget, [&] {
    const double part = budget.seconds > 0 ? (processor_seconds() - began) / budget.seconds
                                           : double(render.progress().samples) / double(budget.samples);
    watcher.at(part);
    return watcher.go_on();
  });
  if (!result) return false;
  if (for_reference) {  // only the final image is used
    result->run.marks.erase(result->run.marks.begin(), result->run.marks.end() - 1);
    result->pictures.erase(result->pictures.begin(), result->pictures.end() - 1);
  }
  keep(std::move(*result));
  return true;
}

CellRenderer::CellRenderer(CellRequest request)
    : request_(std::move(request)),
      subjects_(std::make_unique<SceneSubjects>(request_.scene.load, request_.variants, request_.threads)) {}

std::optional<std::string> CellRenderer::render(std::uint64_t seed, const RunKey& key, ComparisonWatcher& watcher) {
  std::optional<std::string> bytes;
  render_cell(request_, *subjects_, seed, key, watcher, [&](const RunResult& result) { bytes = run_file(result); });
  return bytes;
}

}  // namespace etendue::comparing
