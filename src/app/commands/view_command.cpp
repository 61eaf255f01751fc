// etendue view IMAGE...: shows image files in the studio's viewer.

#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "app/commands.h"
#include "etendue/film/image_tools.h"
#include "render/checkpoint.h"
#include "studio_serving.h"

namespace etendue {

namespace {

namespace fs = std::filesystem;

struct ViewOptions {
  std::vector<std::string> files;
  std::string page;
  int port = 0;
  bool no_browser = false;
};

/// Reads an image in any supported format, or the image in a checkpoint. Throws Error with the reasons if it is neither.
Image any_picture(const std::string& file) {
  std::string reason;
  try {
    return read_image(file);
  } catch (const Error& error) {
    reason = error.what();
  }
  try {
    return picture_of(read_checkpoint(file)).picture;
  } catch (const Error& error) {
    throw Error(fmt::format("{} (nor is it a checkpoint: {})", reason, error.what()));
  }
}

/// The image converted to XYZ. A grey image becomes one with three equal channels first.
std::shared_ptr<const Image> picture_in(const std::string& file) {
  Image picture = any_picture(file);
  if (picture.channels.size() < 3) {  // grey: luminance, perhaps with an alpha
    Image grey(picture.width, picture.height, {"R", "G", "B"});
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x)
        for (size_t c = 0; c < 3; ++c) grey.at(x, y, c) = picture.at(x, y, 0);
    grey.metadata = picture.metadata;
    picture = std::move(grey);
  }
  return std::make_shared<const Image>(convert_color_space(picture, "xyz"));
}

/// The name of each image: its file name, or its path if several share the file name.
std::vector<std::string> names_of(const std::vector<std::string>& files) {
  std::map<std::string, int> count;
  for (const std::string& file : files) ++count[fs::path(file).filename().string()];
  std::vector<std::string> names;
  for (const std::string& file : files) {
    const std::string name = fs::path(file).filename().string();
    names.push_back(count[name] == 1 ? name : file);
  }
  return names;
}

/// A shown file, as it was when it was read.
struct Shown {
  std::string name, file;
  fs::file_time_type written{};
  std::uintmax_t size = 0;
  Shown(std::string name_, std::string file_) : name(std::move(name_)), file(std::move(file_)) { changed(); }

  /// Whether it was written since the last call.
  bool changed() {
    std::error_code error;
    const auto now = fs::last_write_time(file, error);
    const auto bytes = error ? 0 : fs::file_size(file, error);
    if (error || (now == written && bytes == size)) return false;
    written = now;
    size = bytes;
    return true;
  }
};

/// Shows files that were written since they were read. One that is removed, or is just being written, stays as it was.
bool refresh(std::vector<Shown>& shown, studio::Studio& studio) {
  bool any = false;
  for (Shown& one : shown) {
    if (!one.changed()) continue;
    try {
      studio.pin(one.name, picture_in(one.file));
      any = true;
    } catch (const Error&) {
      one.written = {};  // not yet whole
    }
  }
  return any;
}

int view(const ViewOptions& options) {
  std::vector<std::pair<std::string, std::shared_ptr<const Image>>> pictures;
  std::vector<Error> errors;
  const std::vector<std::string> names = names_of(options.files);
  std::vector<Shown> shown;
  for (size_t i = 0; i < names.size(); ++i) shown.emplace_back(names[i], options.files[i]);
  for (size_t i = 0; i < names.size(); ++i) try {
      pictures.emplace_back(names[i], picture_in(options.files[i]));
    } catch (const Error& error) {
      errors.push_back(error);
    }
  if (!errors.empty()) throw Errors(std::move(errors));
  studio::StudioSettings settings;
  settings.read_only = true;
  settings.viewing = true;
  settings.refresh = [&](studio::Studio& studio) { return refresh(shown, studio); };
  settings.folders.allow(fs::current_path().string());
  studio::ServerSettings server_settings;
  server_settings.port = static_cast<unsigned short>(options.port);
  server_settings.page = options.page;
  return serve(std::move(settings), std::move(server_settings), !options.no_browser,
               [&](studio::Studio& studio) { studio.show_pictures(std::move(pictures)); });
}

}  // namespace

void add_view_command(Command& program) {
  auto options = std::make_shared<ViewOptions>();
  Command command = program.add_command("view",
                                        "Show pictures in the browser: EXR, PNG, NPY and others, checkpoints. A file that is "
                                        "written again is shown again, so the "
                                        "checkpoint of a render shows how it grows");
  command.argument("IMAGE", options->files, "The pictures").required();
  command.flag("--no-browser", options->no_browser, "Only print the address");
  command.option("--port N", options->port, "Port; 0: any free one").range(0, 65535);
  command.option("--page FILE", options->page, "Another page").hidden();
  command.runs([options] { return view(*options); });
}

}  // namespace etendue
