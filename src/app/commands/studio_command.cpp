// etendue studio [FILE]: describe, watch and control a render in a browser.

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "app/commands.h"
#include "app/text.h"
#include "etendue/describe/registry.h"
#include "studio/server/server.h"

namespace etendue {

namespace {

namespace fs = std::filesystem;

struct StudioOptions {
  std::string file, listen, password_file, page;
  std::vector<std::string> allowed, plugins;
  int port = 0, threads = 0;
  bool no_browser = false, read_only = false;
};

/// The page: beside the program as it is built, or as it is installed.
std::string page_file() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const char* place : {"studio/index.html", "../share/etendue/studio/index.html"})
    if (fs::is_regular_file(program / place, error)) return (program / place).lexically_normal().string();
  return (program / "studio/index.html").string();
}

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

/// Has the system open an address; nothing is said when it cannot.
void open_browser(const std::string& address) {
  if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY")) return;
  const pid_t child = fork();
  if (child != 0) {
    if (child > 0) waitpid(child, nullptr, 0);
    return;
  }
  if (fork() != 0) _exit(0);  // the grandchild is nobody's to wait for
  const int nowhere = ::open("/dev/null", O_RDWR);
  for (int stream = 0; stream < 3; ++stream) dup2(nowhere, stream);
  execlp("xdg-open", "xdg-open", address.c_str(), static_cast<char*>(nullptr));
  _exit(0);
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
  server_settings.page = options.page.empty() ? page_file() : options.page;
  if (!options.listen.empty()) {
    server_settings.address = options.listen;
    server_settings.password = password(options);
    fmt::print(
        stderr,
        "warning: others can reach this studio at {}. What they send and see, the password too, goes unencrypted: through "
        "strange networks use a tunnel, such as ssh -L.\n",
        options.listen);
  }

  // Ctrl-C ends it in order; a thread of its own waits for it, so that no handler has to be careful.
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::signal(SIGPIPE, SIG_IGN);

  studio::Studio studio(std::move(settings));
  studio.begin(options.file);
  studio::Server server(studio, std::move(server_settings));
  studio.on_shutdown = [&] { kill(getpid(), SIGTERM); };
  std::thread waiter([&] {
    int signal = 0;
    sigwait(&signals, &signal);
    server.stop();
  });
  fmt::print("{}\n", server.address());
  std::fflush(stdout);
  if (!options.no_browser) open_browser(server.address());
  server.run();
  kill(getpid(), SIGTERM);  // in case it ended by itself
  waiter.join();
  if (const std::string aside = studio.end(); !aside.empty()) fmt::print(stderr, "What was not saved is in {}\n", aside);
  return exit_status::done;
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
}

}  // namespace etendue
