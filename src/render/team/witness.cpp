#include "witness.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <string>
#include <utility>

extern char** environ;

namespace etendue {
namespace {

// $1: the folder, $2: the file, $3: the text, $4: the process that started ours, which has a second to notice. A process that
// has ended and that nobody collects, as in containers without an init, has no command line.
constexpr const char* script = R"(
read -r word
[ "$word" = done ] && exit
[ -n "$1" ] && rm -rf -- "$1"
[ -n "$2" ] || exit
sleep 1
if [ -r /proc/self/cmdline ]; then
  grep -q . "/proc/$4/cmdline" 2>/dev/null && exit
else
  kill -0 "$4" 2>/dev/null && exit
fi
printf '%s\n' "$3" > "$2"
)";

}  // namespace

Witness::Witness(const Task& task) {
  if (!task.file.empty()) ::unlink(task.file.c_str());
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return;
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawnattr_init(&attributes);
  ::posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
    ::posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
#if __GLIBC_PREREQ(2, 34)
  // Else it would keep MPI's sockets open.
  ::posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1);
#endif
  // In a session of its own, as signals are sent to the group of this process; and these are what a shell expects.
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGMASK);
  sigset_t none;
  ::sigemptyset(&none);
  ::posix_spawnattr_setsigmask(&attributes, &none);
  std::array<std::string, 8> words{"sh",        "-c",      script,    "witness",
                                   task.remove, task.file, task.text, std::to_string(::getppid())};
  std::array<char*, 9> arguments{};
  for (size_t i = 0; i < words.size(); ++i) arguments[i] = words[i].data();
  pid_t process = -1;
  const bool started = ::posix_spawn(&process, "/bin/sh", &actions, &attributes, arguments.data(), environ) == 0;
  ::posix_spawn_file_actions_destroy(&actions);
  ::posix_spawnattr_destroy(&attributes);
  ::close(ends[0]);
  if (started) {
    pipe_ = ends[1];
    process_ = process;
  } else {
    ::close(ends[1]);
  }
}

void Witness::act() {
  if (pipe_ >= 0) ::close(std::exchange(pipe_, -1));
}

Witness::~Witness() {
  if (pipe_ < 0) return;
  constexpr std::array<char, 5> word{'d', 'o', 'n', 'e', '\n'};
  // It ends at once; if it was killed, SIGPIPE must not end this process.
  struct sigaction ignore{}, before{};
  ignore.sa_handler = SIG_IGN;
  ::sigaction(SIGPIPE, &ignore, &before);
  [[maybe_unused]] const ssize_t written = ::write(pipe_, word.data(), word.size());
  ::sigaction(SIGPIPE, &before, nullptr);
  ::close(pipe_);
  ::waitpid(process_, nullptr, 0);
}

}  // namespace etendue
