// etendue manual: writes the pages of all classes, in Markdown.

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "app/commands.h"
#include "app/common_options.h"
#include "app/text.h"
#include "describe/guard.h"
#include "etendue/describe/reflection.h"
#include "etendue/language/language.h"
#include "etendue/render/render.h"
#include "files/whole_file.h"
#include "manual_examples.h"

namespace etendue {

namespace {

struct ManualOptions {
  std::string folder;
  std::vector<std::string> plugins;
  bool pictures = false, missing = false;
  int samples = 256;
};

constexpr const char* picture_folder = "pictures";

std::string picture_file(const ClassInfo& info) { return fmt::format("{}/{}.png", picture_folder, info.name); }

void render_picture(const PictureScene& scene, const std::string& name, const std::string& file, int samples) {
  const Ref<Job> job = load_job_text(scene.description, "the picture of " + name);
  job->renderer->samples = samples;
  Render render(job);
  if (render.run() != Ended::samples) throw Error("interrupted");
  const Image picture = render.picture();
  if (scene.measured) {  // exposes so that the mean luminance becomes that of a grey card
    double sum = 0;
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x) sum += picture.at(x, y, 1);
    const double mean = sum / (double(picture.width) * picture.height);
    if (mean > 0)
      job->tone_map = ref_cast<ToneMap>(parse_component(fmt::format("ExposureToneMap {{ stops: {} }}", std::log2(0.2 / mean))));
  }
  const Ref<Output> output = ref_cast<Output>(parse_component("PngOutput {}"));
  set(*output, "file", Value(FilePath{file, ""}));
  prepare_tree(*output);
  if (job->tone_map) prepare_tree(*job->tone_map);
  write_output(*job, *output, picture, name);
}

/// Returns the number of images that could not be rendered.
int render_pictures(const ManualOptions& options) {
  const std::filesystem::path folder = options.folder;
  std::filesystem::create_directories(folder / picture_folder);
  const conform::Fixtures fixtures;
  int failed = 0;
  for (const ClassInfo* info : Registry::instance().all()) {
    try {
      const std::optional<PictureScene> scene = picture_of(*info, fixtures);
      if (!scene || (options.missing && std::filesystem::exists(folder / picture_file(*info)))) continue;
      render_picture(*scene, info->name, (folder / picture_file(*info)).string(), options.samples);
      fmt::print("{}\n", picture_file(*info));
    } catch (...) {  // a plugin may throw anything
      ++failed;
      fmt::print(stderr, "no picture of {}: {}\n", info->name, thrown_text());
    }
    std::fflush(stdout);
  }
  return failed;
}

/// The page with all images side by side, by interface.
std::string pictures_page(const std::filesystem::path& folder) {
  std::string text =
      "# Pictures\n\nEach class that can be seen, with its defaults or as its page says. Objects carry a card of "
      "8 x 8 squares over their surface coordinates, redder with u and greener with v.\n";
  for (const ClassInfo* interface : Registry::instance().all()) {
    if (interface->parent && interface->parent->parent) continue;
    std::string shown;
    for (const ClassInfo* info : Registry::instance().all())
      if (info != interface && info->is_a(*interface) && std::filesystem::exists(folder / picture_file(*info)))
        shown += fmt::format("[![{0}]({1})]({0}.md)\n", info->name, picture_file(*info));
    if (!shown.empty()) text += fmt::format("\n## {}\n\n{}", interface->name, shown);
  }
  return text;
}

int write_manual(const ManualOptions& options) {
  load_plugins(options.plugins);
  if (options.folder.empty()) {
    if (options.pictures || options.missing) throw Error("pictures need a folder: give one with -o");
    for (const ManualPage& page : manual_pages()) fmt::print("{}\n", page.text);
    return exit_status::done;
  }
  std::error_code problem;
  std::filesystem::create_directories(options.folder, problem);
  if (problem) throw Error(fmt::format("cannot make the folder '{}': {}", options.folder, problem.message()));
  const int failed = options.pictures || options.missing ? render_pictures(options) : 0;
  // An existing image is shown on its class's page, whenever it was rendered.
  std::vector<ManualPage> pages = manual_pages([&](const ClassInfo& info) {
    std::string text;
    if (!std::filesystem::exists(std::filesystem::path(options.folder) / picture_file(info))) return text;
    text = fmt::format("![{}]({})", info.name, picture_file(info));
    if (const std::string example = example_of(info); !example.empty()) text += fmt::format("\n\nShown: `{}`", example);
    return text;
  });
  if (std::filesystem::exists(std::filesystem::path(options.folder) / picture_folder))
    pages.push_back({"Pictures.md", "Pictures", pictures_page(options.folder)});
  for (const ManualPage& page : pages)
    write_whole_file((std::filesystem::path(options.folder) / page.file).string(), page.text);
  fmt::print("{} pages in {}\n", pages.size(), options.folder);
  return failed > 0 ? exit_status::failed : exit_status::done;
}

}  // namespace

void add_manual_command(Command& program) {
  Command command = program.add_command("manual", "Write the manual of all classes, in Markdown");
  auto options = std::make_shared<ManualOptions>();
  command.option("-o,--output FOLDER", options->folder, "Folder for one page per class. Default: print all");
  add_plugin_option(command, options->plugins);
  command.flag("--pictures", options->pictures, "Render a small picture of each class that can be seen; takes minutes");
  command.flag("--missing", options->missing, "Render only the pictures that are missing");
  command.option("--samples N", options->samples, "Samples per pixel of the pictures").range(1, 1 << 30).show_default();
  command.footer(
      "\nExamples\n  etendue manual | less\n  etendue manual -o manual --pictures\n  etendue manual -o manual --missing");
  command.runs([options] { return write_manual(*options); });
}

}  // namespace etendue
