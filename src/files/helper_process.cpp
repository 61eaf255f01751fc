#include "helper_process.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>

#include "etendue/core/error.h"
#include "files/regular_file.h"

extern char** environ;

namespace etendue {
namespace {

/// Limit of the elapsed time; the helper limits its CPU time itself.
constexpr int most_seconds = 300;

struct Pipe {
  int read = -1, write = -1;
  Pipe() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw Error(std::strerror(errno));
    read = ends[0];
    write = ends[1];
  }
  ~Pipe() {
    if (read >= 0) ::close(read);
    close_write();
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void close_write() {
    if (write >= 0) ::close(write);
    write = -1;
  }
};

/// An anonymous file in memory that contains the bytes.
class Input {
 public:
  explicit Input(std::string_view bytes) {
    if (bytes.empty()) return;
    file_ = ::memfd_create("input", MFD_CLOEXEC);
    if (file_ < 0) throw Error(std::strerror(errno));
    for (size_t done = 0; done < bytes.size();) {
      const ssize_t written = ::write(file_, bytes.data() + done, bytes.size() - done);
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) {
        const int reason = errno;
        ::close(file_);
        throw Error(std::strerror(reason));
      }
      done += size_t(written);
    }
    ::lseek(file_, 0, SEEK_SET);
  }
  ~Input() {
    if (file_ >= 0) ::close(file_);
  }
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;

  /// Negative: there is no input.
  int file() const { return file_; }

 private:
  int file_ = -1;
};

pid_t spawn(const std::string& path, const std::vector<std::string>& arguments, const Input& input, const Pipe& out,
            const Pipe& said) {
  std::vector<char*> list{const_cast<char*>(path.c_str())};
  for (const std::string& argument : arguments) list.push_back(const_cast<char*>(argument.c_str()));
  list.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (input.file() >= 0)
    posix_spawn_file_actions_adddup2(&actions, input.file(), 0);
  else
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, out.write, 1);
  posix_spawn_file_actions_adddup2(&actions, said.write, 2);
  pid_t child = 0;
  const int failed = ::posix_spawnp(&child, path.c_str(), &actions, nullptr, list.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) throw NotStarted("'" + path + "' cannot be started: " + std::strerror(failed));
  return child;
}

/// Reads both pipes until they end; false: it took too long, or the output was too large.
bool collect(const Pipe& out, const Pipe& said, std::string& bytes, std::string& words) {
  const auto begin = std::chrono::steady_clock::now();
  constexpr std::uint64_t most = std::uint64_t(1) << 32;
  pollfd waiting[2] = {{out.read, POLLIN, 0}, {said.read, POLLIN, 0}};
  std::vector<char> some(1 << 16);
  while (waiting[0].fd >= 0 || waiting[1].fd >= 0) {
    const auto passed = std::chrono::duration_cast<std::chrono::seconds>(std::chrono::steady_clock::now() - begin).count();
    if (passed >= most_seconds || bytes.size() > most) return false;
    if (::poll(waiting, 2, 1000) < 0 && errno != EINTR) return false;
    for (pollfd& one : waiting) {
      if (one.fd < 0 || one.revents == 0) continue;
      const ssize_t got = ::read(one.fd, some.data(), some.size());
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) {
        one.fd = -1;
        continue;
      }
      std::string& to = &one == &waiting[0] ? bytes : words;
      if (&one == &waiting[0] || words.size() < 4096) to.append(some.data(), size_t(got));
    }
  }
  return true;
}

/// The helper's error output, in one line of printable characters.
std::string one_line(std::string words) {
  while (!words.empty() && (words.back() == '\n' || words.back() == ' ')) words.pop_back();
  for (char& c : words)
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = ' ';
  constexpr size_t half = 200;  // the cause may be at the beginning, or after the messages that led to it
  if (words.size() > 2 * half) words = words.substr(0, half) + " … " + words.substr(words.size() - half);
  return words;
}

/// The message for a helper that was ended by a signal. This does not prove the file wrong: the third-party libraries in the
/// helper have faults that correct files can trigger, too.
std::string fault(const std::string& program, int signal) {
  std::string text = fmt::format(
      "its reader {}, which calls other people's code, was ended by signal {} ({}): the file may well be right. Another format "
      "of the same model may be read, best glTF (.glb)",
      program, signal, ::strsignal(signal));
  rlimit memory{};
  if (::getrlimit(RLIMIT_AS, &memory) == 0 && memory.rlim_cur != RLIM_INFINITY)
    text += fmt::format(". It may also have run out of memory, of which it had {} MB (ulimit -v)", memory.rlim_cur >> 20);
  return text;
}

}  // namespace

std::string helper_path(const std::string& name) {
  Dl_info own{};
  if (!::dladdr(reinterpret_cast<void*>(&helper_path), &own) || !own.dli_fname) return {};
  const std::filesystem::path folder = std::filesystem::absolute(own.dli_fname).parent_path();
  std::error_code none;
  for (const char* way : {".", "../libexec/etendue", "../../libexec/etendue"}) {
    const std::filesystem::path path = folder / way / name;
    if (std::filesystem::is_regular_file(path, none)) return path.lexically_normal().string();
  }
  return {};
}

std::string run_helper(const std::string& name, const std::vector<std::string>& arguments, std::string_view input) {
  const std::string path = helper_path(name);
  if (path.empty()) throw Error("the program '" + name + "', which reads such files, is not there: build and install it too");
  return run_program(path, arguments, name, input);
}

std::string run_program(const std::string& path, const std::vector<std::string>& arguments, const std::string& shown_as,
                        std::string_view input) {
  Pipe out, said;
  const pid_t child = spawn(path, arguments, Input(input), out, said);
  out.close_write();
  said.close_write();
  std::string bytes, words;
  bool ended = false;
  try {
    ended = collect(out, said, bytes, words);
  } catch (const std::bad_alloc&) {
  }
  if (!ended) ::kill(child, SIGKILL);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  words = one_line(std::move(words));
  if (!ended) throw Error("reading it takes too long, or too much memory");
  if (WIFSIGNALED(status)) {
    if (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL) throw Error("reading it takes too long");
    throw Error(fault(shown_as, WTERMSIG(status)) + (words.empty() ? "" : "; it said: " + words));
  }
  if (WEXITSTATUS(status) != 0) throw Error(words.empty() ? shown_as + " cannot read it" : words);
  return bytes;
}

}  // namespace etendue
