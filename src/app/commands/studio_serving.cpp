// Runs the studio's server in this process: signals, the browser, shutdown and restart.

#include "studio_serving.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "app/commands.h"
#include "app/program_team.h"
#include "app/python_plugins.h"
#include "check/warnings/advice.h"
#include "check/warnings/scene_warnings.h"

namespace etendue {

namespace {

namespace fs = std::filesystem;

/// The environment variable that passes the port, the token (which open pages use) and the file to the restarted program.
constexpr const char* again_variable = "ETENDUE_STUDIO_AGAIN";

/// The signal that the program sends to itself to shut down. After signals of other processes it does not restart.
constexpr int to_itself = SIGUSR1;

/// The page's path: next to the program in the build folder, or as installed.
std::string page_file() {
  std::error_code error;
  const fs::path program = program_folder();
  for (const char* place : {"studio/index.html", "../share/etendue/studio/index.html", "../../share/etendue/studio/index.html"})
    if (fs::is_regular_file(program / place, error)) return (program / place).lexically_normal().string();
  return (program / "studio/index.html").string();
}

/// Opens an address in the system's browser; failure is not reported.
void open_browser(const std::string& address) {
  if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY")) return;
  const pid_t child = fork();
  if (child != 0) {
    if (child > 0) waitpid(child, nullptr, 0);
    return;
  }
  if (fork() != 0) _exit(0);  // the grandchild is adopted by init, so no zombie remains
  const int nowhere = ::open("/dev/null", O_RDWR);
  for (int stream = 0; stream < 3; ++stream) dup2(nowhere, stream);
  execlp("xdg-open", "xdg-open", address.c_str(), static_cast<char*>(nullptr));
  _exit(0);
}

std::vector<std::string> own_arguments() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> list;
  for (std::string one; std::getline(file, one, '\0');) list.push_back(one);
  return list;
}

/// Replaces this process by a new start of the program, with the same address and file, so that plugins are loaded anew.
[[noreturn]] void begin_again(const std::string& port_and_token, const std::string& file) {
  setenv(again_variable, (port_and_token + " " + file).c_str(), 1);
  close_range(3, ~0U, CLOSE_RANGE_CLOEXEC);  // among them the listening socket
  std::vector<std::string> arguments = own_arguments();
  std::vector<char*> list;
  for (std::string& a : arguments) list.push_back(a.data());
  list.push_back(nullptr);
  // A pending signal would be delivered to the new program. So the program's own signal is consumed; a pending SIGINT or
  // SIGTERM ends the process when it is unblocked here.
  sigset_t own_end, none;
  sigemptyset(&none);
  sigemptyset(&own_end);
  sigaddset(&own_end, to_itself);
  const timespec at_once{};
  while (sigtimedwait(&own_end, nullptr, &at_once) > 0) continue;
  pthread_sigmask(SIG_SETMASK, &none, nullptr);
  execv("/proc/self/exe", list.data());
  throw Error("the program could not be restarted");
}

/// Reads "PORT TOKEN FILE" of a restart and removes the variable, as the token is secret. Returns the file; empty: no restart,
/// or no file.
std::string take_over(studio::ServerSettings& settings) {
  const char* text = std::getenv(again_variable);
  if (!text) return {};
  std::istringstream again(text);
  unsetenv(again_variable);
  std::string file;
  again >> settings.port >> settings.token;
  std::getline(again >> std::ws, file);
  return file;
}

}  // namespace

int serve(studio::StudioSettings settings, studio::ServerSettings server_settings, bool browser,
          const std::function<void(studio::Studio&)>& begin) {
  if (server_settings.page.empty()) server_settings.page = page_file();
  refuse_restarts();
  const std::string file = take_over(server_settings);
  const bool again = !server_settings.token.empty();
  settings.warnings = [](const Job& job) {
    std::vector<std::pair<std::string, Error>> list;
    for (const SceneWarning& w : scene_warnings(job)) list.emplace_back(w.kind, Error(w.text, w.at));
    return list;
  };
  settings.advice = [](const Job& job) { return advice_lines(job); };

  // SIGINT and SIGTERM shut the server down. A thread waits for them, so the code is not limited to what is safe in a signal
  // handler.
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, to_itself);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::signal(SIGPIPE, SIG_IGN);

  studio::Studio studio(std::move(settings));
  if (file.empty())
    begin(studio);
  else
    studio.begin(file);
  studio::Server server(studio, std::move(server_settings));
  studio.on_shutdown = [&] { kill(getpid(), to_itself); };
  bool by_others = false;
  std::thread waiter([&] {
    int signal = 0;
    sigwait(&signals, &signal);
    by_others = signal != to_itself;
    server.stop();
  });
  fmt::print("{}\n", server.address());
  std::fflush(stdout);
  if (browser && !again) open_browser(server.address());
  server.run();
  kill(getpid(), to_itself);  // wakes the waiter if the server has ended without a signal
  waiter.join();
  // While the scene is still being loaded nothing can have been edited, and loading cannot be interrupted.
  if (by_others && studio.beginning()) std::_Exit(exit_status::done);
  if (const std::string aside = studio.end(); !aside.empty()) fmt::print(stderr, "Unsaved changes are in {}\n", aside);
  if (studio.begin_again && !by_others && join_team())
    fmt::print(stderr,
               "The processes that mpirun or srun has started cannot start again by themselves: start the studio anew.\n");
  else if (studio.begin_again && !by_others)
    begin_again(server.port_and_token(), studio.document().file());
  return exit_status::done;
}

}  // namespace etendue
