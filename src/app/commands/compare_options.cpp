#include "compare_options.h"

#include <fmt/format.h>

#include "app/common_options.h"
#include "app/text.h"
#include "etendue/language/language.h"

namespace etendue {

void CompareOptions::add_to(Command& command) {
  command.argument("FILE", files, "Render descriptions (.etd, or .json); several make a matrix of scenes and variants")
      .required();
  add_overrides_to(command);
  command.option("--renderers A,B,…", renderers,
                 "Renderers to compare, separated by commas: classes, or expressions such as 'PathTracer{next_event: false}'. "
                 "They inherit the sampler, light sampler and max_depth of the file's renderer, unless they set their own");
  command.option("--variant 'NAME: PATH=VALUE, …'", variant_texts,
                 "Compare the file with these members set as well, as --set does, under a name; may be repeated");
  command.option("--time TIME", time, "CPU time of each run, summed over all threads");
  command.option("--samples N", samples, "Samples per pixel of each run").range(1, 1 << 30);
  command.option("--runs K", runs, "Independent runs of each variant").show_default().range(3, 1000);
  command.option("--reference IMAGE", references,
                 "The reference picture, linear (.exr, .npy) or a checkpoint; once for each FILE. Default: the mean of the "
                 "variants that are unbiased and find all light");
  command.option("--reference-time TIME", reference_time,
                 "Render a reference for this CPU time, with the first variant that is unbiased and finds all light");
  command.option("--report FILE", report, "Write a page with plots, pictures and tables, one HTML file");
  command.option("--csv FILE", csv, "Write the error curves as a table");
  command.option("--json FILE", json, "Write all results as JSON");
  command.option("--state FOLDER", state,
                 "Store finished runs in this folder, from which the same command resumes. Default: beside the report, else "
                 "beside the table");
  command.option("--inset X,Y,W,H", inset_texts, "Show this part of the picture enlarged. Default: where variants differ most");
  command.option("--tile PX", tile, "Side of the tiles that are tested for bias [pixels]; 0: 32, less in small pictures")
      .range(0, 65536);
  command
      .option("--significance P", significance,
              "Significance level: probability of calling any of several equal variants better, or biased")
      .show_default()
      .range(1e-12, 0.5);
  command.option("--seed N", seed, "Seed of the random numbers");
  command.option("--size WxH", size, "Size of the pictures in pixels");
  add_threads_option(command, threads);
  command.flag("--quiet", quiet, "Print nothing but errors");
}

Ref<Job> CompareOptions::load(const std::string& path) const {
  SceneOptions one = *this;
  one.file = path;
  Ref<Job> job = one.load();
  if (!seed.empty()) set_path(*job, "seed", seed);
  if (!size.empty()) {
    int n[2];
    parse_integers(size, 'x', 2, n, "--size", "WxH, such as 640x480");
    set_path(*job, "image.width", std::to_string(n[0]));
    set_path(*job, "image.height", std::to_string(n[1]));
  }
  return job;
}

comparing::Budget CompareOptions::budget() const {
  if ((samples > 0) == !time.empty())
    throw Error(samples > 0 ? "--samples and --time both limit a run: give one of them"
                            : "a run needs a limit: give --time 1m (CPU time of each run) or --samples 256");
  return {std::uint32_t(samples), time.empty() ? 0 : parse_duration(time, "--time")};
}

double CompareOptions::reference_seconds() const {
  if (!references.empty() && !reference_time.empty())
    throw Error("--reference and --reference-time exclude each other: give one of them");
  if (!references.empty() && references.size() != files.size())
    throw Error(fmt::format("there are {} references for {} scenes: give one for each, in the same order", references.size(),
                            files.size()),
                {intern("--reference"), 0, 0});
  return reference_time.empty() ? 0 : parse_duration(reference_time, "--reference-time");
}

std::vector<comparing::Variant> CompareOptions::variants() const {
  std::vector<comparing::Variant> list = comparing::parse_variants(renderers, variant_texts);
  if (list.empty()) throw Error("there is nothing to compare: name --renderers A,B or --variant 'NAME: PATH=VALUE'");
  return list;
}

std::vector<PixelArea> CompareOptions::insets() const {
  std::vector<PixelArea> list;
  for (const std::string& text : inset_texts) {
    int n[4];
    parse_integers(text, ',', 4, n, "--inset", "X,Y,W,H, such as 100,80,64,48");
    constexpr int most = 1 << 24;
    if (n[0] < 0 || n[1] < 0 || n[2] < 1 || n[3] < 1 || n[0] > most || n[1] > most || n[2] > most || n[3] > most)
      throw Error(fmt::format("'{}' is not a part of the picture", text), {intern("--inset"), 0, 0});
    list.push_back({n[0], n[1], n[0] + n[2], n[1] + n[3]});
  }
  return list;
}

std::string CompareOptions::state_folder() const {
  if (!state.empty()) return state;
  for (const std::string* output : {&report, &json, &csv})
    if (!output->empty()) return *output + ".runs";
  return {};
}

std::string CompareOptions::command_line() const {
  std::string text = "etendue compare";
  for (const std::string& path : files) text += " " + shell_quoted(path);
  text += overrides_line();
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) text += fmt::format(" {} {}", option, shell_quoted(value));
  };
  const CompareOptions defaults;
  add("--renderers", renderers);
  for (const std::string& variant : variant_texts) add("--variant", variant);
  add("--time", time);
  if (samples > 0) add("--samples", std::to_string(samples));
  if (runs != defaults.runs) add("--runs", std::to_string(runs));
  for (const std::string& reference : references) add("--reference", reference);
  add("--reference-time", reference_time);
  for (const std::string& inset : inset_texts) add("--inset", inset);
  if (tile != defaults.tile) add("--tile", std::to_string(tile));
  if (significance != defaults.significance) add("--significance", fmt::format("{}", significance));
  add("--seed", seed);
  add("--size", size);
  return text;
}

}  // namespace etendue
