#include "limit_process.h"

#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace etendue::apart {
namespace {

void limit(__rlimit_resource resource, std::uint64_t value) {
  rlimit wanted{};
  ::getrlimit(resource, &wanted);
  wanted.rlim_cur = std::min<rlim_t>({wanted.rlim_cur, wanted.rlim_max, value});  // a lower limit stays
  wanted.rlim_max = wanted.rlim_cur;
  ::setrlimit(resource, &wanted);
}

/// From here on the kernel refuses sockets and the execution of other programs.
void forbid_calls() {
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  constexpr std::uint32_t refused = SECCOMP_RET_ERRNO | 1;  // EPERM
  constexpr unsigned calls[] = {SYS_socket, SYS_connect, SYS_execve, SYS_execveat, SYS_ptrace, SYS_kill};
  constexpr unsigned char count = sizeof calls / sizeof calls[0];
  std::vector<sock_filter> program;
  program.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)));
  for (unsigned char i = 0; i < count; ++i)
    program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, calls[i], static_cast<unsigned char>(count - i), 0));
  program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
  program.push_back(BPF_STMT(BPF_RET | BPF_K, refused));
  const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
  ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter, 0, 0);
}

}  // namespace

void limit_process(std::uint64_t memory, std::uint64_t seconds) {
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_AS, memory);
  limit(RLIMIT_CPU, seconds);
  ::close_range(3, ~0u, 0);
  forbid_calls();
}

}  // namespace etendue::apart
