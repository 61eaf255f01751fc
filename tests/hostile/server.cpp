// Runs the program many times without starting it anew each time, which takes most of the time of a run on a small file:
//
//     LD_PRELOAD=libhostile_server.so ETENDUE_SERVER_LOADS=…/libetendue_openimageio.so etendue
//
// Its libraries are loaded and the table of sRGB spectra is computed, then, in place of main(), lines are read from standard
// input. Each line holds a folder, a file for the output, a number of bytes of memory or 0, and the arguments, separated by the
// character 31. For each line a child process changes to the folder and calls main() with the arguments: it behaves like a
// fresh process, and leaves no trace in this one. The answers on standard output are "pid N", at once, and "status S seconds T
// kilobytes K", at the end (see attack.py).

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include "etendue/describe/color.h"

namespace {

using Main = int (*)(int, char**, char**);
Main program_main = nullptr;

std::vector<std::string> parts_of(const std::string& line) {
  std::vector<std::string> parts(1);
  for (const char c : line) {
    if (c == '\x1f')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

/// Lets the writable memory grow by this much. (The address space of a program with sanitizers is terabytes.)
void limit_memory(unsigned long long bytes) {
  std::FILE* const file = std::fopen("/proc/self/statm", "r");
  unsigned long long pages[6] = {};
  for (unsigned long long& number : pages)
    if (std::fscanf(file, "%llu", &number) != 1) std::abort();
  std::fclose(file);
  const rlim_t most = pages[5] * static_cast<unsigned long long>(::sysconf(_SC_PAGESIZE)) + bytes;  // data and stacks
  const rlimit limit{most, most};
  if (::setrlimit(RLIMIT_DATA, &limit) != 0) std::abort();
}

[[noreturn]] void be_child(std::vector<std::string>& parts, char* name, char** environment) {
  const int nothing = ::open("/dev/null", O_RDONLY), out = ::open(parts[1].c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (::chdir(parts[0].c_str()) != 0 || nothing < 0 || out < 0) std::abort();
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(out, STDOUT_FILENO);
  ::dup2(out, STDERR_FILENO);
  ::close(nothing);
  ::close(out);
  if (const unsigned long long bytes = std::stoull(parts[2])) limit_memory(bytes);
  std::vector<char*> arguments{name};
  for (size_t i = 3; i < parts.size(); ++i) arguments.push_back(parts[i].data());
  arguments.push_back(nullptr);
  const int status = program_main(int(arguments.size()) - 1, arguments.data(), environment);
  std::cout.flush();
  std::fflush(nullptr);
  // At a normal exit, loaded libraries would wait for threads that exist only in the server.
  ::_exit(status);
}

void say(const std::string& text) {
  if (::write(STDOUT_FILENO, text.data(), text.size()) != ssize_t(text.size())) std::abort();
}

int serve(int, char** arguments, char** environment) {
  ::unsetenv("LD_PRELOAD");  // for programs that it may start
  if (const char* const library = std::getenv("ETENDUE_SERVER_LOADS"); library && !dlopen(library, RTLD_LAZY | RTLD_LOCAL)) {
    std::cerr << dlerror() << '\n';
    return 1;
  }
  // The table of spectra of RGB colours is the same for all, and takes longer than the rest of most runs.
  etendue::rgb_coefficients(etendue::rgb_space("srgb"), 0.1F, 0.2F, 0.3F);
  for (std::string line; std::getline(std::cin, line);) {
    std::vector<std::string> parts = parts_of(line);
    if (parts.size() < 3) return 1;
    const pid_t child = ::fork();
    if (child == 0) be_child(parts, arguments[0], environment);
    say("pid " + std::to_string(child) + "\n");
    int status = 0;
    rusage used{};
    ::wait4(child, &status, 0, &used);
    const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
    say("status " + std::to_string(WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status)) + " seconds " +
        std::to_string(seconds(used.ru_utime) + seconds(used.ru_stime)) + " kilobytes " + std::to_string(used.ru_maxrss) +
        "\n");
  }
  return 0;
}

}  // namespace

/// The start code of every program calls this function with its main(); this definition precedes the C library's.
extern "C" int __libc_start_main(Main main, int count, char** arguments, void (*init)(), void (*fini)(), void (*end)(),
                                 void* stack) {
  using Start = int (*)(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);
  const auto start = reinterpret_cast<Start>(dlsym(RTLD_NEXT, "__libc_start_main"));
  program_main = main;
  return start(serve, count, arguments, init, fini, end, stack);
}
