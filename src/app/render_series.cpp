// Several renders in one process.

#include "render_series.h"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/report.h"
#include "app/text.h"
#include "etendue/film/image_tools.h"
#include "files/input_files.h"
#include "render/denoising.h"

namespace etendue {

namespace {

/// Start and end of the last run of '#'; both 0 if there is none.
std::pair<size_t, size_t> place_of_number(const std::string& text) {
  const size_t last = text.rfind('#');
  if (last == std::string::npos) return {0, 0};
  size_t begin = last;
  while (begin > 0 && text[begin - 1] == '#') --begin;
  return {begin, last + 1};
}

bool has_place_for_number(const std::string& text) { return text.find('#') != std::string::npos; }

[[noreturn]] void wrong_option(const char* option, const std::string& message) { throw Error(message, {intern(option), 0, 0}); }

struct Frames {
  int begin = 0, end = 1, step = 1;
};

Frames parse_frames(const std::string& text) {
  Frames frames;
  int n[3] = {0, 0, 1};
  const int count = std::count(text.begin(), text.end(), ':') == 2 ? 3 : 2;
  parse_integers(text, ':', count, n, "--frames", "A:B or A:B:STEP, such as 0:120");
  frames = {n[0], n[1], n[2]};
  if (frames.begin < 0 || frames.end <= frames.begin || frames.end > SceneOptions::most_frames || frames.step < 1)
    wrong_option("--frames",
                 fmt::format("'{}' is not a range of frames: A:B is A to B - 1, A:B:STEP every STEPth of them", text));
  return frames;
}

/// "box.etd", "box.etd, frame 7"
std::string name_of(const RenderOptions& render) {
  return render.file + (render.frame ? fmt::format(", frame {}", *render.frame) : std::string());
}

/// Throws Error for options that are ambiguous for several renders.
void refuse_for_several(const RenderOptions& options, bool several_frames) {
  const bool several_files = options.files.size() > 1;
  if (!options.pixel.empty()) wrong_option("--pixel", "--pixel is for one picture: give one file, and --frame for one frame");
  if (several_files && !options.outputs.empty())
    wrong_option("--output",
                 "pictures of several files cannot be written to one: name them in the files, or render one by one");
  for (const auto& [option, file] : {std::pair("--checkpoint", &options.checkpoint), std::pair("--resume", &options.resume),
                                     std::pair("--continue", &options.continue_file)}) {
    if (file->empty()) continue;
    if (several_files) wrong_option(option, "a checkpoint belongs to one render: give one file");
    if (several_frames && !has_place_for_number(*file))
      wrong_option(option,
                   fmt::format("all frames would write the checkpoint '{}': write #### where the frame number belongs", *file));
  }
  for (const std::string& output : options.outputs)
    if (several_frames && !has_place_for_number(output))
      wrong_option("--output",
                   fmt::format("all frames would be written to '{}': write #### where the frame number belongs", output));
}

/// Announces the render that begins, as JSON with --progress json.
void announce(const RenderOptions& one, size_t number, size_t count) {
  if (one.quiet) return;
  if (one.progress == "json") {
    nlohmann::ordered_json json = {{"event", "begin"}, {"file", one.file}};
    if (one.frame) json["frame"] = *one.frame;
    json["number"] = number;
    json["of"] = count;
    fmt::print("{}\n", json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  } else {
    fmt::print("{} ({} of {})\n", name_of(one), number, count);
  }
  std::fflush(stdout);
}

/// The reason why an existing image differs from what would be rendered; empty: it does not.
std::string what_lacks(const Image& picture, const Job& job, const RenderOptions& options) {
  const auto said = [&](const char* key) {
    const auto found = picture.metadata.find(key);
    return found == picture.metadata.end() ? std::string() : found->second;
  };
  const bool cropped = !said("full_width").empty() || !options.crop.empty();
  if (!cropped && (picture.width != job.image->width || picture.height != job.image->height)) return "has another size";
  const std::string hash = said("file_hash"), samples = said("samples");
  if (!hash.empty() && hash != job.metadata.at("file_hash"))
    return "was rendered from another version of the file or of one that it names, or with other options";
  const bool counted = !options.open_ended() && job.time_limit == 0 && job.error_limit == 0;
  int count = 0;
  std::from_chars(samples.data(), samples.data() + samples.size(), count);
  if (!samples.empty() && counted && count < int(job.renderer->samples)) return "has fewer samples";
  return {};
}

}  // namespace

RenderOptions one_of(const RenderOptions& options, const std::string& file, std::optional<int> frame, bool several_frames) {
  RenderOptions one = options;
  one.file = file;
  one.files = {file};
  one.frames.clear();
  one.frame = frame;
  one.animated = one.in_series = several_frames;
  if (!frame) return one;
  for (std::string& output : one.outputs) output = numbered(output, *frame);
  for (std::string* name : {&one.checkpoint, &one.resume, &one.continue_file}) *name = numbered(*name, *frame);
  return one;
}

std::string numbered(const std::string& text, int frame) {
  const auto [begin, end] = place_of_number(text);
  if (begin == end) return text;
  return text.substr(0, begin) + fmt::format("{:0{}}", frame, end - begin) + text.substr(end);
}

void number_outputs(const std::vector<Ref<Output>>& outputs, const RenderOptions& options) {
  if (!options.frame) return;
  for (const Ref<Output>& output : outputs) {
    if (!output || output->file.empty()) continue;
    const std::string& name = output->file.text;
    // The names given by -o already have their number.
    if (options.in_series && options.outputs.empty() && !has_place_for_number(name))
      output->fail("file", fmt::format("all frames would be written to '{}': write #### where the frame number belongs", name));
    set(*output, "file", Value(FilePath{numbered(name, *options.frame), output->file.folder}));
  }
}

void Series::claim(const std::vector<Ref<Output>>& outputs, const RenderOptions& options) {
  std::vector<Error> errors;
  const std::string name = name_of(options);
  for (const Ref<Output>& output : outputs) {
    if (!output) continue;
    const std::string path = output->path(options.stem());
    std::error_code failed;
    const std::filesystem::path spelling = std::filesystem::weakly_canonical(std::filesystem::absolute(path, failed), failed);
    const auto [before, fresh] = claimed_.emplace(failed ? path : spelling.string(), name);
    const Location at = output->location_of("file");
    if (!fresh && before->second != name)
      errors.emplace_back(fmt::format("'{}' is already the picture of {}", path, before->second),
                          at.known() ? at : Location{intern(options.file), 0, 0});
  }
  if (!errors.empty()) throw Errors(std::move(errors));
}

bool are_whole(const std::vector<Ref<Output>>& outputs, const Job& job, const RenderOptions& options) {
  if (outputs.empty()) return false;
  std::vector<std::string> paths = denoised_paths(outputs, options.stem());
  for (const Ref<Output>& output : outputs) {
    if (!output) return false;
    paths.push_back(output->path(options.stem()));
  }
  std::string all;
  for (const std::string& path : paths) {
    std::error_code failed;
    if (!std::filesystem::exists(path, failed)) return false;
    std::string lacks;
    try {
      lacks = what_lacks(read_image(path), job, options);
    } catch (const Error&) {
      lacks = "cannot be read";
    }
    if (!lacks.empty()) {
      if (!options.quiet) fmt::print(stderr, "'{}' {}: it is rendered again\n", path, lacks);
      return false;
    }
    all += (all.empty() ? "" : " ") + path;
  }
  if (!options.quiet && options.progress != "json") fmt::print("{} exists already\n", all);
  return true;
}

int render_series(const RenderOptions& options, const std::function<int(const RenderOptions&, Series&)>& render) {
  options.frames_per_second();
  Series series;
  if (options.files.size() == 1 && options.frames.empty())
    return render(one_of(options, options.files.front(), options.frame, false), series);
  const Frames frames = options.frames.empty() ? Frames{} : parse_frames(options.frames);
  const auto count = options.frames.empty() ? 1 : size_t((frames.end - frames.begin + frames.step - 1) / frames.step);
  refuse_for_several(options, count > 1);
  for (const std::string& file : options.files) note_input(file);

  const size_t all = count * options.files.size();
  size_t number = 0, failed = 0;
  int status = exit_status::done;
  std::string failures;
  for (const std::string& file : options.files) {
    for (size_t i = 0; i < count; ++i) {
      const std::optional<int> frame =
          options.frames.empty() ? options.frame : std::optional(frames.begin + int(i) * frames.step);
      const RenderOptions one = one_of(options, file, frame, count > 1);
      announce(one, ++number, all);
      const int result = reporting_errors([&] { return render(one, series); });
      if (result == exit_status::interrupted) {
        if (one.in_series) fmt::print(stderr, "{} is not finished: no picture of it is written\n", name_of(one));
        if (number < all) fmt::print(stderr, "{} of {} renders were not started\n", all - number, all);
        return result;
      }
      if (result == exit_status::done) continue;
      status = std::max(status, result);
      constexpr size_t most = 20;
      if (++failed <= most) failures += "  " + name_of(one) + "\n";
      if (failed == most + 1) failures += "  …\n";
    }
  }
  if (failed > 0) fmt::print(stderr, "{} of {} renders failed:\n{}", failed, all, failures);
  return status;
}

}  // namespace etendue
