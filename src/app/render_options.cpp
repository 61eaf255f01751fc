// What `etendue render` takes, and how it changes a Job.

#include "app/render_options.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "app/text.h"
#include "etendue/language.h"

namespace etendue {

void RenderOptions::add_to(CLI::App& command) {
  SceneOptions::add_to(command);
  command
      .add_option("-o,--output", outputs,
                  "Write to this file instead of those the file names; its ending chooses the format; may be repeated")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command.add_option("--samples", samples, "Samples per pixel")->type_name("N");
  command
      .add_option("--time", time,
                  "Stop after this time, such as 90s, 5m or 1h30m; without --samples, no number of samples stops it earlier")
      ->type_name("TIME");
  command.add_option("--error", error, "Stop when the mean relative standard error of pixels is below this; likewise")
      ->type_name("E");
  command.add_option("--seed", seed, "Choose other random numbers")->type_name("N");
  command.add_option("--size", size, "Size of the picture in pixels")->type_name("WxH");
  command.add_option("--crop", crop, "Render these pixels only, ends not included")->type_name("X0,Y0,X1,Y1");
  command.add_option("--threads", threads, "Threads to use; 0: all cores. The picture does not depend on it")
      ->type_name("N")
      ->check(CLI::Range(0, 4096).description(""));
  command.add_flag("--quiet", quiet, "Print nothing but errors and warnings");
  command
      .add_option(
          "--progress", progress,
          "auto: a bar on a terminal, else a line now and then; bar; json: a JSON object per line on standard output; none")
      ->type_name("KIND")
      ->check(CLI::IsMember({"auto", "bar", "json", "none"}));
  CLI::Option* pixel_option =
      command.add_option("--pixel", pixel, "With --sample: compute one sample of this pixel alone and print its path")
          ->type_name("X,Y");
  CLI::Option* sample_option = command.add_option("--sample", sample, "Which sample of --pixel, from 0")->type_name("N");
  pixel_option->needs(sample_option);
  sample_option->needs(pixel_option);
}

std::vector<RenderOptions::Override> RenderOptions::overrides() const {
  std::vector<Override> list;
  // Far more than anyone waits for; the other rule comes first.
  if (open_ended()) list.push_back({"--time", "renderer.samples", "1000000"});
  if (!samples.empty()) list.push_back({"--samples", "renderer.samples", samples});
  if (!time.empty()) list.push_back({"--time", "time_limit", fmt::format("{} s", parse_duration(time, "--time"))});
  if (!error.empty()) list.push_back({"--error", "error_limit", error});
  if (!seed.empty()) list.push_back({"--seed", "seed", seed});
  if (!size.empty()) {
    int n[2];
    parse_integers(size, 'x', 2, n, "--size", "WxH, such as 640x480");
    list.push_back({"--size", "image.width", std::to_string(n[0])});
    list.push_back({"--size", "image.height", std::to_string(n[1])});
  }
  if (!crop.empty()) {
    int n[4];
    parse_integers(crop, ',', 4, n, "--crop", "X0,Y0,X1,Y1");
    list.push_back({"--crop", "image.crop", fmt::format("[{}, {}, {}, {}]", n[0], n[1], n[2], n[3])});
  }
  return list;
}

Ref<Job> RenderOptions::load() const {
  const std::vector<Override> list = overrides();  // a command line that makes no sense is told before a long load
  Ref<Job> job = SceneOptions::load();
  std::vector<Error> errors;
  for (const Override& override : list) {
    try {
      set_path(*job, override.path, override.expression);
    } catch (const Errors& several) {
      errors.insert(errors.end(), several.errors.begin(), several.errors.end());
    } catch (const Error& error_) {
      errors.push_back(Error(fmt::format("{}: {}", override.option, error_.what())));
    }
  }
  if (!errors.empty()) throw Errors(std::move(errors));
  choose_outputs(*job, outputs);
  job->threads = threads;
  job->metadata["file"] = file;
  job->metadata["file_hash"] = file_hash();
  job->metadata["command_line"] = picture_command();
  return job;
}

std::string RenderOptions::picture_command() const {
  std::string text = "etendue render" + SceneOptions::command_line();
  const std::pair<const char*, const std::string*> rest[] = {{"--samples", &samples}, {"--time", &time}, {"--error", &error},
                                                             {"--seed", &seed},       {"--size", &size}, {"--crop", &crop}};
  for (const auto& [name, value] : rest)
    if (!value->empty()) text += fmt::format(" {} {}", name, shell_quoted(*value));
  return text;
}

std::string RenderOptions::file_hash() const {
  // FNV-1a, 64 bits: it tells files apart, it does not protect them.
  std::uint64_t hash = 0xcbf29ce484222325ull;
  const auto add = [&](const std::string& text) {
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
    hash = (hash ^ 0xff) * 0x100000001b3ull;  // no UTF-8 text has this byte: "ab" + "c" is not "a" + "bc"
  };
  add(read_file(file));
  for (const std::string& define : defines) add("-D" + define);
  for (const std::string& set : sets) add("--set" + set);
  for (const Override& override : overrides()) add(override.path + "=" + override.expression);
  return fmt::format("{:016x}", hash);
}

namespace {

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

/// The output for a file name, by its ending.
Ref<Output> output_for(const std::string& file) {
  const std::string ending = lower(std::filesystem::path(file).extension().string());
  std::vector<std::string> known;
  for (const ClassInfo* info : Registry::instance().subclasses(*Registry::instance().find("Output"))) {
    const Ref<Output> output = ref_cast<Output>(info->create());
    if (output->extension() == ending) return output;
    known.push_back(output->extension());
  }
  throw Error(fmt::format("'{}': no format has the ending '{}'{}; known are {}", file, ending, suggestion(ending, known),
                          fmt::join(known, " ")),
              {intern("--output"), 0, 0});
}

}  // namespace

void choose_outputs(Job& job, const std::vector<std::string>& files) {
  std::vector<Ref<Output>> outputs;
  for (const std::string& file : files) {
    Ref<Output> output = output_for(file);
    for (const Ref<Output>& had : job.outputs)
      if (had && &had->class_info() == &output->class_info()) {
        output = ref_cast<Output>(copy(*had));
        break;
      }
    set(*output, "file", Value(FilePath{file, ""}));
    outputs.push_back(output);
  }
  if (outputs.empty() && job.outputs.empty()) outputs.push_back(output_for(".default.png"));
  if (!outputs.empty()) job.outputs = std::move(outputs);
}

void check_output_folders(const Job& job) {
  for (const Ref<Output>& output : job.outputs) {
    if (!output) continue;
    const std::string path = output->file.empty() ? "." : output->file.resolved();
    const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
    if (!std::filesystem::is_directory(folder))
      throw Error(fmt::format("cannot write '{}': there is no folder '{}'", path, folder.string()),
                  output->location_of("file"));
    if (access(folder.c_str(), W_OK) != 0)
      throw Error(fmt::format("cannot write '{}': the folder '{}' cannot be written to", path, folder.string()),
                  output->location_of("file"));
  }
}

}  // namespace etendue
