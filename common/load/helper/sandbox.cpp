#include "common/load/helper/sandbox.h"

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "common/base/files/unique_fd.h"

namespace palpate {
namespace {

// Rights of Landlock by the version that brought them; headers may be older than the kernel.
constexpr std::uint64_t kRefer = std::uint64_t{1} << 13U;     // 2: to move or link into another folder
constexpr std::uint64_t kTruncate = std::uint64_t{1} << 14U;  // 3

std::uint64_t rights_to_change(int version) {
  std::uint64_t rights = LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_REMOVE_DIR |
                         LANDLOCK_ACCESS_FS_REMOVE_FILE | LANDLOCK_ACCESS_FS_MAKE_CHAR |
                         LANDLOCK_ACCESS_FS_MAKE_DIR | LANDLOCK_ACCESS_FS_MAKE_REG |
                         LANDLOCK_ACCESS_FS_MAKE_SOCK | LANDLOCK_ACCESS_FS_MAKE_FIFO |
                         LANDLOCK_ACCESS_FS_MAKE_BLOCK | LANDLOCK_ACCESS_FS_MAKE_SYM;
  if (version >= 2) rights |= kRefer;
  if (version >= 3) rights |= kTruncate;
  return rights;
}

bool keep_from_files(std::span<const std::filesystem::path> writable) {
  const auto version =
      static_cast<int>(::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION));
  if (version < 1) return false;
  landlock_ruleset_attr rules{};
  rules.handled_access_fs = rights_to_change(version);
  const UniqueFd set(
      static_cast<int>(::syscall(SYS_landlock_create_ruleset, &rules, sizeof rules.handled_access_fs, 0)));
  if (!set) return false;
  for (const auto& folder : writable) {
    const UniqueFd at(::open(folder.c_str(), O_PATH | O_CLOEXEC));
    if (!at) continue;
    landlock_path_beneath_attr rule{};
    rule.allowed_access = rules.handled_access_fs;
    rule.parent_fd = at.get();
    (void)::syscall(SYS_landlock_add_rule, set.get(), LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
  }
  return ::syscall(SYS_landlock_restrict_self, set.get(), 0) == 0;
}

#if defined(__x86_64__)
constexpr std::uint32_t kMachine = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t kMachine = AUDIT_ARCH_AARCH64;
#else
constexpr std::uint32_t kMachine = 0;
#endif

// Calls that lead out of the process. socketpair stays: both its ends are here.
constexpr std::array kRefused{SYS_socket,
                              SYS_connect,
                              SYS_bind,
                              SYS_listen,
                              SYS_accept,
                              SYS_accept4,
                              SYS_execve,
                              SYS_execveat,
                              SYS_ptrace,
                              SYS_process_vm_readv,
                              SYS_process_vm_writev,
                              SYS_pidfd_open,
                              SYS_pidfd_getfd,
                              SYS_pidfd_send_signal,
                              SYS_io_uring_setup,
                              SYS_bpf,
                              SYS_mount,
                              SYS_umount2,
#ifdef SYS_chmod  // newer machines have the calls with a folder alone
                              SYS_chmod,
                              SYS_chown,
                              SYS_lchown,
#endif
                              SYS_fchmod,
                              SYS_fchmodat,
                              SYS_fchownat,
                              SYS_setxattr};

bool keep_from_others() {
  if (kMachine == 0) return false;
  const auto jump = [](std::uint32_t test, std::uint32_t value, std::uint8_t yes, std::uint8_t no) {
    return sock_filter{static_cast<std::uint16_t>(BPF_JMP | test | BPF_K), yes, no, value};
  };
  const auto load = [](std::size_t at) {
    return sock_filter{BPF_LD | BPF_W | BPF_ABS, 0, 0, static_cast<std::uint32_t>(at)};
  };
  constexpr sock_filter refuse{BPF_RET | BPF_K, 0, 0, SECCOMP_RET_ERRNO | EACCES};
  constexpr sock_filter allow{BPF_RET | BPF_K, 0, 0, SECCOMP_RET_ALLOW};
  std::vector<sock_filter> filter;
  filter.push_back(load(offsetof(seccomp_data, arch)));
  filter.push_back(jump(BPF_JEQ, kMachine, 1, 0));
  filter.push_back(refuse);
  filter.push_back(load(offsetof(seccomp_data, nr)));
  // x86's calls of 32-bit pointers have numbers of their own.
  filter.push_back(jump(BPF_JGE, 0x40000000U, 0, 1));
  filter.push_back(refuse);
  for (const auto call : kRefused) {
    filter.push_back(jump(BPF_JEQ, static_cast<std::uint32_t>(call), 0, 1));
    filter.push_back(refuse);
  }
  // Signals to itself alone: abort() sends one.
  const auto self = static_cast<std::uint32_t>(::getpid());
  for (const auto call : {SYS_kill, SYS_tgkill}) {
    filter.push_back(jump(BPF_JEQ, static_cast<std::uint32_t>(call), 0, 4));
    filter.push_back(load(offsetof(seccomp_data, args)));
    filter.push_back(jump(BPF_JEQ, self, 0, 1));
    filter.push_back(allow);
    filter.push_back(refuse);
  }
  filter.push_back(allow);
  const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  return ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

}  // namespace

Sandbox enter_sandbox(std::span<const std::filesystem::path> writable) noexcept {
  Sandbox sandbox;
  // Without it neither is for a user who is not root; with it no program gains rights by being started.
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return sandbox;
  sandbox.files = keep_from_files(writable);
  sandbox.network = keep_from_others();
  return sandbox;
}

}  // namespace palpate
