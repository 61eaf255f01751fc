// etendue studio [FILE]: edits, shows and controls a render in a browser.

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "app/commands.h"
#include "app/text.h"
#include "etendue/describe/registry.h"
#include "studio_serving.h"

namespace etendue {

namespace {

namespace fs = std::filesystem;

struct StudioOptions {
  std::string file, listen, password_file, page;
  std::vector<std::string> allowed, plugins;
  int port = 0, threads = 0;
  bool no_browser = false, read_only = false;
};

std::string password(const StudioOptions& options) {
  std::string text;
  if (!options.password_file.empty()) {
    text = read_file(options.password_file);
    while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  } else if (const char* set = std::getenv("ETENDUE_STUDIO_PASSWORD")) {
    text = set;
  }
  constexpr size_t shortest = 8;
  if (text.size() < shortest)
    throw Error(
        "--listen needs a password of 8 characters at least, in the file --password-file or in the variable "
        "ETENDUE_STUDIO_PASSWORD",
        {intern("--listen"), 0, 0});
  return text;
}

int run_studio(const StudioOptions& options) {
  for (const std::string& plugin : options.plugins) Registry::instance().load_plugin(plugin);
  studio::StudioSettings settings;
  settings.render.threads = options.threads;
  settings.read_only = options.read_only;
  if (!options.file.empty()) settings.folders.allow(fs::absolute(options.file).parent_path().string());
  settings.folders.allow(fs::current_path().string());
  for (const std::string& folder : options.allowed) settings.folders.allow(folder);

  studio::ServerSettings server_settings;
  server_settings.port = static_cast<unsigned short>(options.port);
  server_settings.page = options.page;
  if (!options.listen.empty()) {
    server_settings.address = options.listen;
    server_settings.password = password(options);
    fmt::print(
        stderr,
        "warning: others can reach this studio at {}. What they send and see, the password too, goes unencrypted: through "
        "strange networks use a tunnel, such as ssh -L.\n",
        options.listen);
  }

  settings.plugins = options.plugins;
  for (std::string& plugin : settings.plugins) plugin = fs::absolute(plugin).string();
  const std::string file = options.file;
  return serve(std::move(settings), std::move(server_settings), !options.no_browser,
               [&](studio::Studio& studio) { studio.begin(file); });
}

}  // namespace

void add_studio_command(CLI::App& program, Run& run) {
  auto options = std::make_shared<StudioOptions>();
  CLI::App& command = *program.add_subcommand("studio", "Describe, watch and control a render in the browser");
  command.add_option("FILE", options->file, "The render description (.etd, or .json); none: an empty one")->type_name("");
  command.add_flag("--no-browser", options->no_browser, "Only print the address");
  command.add_flag("--read-only", options->read_only, "Show it only: pages can change nothing");
  command
      .add_option("--allow-path", options->allowed,
                  "A folder that pages may read and write, beside the file's and the working one; may be repeated")
      ->type_name("FOLDER")
      ->allow_extra_args(false);
  command.add_option("--port", options->port, "Port; 0: any that is free")
      ->type_name("N")
      ->check(CLI::Range(0, 65535).description(""));
  command.add_option("--listen", options->listen, "Let others in, at this address of the machine; needs a password")
      ->type_name("ADDRESS");
  command
      .add_option("--password-file", options->password_file, "File with the password; else it is in ETENDUE_STUDIO_PASSWORD")
      ->type_name("FILE");
  command.add_option("--page", options->page, "Another page")->type_name("FILE")->group("");
  command.add_option("--plugin", options->plugins, "Load a shared library of further classes; may be repeated")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command.add_option("--threads", options->threads, "Threads to use; 0: all cores")
      ->type_name("N")
      ->check(CLI::Range(0, 4096).description(""));
  command.callback([options, &run] { run = [options] { return run_studio(*options); }; });
  add_view_command(program, run);
}

}  // namespace etendue
