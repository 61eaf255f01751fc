// etendue studio [FILE]: edits, shows and controls a render in a browser.

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "app/commands.h"
#include "app/common_options.h"
#include "app/program_team.h"
#include "app/python_plugins.h"
#include "app/text.h"
#include "etendue/language/language.h"
#include "files/regular_file.h"
#include "studio_serving.h"
#include "studio_team.h"

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

/// Loads the plugins written in Python that a file names. They restart the program within Python, which a studio that is open
/// refuses (python_plugins.h). Says nothing about a file that is wrong: the studio does.
void load_python_plugins_of(const std::string& file) {
  try {
    if (read_regular_file(file).find(".py\"") != std::string::npos) load_job(file, {});
  } catch (const std::exception&) {
  }
}

int run_studio(const StudioOptions& options) {
  load_plugins(options.plugins);
  if (!options.file.empty()) load_python_plugins_of(options.file);
  ProcessTeam* const team = join_team();
  if (team) refuse_restarts();
  if (team && !team->leads()) return follow_studio(*team, options.threads);
  studio::StudioSettings settings;
  if (team) lead_studio(*team);
  settings.render.team = team;
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
    fmt::print(stderr,
               "warning: others can reach this studio at {}. The connection, including the password, is not encrypted: in "
               "untrusted networks use a tunnel, such as ssh -L.\n",
               options.listen);
  }

  settings.plugins = options.plugins;
  for (std::string& plugin : settings.plugins) plugin = fs::absolute(plugin).string();
  const std::string file = options.file;
  return serve(std::move(settings), std::move(server_settings), !options.no_browser,
               [&](studio::Studio& studio) { studio.begin(file); });
}

}  // namespace

void add_studio_command(Command& program) {
  auto options = std::make_shared<StudioOptions>();
  Command command = program.add_command("studio", "Edit, watch and control a render in the browser");
  command.argument("FILE", options->file, "The render description (.etd, or .json); none: an empty one");
  command.flag("--no-browser", options->no_browser, "Only print the address");
  command.flag("--read-only", options->read_only, "Read only: pages cannot change anything");
  command.option("--allow-path FOLDER", options->allowed,
                 "A folder that pages may read and write, besides the file's and the working directory; may be repeated");
  command.option("--port N", options->port, "Port; 0: any free one").range(0, 65535);
  command.option("--listen ADDRESS", options->listen,
                 "Listen at this address, so that other machines can connect; needs a password");
  command.option("--password-file FILE", options->password_file,
                 "File with the password. Default: the variable ETENDUE_STUDIO_PASSWORD");
  command.option("--page FILE", options->page, "Another page").hidden();
  add_plugin_option(command, options->plugins);
  add_threads_option(command, options->threads);
  command.footer(
      "\nmpirun -n 8 etendue studio box.etd: the first process serves the page, and all of them render (docs/cluster.md).");
  command.runs([options] { return run_studio(*options); });
  add_view_command(program);
}

}  // namespace etendue
