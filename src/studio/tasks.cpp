#include "tasks.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>

#include "etendue/core/error.h"

namespace etendue::studio {

Tasks::~Tasks() {
  {
    const std::lock_guard lock(guard_);
    for (Running& r : running_) r.ended = true;
  }
  for (Running& r : running_) r.thread.join();
}

void Tasks::sweep() {
  running_.remove_if([](Running& r) {
    if (!r.told) return false;
    r.thread.join();
    return true;
  });
}

int Tasks::work(const std::string& title, std::function<Json(const Work&)> what) {
  constexpr size_t most = 2;
  const std::lock_guard lock(guard_);
  sweep();
  if (size_t(std::ranges::count_if(running_, [](const Running& r) { return !r.over; })) >= most)
    throw Error("two tasks are running already: wait until one is done, or end it");
  Running& entry = running_.emplace_back();
  entry.number = next_++;
  entry.thread = std::thread([this, &entry, title, what = std::move(what)] {
    constexpr size_t longest = 64 << 10;
    const Json head = {{"event", "task"}, {"task", entry.number}, {"title", title}};
    std::string text;
    double fraction = 0;
    Json last = head;
    const auto tell = [&] {
      Json event = head;
      event["state"] = "running";
      event["text"] = text;
      event["fraction"] = fraction;
      tell_(event);
    };
    const Work work{entry.ended,
                    [&](double f) {
                      fraction = f;
                      tell();
                    },
                    [&](const std::string& more) {
                      text += more;
                      // For very long output the end is most informative.
                      if (text.size() > longest) text = "…" + text.substr(text.size() - longest / 2);
                      tell();
                    }};
    try {
      tell();
      const Json result = what(work);
      last["state"] = entry.ended ? "ended" : "done";
      for (const auto& [key, value] : result.items()) last[key] = value;
    } catch (const std::exception& error) {
      last["state"] = entry.ended ? "ended" : "failed";
      text += error.what();
    }
    last["text"] = text;
    last["fraction"] = 1;
    entry.over = true;
    tell_(last);
    entry.told = true;
  });
  return entry.number;
}

void Tasks::end(int number) {
  const std::lock_guard lock(guard_);
  for (Running& r : running_)
    if (r.number == number && !r.over) {
      r.ended = true;
      return;
    }
  throw Error(fmt::format("there is no task {} that is running", number));
}

// ---- processes --------------------------------------------------------------------------------------------------------------

namespace {

/// A child process of this program; its output is read from `output`. It is killed when this object is destroyed.
struct Process {
  explicit Process(const std::vector<std::string>& arguments) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw Error("there are no more pipes to be had");
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&files, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files, ends[1], STDERR_FILENO);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t none, standard;  // signals are blocked and ignored in this program, but not in the child
    sigemptyset(&none);
    sigemptyset(&standard);
    sigaddset(&standard, SIGPIPE);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &standard);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    std::vector<char*> list;
    for (const std::string& a : arguments) list.push_back(const_cast<char*>(a.c_str()));
    list.push_back(nullptr);
    const int failed = posix_spawn(&number, "/proc/self/exe", &files, &attributes, list.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
    close(ends[1]);
    output = ends[0];
    if (failed == 0) return;
    close(output);
    throw Error("no process can be started");
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() {
    if (number > 0) {
      kill(number, SIGKILL);
      waitpid(number, nullptr, 0);
    }
    close(output);
  }
  /// Its exit status; negative if a signal ended it.
  int wait() {
    int status = 0;
    waitpid(number, &status, 0);
    number = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  pid_t number = 0;
  int output = -1;
};

}  // namespace

int Tasks::run(const std::string& title, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "etendue");
  return work(title, [arguments = std::move(arguments)](const Work& work) -> Json {
    Process process(arguments);
    std::vector<char> some(64 << 10);
    while (!work.ended) {
      pollfd ready{process.output, POLLIN, 0};
      if (poll(&ready, 1, 100) <= 0) continue;
      const ssize_t count = read(process.output, some.data(), some.size());
      if (count <= 0) break;
      work.say(std::string(some.data(), size_t(count)));
    }
    if (work.ended) return Json::object();
    const int status = process.wait();
    if (status < 0) throw Error(fmt::format("\n(it was ended by signal {})", -status));
    return {{"status", status}, {"passed", status == 0}};
  });
}

}  // namespace etendue::studio
