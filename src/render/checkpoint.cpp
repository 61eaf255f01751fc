// Checkpoints of jobs: creation, comparison, merging.

#include "checkpoint.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "etendue/describe/registry.h"
#include "etendue/language/language.h"
#include "etendue/render/render.h"
#include "film/film_state.h"
#include "film/surface_film.h"

namespace etendue {

// ---- ranges -------------------------------------------------------------------------------------------------------------

std::uint32_t count(const std::vector<IndexRange>& ranges) {
  std::uint32_t n = 0;
  for (const IndexRange& r : ranges) n += r.end - r.begin;
  return n;
}

void insert(std::vector<IndexRange>& ranges, IndexRange added) {
  if (added.begin >= added.end) return;
  std::vector<IndexRange> result;
  for (const IndexRange& r : ranges) {
    if (r.end < added.begin || r.begin > added.end)
      result.push_back(r);
    else
      added = {std::min(added.begin, r.begin), std::max(added.end, r.end)};
  }
  result.insert(std::ranges::lower_bound(result, added.begin, {}, &IndexRange::begin), added);
  ranges = std::move(result);
}

std::vector<IndexRange> missing(const std::vector<IndexRange>& ranges, IndexRange whole) {
  std::vector<IndexRange> result;
  for (const IndexRange& r : ranges) {
    if (r.begin > whole.begin && whole.begin < whole.end) result.push_back({whole.begin, std::min(r.begin, whole.end)});
    whole.begin = std::max(whole.begin, r.end);
  }
  if (whole.begin < whole.end) result.push_back(whole);
  return result;
}

std::string samples_text(const std::vector<IndexRange>& ranges) {
  if (ranges.empty()) return "no samples";
  const bool one = ranges.size() == 1 && ranges[0].end - ranges[0].begin == 1;
  std::string text = one ? "sample " : "samples ";
  for (size_t i = 0; i < ranges.size(); ++i) {
    const auto [begin, end] = ranges[i];
    if (i > 0) text += ", ";
    text += end - begin == 1 ? std::to_string(begin) : fmt::format("{} to {}", begin, end - 1);
  }
  return text;
}

void drop_short_pass(std::vector<IndexRange>& ranges, std::uint32_t samples_per_pass) {
  if (ranges.empty()) return;
  IndexRange& last = ranges.back();
  last.end = std::max(last.begin, last.end / samples_per_pass * samples_per_pass);
  if (last.begin == last.end) ranges.pop_back();
}

// ---- creation --------------------------------------------------------------------------------------------------------------

Checkpoint empty_checkpoint(const Job& job, const Identity& identity, std::uint32_t samples_per_step) {
  Checkpoint c;
  c.version = ETENDUE_VERSION ", " + std::string(abi_string());
  c.identity = identity;
  c.seed = job.seed;
  c.samples_per_pass = samples_per_step;
  c.samples_wanted = std::uint32_t(job.renderer->samples);
  c.image = write_description(*job.image);
  if (job.tone_map) c.tone_map = write_description(*job.tone_map);
  for (const Ref<Output>& output : job.outputs) {
    if (!output) continue;
    // The absolute path that the description means, wherever the output is written from later.
    const Ref<Output> placed = ref_cast<Output>(copy(*output));
    if (!placed->file.empty()) placed->file = {std::filesystem::absolute(placed->file.resolved()).lexically_normal(), {}};
    c.outputs.push_back(write_description(*placed));
  }
  c.metadata = job.metadata;
  c.metadata["renderer"] = job.renderer->class_info().name;
  if (const std::string bias = job.renderer->bias(); !bias.empty()) c.metadata["bias"] = bias;
  return c;
}

KeptPicture picture_of(const Checkpoint& c) {
  const auto part = [](const std::string& text) {
    const Ref<Component> component = parse_component(text, "the checkpoint's description");
    prepare_tree(*component);
    return component;
  };
  const Ref<Job> job = make<Job>();
  job->renderer = nullptr;
  job->image = ref_cast<ImageBuffer>(part(c.image));
  job->tone_map = c.tone_map.empty() ? Ref<ToneMap>() : ref_cast<ToneMap>(part(c.tone_map));
  for (const std::string& output : c.outputs) job->outputs.push_back(ref_cast<Output>(part(output)));
  if (!job->image) throw Error("the checkpoint describes no image");
  job->seed = c.seed;
  job->metadata = c.metadata;
  Film film(*job->image, estimator_of(c.state.image));
  film.load_state(c.state.image);
  SurfaceFilm surfaces(*job->image);
  surfaces.load_state(c.state.surfaces);
  RenderSnapshot kept{film.snapshot(), {}, picture_metadata(*job, count(c.done)), surfaces.snapshot()};
  return {job, kept.picture()};
}

// ---- comparison and merging ------------------------------------------------------------------------------------------------

std::string mismatch(const Checkpoint& a, const std::string& whose, const Checkpoint& b, const std::string& other_whose) {
  if (a.version != b.version)
    return fmt::format("it is of another version: {} in {}, {} in {}", a.version, whose, b.version, other_whose);
  if (a.seed != b.seed) return fmt::format("the seed differs: {} in {}, {} in {}", a.seed, whose, b.seed, other_whose);
  if (const std::string text = difference(a.identity, whose, b.identity, other_whose); !text.empty()) return text;
  if (a.samples_per_pass != b.samples_per_pass)
    return fmt::format("the passes differ: {} samples each in {}, {} in {}", a.samples_per_pass, whose, b.samples_per_pass,
                       other_whose);
  return {};
}

namespace {

struct Part {
  std::string path;
  Checkpoint header;
  std::uint32_t first() const { return header.done.empty() ? 0 : header.done.front().begin; }
};

/// Why parts cannot be merged: different renders, or the same samples twice.
std::vector<Error> reasons_against(const std::vector<Part>& parts) {
  std::vector<Error> errors;
  std::vector<std::pair<IndexRange, const std::string*>> ranges;
  const Part& first = parts.front();
  for (const Part& part : parts) {
    if (const std::string reason = mismatch(part.header, "it", first.header, "'" + first.path + "'"); !reason.empty())
      errors.emplace_back(fmt::format("cannot merge '{}': {}", part.path, reason));
    for (const IndexRange& range : part.header.done) ranges.emplace_back(range, &part.path);
  }
  std::ranges::stable_sort(ranges, {}, [](const auto& r) { return r.first.begin; });
  // Compared with the earlier range that ends last, which need not be the preceding one.
  for (size_t i = 1, far = 0; i < ranges.size(); ++i) {
    const auto& [range, path] = ranges[i];
    const auto& [other, other_path] = ranges[far];
    if (range.begin < other.end)
      errors.emplace_back(fmt::format("cannot merge '{}' and '{}': both hold {}", *other_path, *path,
                                      samples_text({{range.begin, std::min(range.end, other.end)}})));
    if (range.end > other.end) far = i;
  }
  return errors;
}

}  // namespace

Checkpoint merge_checkpoints(const std::vector<std::string>& paths) {
  if (paths.empty()) throw Error("there is nothing to merge");
  if (paths.size() == 1) return read_checkpoint(paths.front());
  std::vector<Part> parts;
  for (const std::string& path : paths) parts.push_back({path, read_checkpoint_header(path)});
  std::ranges::stable_sort(parts, {}, &Part::first);
  if (std::vector<Error> errors = reasons_against(parts); !errors.empty()) throw Errors(std::move(errors));

  Checkpoint merged = parts.front().header;
  merged.before_short_pass.reset();
  merged.seconds = 0;
  merged.done.clear();
  const Ref<ImageBuffer> image = ref_cast<ImageBuffer>(parse_component(merged.image, "the checkpoint's description"));
  if (!image) throw Error(fmt::format("'{}' describes no image", parts.front().path));
  prepare_tree(*image);
  std::unique_ptr<Film> film;
  SurfaceFilm surfaces(*image);
  for (const Part& part : parts) {
    const Checkpoint c = read_checkpoint(part.path);
    if (c.done != part.header.done) throw Error(fmt::format("'{}' changed while it was read", part.path));
    if (!c.state.renderer.empty())
      throw Error(fmt::format("cannot merge '{}': {} learns from one pass to the next, so its passes belong together",
                              part.path, c.metadata.at("renderer")));
    if (!film) film = std::make_unique<Film>(*image, estimator_of(c.state.image));
    film->add_state(c.state.image);
    surfaces.add_state(c.state.surfaces);
    merged.seconds += c.seconds;
    merged.samples_wanted = std::max(merged.samples_wanted, c.samples_wanted);
    for (const IndexRange& range : c.done) insert(merged.done, range);
  }
  merged.state.image = film->save_state();
  merged.state.surfaces = surfaces.save_state();
  return merged;
}

}  // namespace etendue
