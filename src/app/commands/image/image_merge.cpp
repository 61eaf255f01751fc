// etendue image merge: merges checkpoints of different passes into one image.

#include "image_merge.h"

#include <fmt/format.h>

#include <cstdio>

#include "app/render_options.h"
#include "core/number_text.h"
#include "etendue/language/language.h"
#include "files/input_files.h"
#include "render/checkpoint.h"
#include "render/denoising.h"

namespace etendue {

namespace {

struct MergeOptions {
  std::vector<std::string> parts, outputs;
  std::string checkpoint;
  bool quiet = false;
};

/// Reports the wanted samples that are in none of the parts.
void report_gaps(const Checkpoint& merged) {
  std::uint32_t end = merged.samples_wanted;
  if (!merged.done.empty()) end = std::max(end, merged.done.back().end);
  const std::vector<IndexRange> gaps = missing(merged.done, {0, end});
  if (gaps.empty()) return;
  std::string passes;
  for (const auto [begin, last] : gaps) {
    const std::uint32_t step = merged.samples_per_pass;
    passes += fmt::format("{}{}:{}", passes.empty() ? "" : ", ", begin / step, (last + step - 1) / step);
  }
  fmt::print(stderr, "note: {} (--passes {}) are in none of the parts; the picture is made of the {} others\n",
             samples_text(gaps), passes, count(merged.done));
}

int merge(const MergeOptions& options) {
  for (const std::string& part : options.parts) note_input(part);
  const Checkpoint merged = merge_checkpoints(options.parts);
  if (merged.done.empty()) throw Error("the parts hold no samples");
  const auto [job, picture] = picture_of(merged);
  const std::vector<Ref<Output>> outputs = chosen_outputs(job->outputs, options.outputs);
  for (const Ref<Output>& output : outputs) prepare_tree(*output);
  const auto file = merged.metadata.find("file");
  const std::string stem = stem_of(file == merged.metadata.end() ? "merged" : file->second);
  OutputFiles files;
  add_outputs(outputs, stem, files);
  if (!options.checkpoint.empty()) files.add(options.checkpoint, {intern("--checkpoint"), 0, 0});
  files.raise();
  report_gaps(merged);
  for (const std::string& path : denoised_paths(outputs, stem))
    fmt::print(
        stderr,
        "note: '{}' is not written: checkpoints contain no scene, which denoising needs; 'etendue render FILE --resume' of the "
        "merged --checkpoint writes it\n",
        path);

  std::vector<Error> errors;
  const std::vector<std::string> written = write_each(outputs, *job, picture, stem, errors);
  if (!options.checkpoint.empty()) {
    try {
      write_checkpoint(merged, options.checkpoint);
    } catch (const Error& error) {
      errors.push_back(error);
    }
  }
  if (!options.quiet) {
    for (const std::string& path : written) fmt::print("{}\n", path);
    fmt::print("{} samples per pixel of {} part{}, rendered in {}\n", count(merged.done), options.parts.size(),
               options.parts.size() == 1 ? "" : "s", duration_text(merged.seconds));
    std::fflush(stdout);
  }
  for (const Error& error : errors) fmt::print(stderr, "{}\n", show(error));
  return errors.empty() ? exit_status::done : exit_status::failed;
}

}  // namespace

void add_image_merge(Command& image) {
  Command command = image.add_command("merge", "Make one picture of checkpoints that hold different passes of a render");
  auto options = std::make_shared<MergeOptions>();
  command.argument("PART", options->parts, "Checkpoints of 'etendue render --passes', in any order").required();
  command.option("-o,--output FILE", options->outputs,
                 "Write to this file instead of those the render description names; may be repeated");
  command.option("--checkpoint FILE", options->checkpoint, "Write a checkpoint of all parts together, which can be resumed");
  command.flag("--quiet", options->quiet, "Print nothing but errors and notes");
  command.footer(
      "\nExample\n"
      "  etendue render box.etd --passes 0:8 --checkpoint a.part      on one machine\n"
      "  etendue render box.etd --passes 8:16 --checkpoint b.part     on another\n"
      "  etendue image merge a.part b.part -o box.exr -o box.png");
  command.runs([options] { return merge(*options); });
}

}  // namespace etendue
