#include "plugin_probe.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>

#include "etendue/core/error.h"
#include "guard.h"

namespace etendue {
namespace {

constexpr std::chrono::seconds time_limit{10};
constexpr size_t longest_text = 4096;

// ---- the child --------------------------------------------------------------------------------------------------------
// The child writes 'A' if the library may be used, and 'D' after its classes were registered; or 'E' and an error message.

void say(int to, std::string_view all) {
  for (size_t sent = 0; sent < all.size();) {
    const ssize_t n = ::write(to, all.data() + sent, all.size() - sent);
    if (n > 0)
      sent += size_t(n);
    else if (errno != EINTR)
      break;
  }
}

/// The text returned by a function of the library itself, not of a library it uses. Null: there is no such function.
const char* text_of(void* handle, const std::string& file, const char* name) {
  using TextFunction = const char* (*)();
  const auto function = reinterpret_cast<TextFunction>(dlsym(handle, name));
  Dl_info where{};
  std::error_code error;
  const bool own = function && dladdr(reinterpret_cast<void*>(function), &where) && where.dli_fname &&
                   std::filesystem::equivalent(where.dli_fname, file, error);
  return own ? function() : nullptr;
}

PluginAnswer ask(const std::string& file) {
  void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!handle) throw Error(fmt::format("it cannot be opened: {}", dlerror()));
  const char* abi = text_of(handle, file, "etendue_plugin_abi");
  if (!abi) throw Error("it is not an Étendue plugin: it was not built with etendue/describe/description.h");
  const char* instructions = text_of(handle, file, "etendue_plugin_instructions");
  return {std::string(abi, strnlen(abi, longest_text)),
          instructions ? std::string(instructions, strnlen(instructions, longest_text)) : std::string()};
}

[[noreturn]] void be_child(const std::string& file, const std::function<void(const PluginAnswer&)>& accept,
                           const std::function<void()>& use, int to) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  for (const int signal : {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT, SIGINT, SIGTERM, SIGHUP, SIGALRM})
    ::signal(signal, SIG_DFL);
  // Output of the library and messages of the dynamic loader are suppressed.
  const int nowhere = ::open("/dev/null", O_RDWR);
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (standard != to) ::dup2(nowhere, standard);
  try {
    accept(ask(file));
    say(to, "A");
    use();
    say(to, "D");
  } catch (...) {
    say(to, "E" + thrown_text());
  }
  ::_exit(0);
}

// ---- the parent -------------------------------------------------------------------------------------------------------

/// Reads until the other end is closed; false: time limit exceeded.
bool receive(int from, std::string& text) {
  const auto end = std::chrono::steady_clock::now() + time_limit;
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now()).count();
    if (left <= 0) return false;
    pollfd wait{from, POLLIN, 0};
    const int ready = ::poll(&wait, 1, int(left));
    if (ready < 0 && errno != EINTR) return true;
    if (ready <= 0) continue;
    char part[4096];
    const ssize_t got = ::read(from, part, sizeof part);
    if (got == 0 || (got < 0 && errno != EINTR && errno != EAGAIN)) return true;
    if (got > 0 && text.size() < 8 * longest_text) text.append(part, size_t(got));
  }
}

}  // namespace

void try_plugin(const std::string& file, const std::function<void(const PluginAnswer&)>& accept,
                const std::function<void()>& use) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw Error(fmt::format("it cannot be checked: {}", std::strerror(errno)));
  const pid_t child = ::fork();
  if (child < 0) {
    const int reason = errno;
    ::close(ends[0]);
    ::close(ends[1]);
    throw Error(fmt::format("it cannot be checked: {}", std::strerror(reason)));
  }
  if (child == 0) {
    ::close(ends[0]);
    be_child(file, accept, use, ends[1]);
  }
  ::close(ends[1]);
  std::string said;
  const bool in_time = receive(ends[0], said);
  ::close(ends[0]);
  if (!in_time) ::kill(child, SIGKILL);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  const bool accepted = said.starts_with('A');
  if (accepted) said.erase(0, 1);
  if (said.starts_with('E')) throw Error(said.substr(1));
  // A forked child has only one thread, so constructors that use several threads may wait forever: this is not taken as a
  // fault.
  if (said == "D" || (accepted && !in_time)) return;
  const char* when = accepted ? "its classes were described and made" : "it was opened and asked what it was built for";
  if (!in_time) throw Error(fmt::format("no answer within {} seconds when {}", time_limit.count(), when));
  if (WIFSIGNALED(status))
    throw Error(
        fmt::format("it crashed when {} ({}): the file is damaged, or its code is wrong", when, strsignal(WTERMSIG(status))));
  throw Error(fmt::format("it ended the process when {}: it is not an Étendue plugin, or its code is wrong", when));
}

}  // namespace etendue
