// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Proof that a piece of code makes no system call, for test executables.
///
///   rt_guard::SyscallScope scope;
///   manager.update(now, period);
///   EXPECT_FALSE(scope.called()) << "system call " << scope.number();
///
/// The kernel's syscall user dispatch (Linux 5.11, x86-64) turns the first system call of the
/// thread into a signal; the call is then executed, and later ones of the scope are not seen. Calls
/// that do not enter the kernel (reading the clock) do not count. If the kernel lacks this feature,
/// available() is false and no call is seen.

#include <signal.h>
#include <sys/prctl.h>
#include <ucontext.h>

#include <cstring>

namespace rt_guard {

namespace internal {
constexpr int kSyscallUserDispatch = 59;  // PR_SET_SYSCALL_USER_DISPATCH of linux/prctl.h
constexpr char kAllow = 0;                // SYSCALL_DISPATCH_FILTER_ALLOW
constexpr char kBlock = 1;                // SYSCALL_DISPATCH_FILTER_BLOCK

inline thread_local volatile char syscall_filter = kAllow;
inline thread_local volatile int first_syscall = -1;

#ifdef __x86_64__
inline void onSyscall(int /*signal*/, siginfo_t* info, void* context) {
  syscall_filter = kAllow;
  first_syscall = info->si_syscall;
  // Back to the instruction (two bytes), with its number, so that it is executed now.
  greg_t* const registers = static_cast<ucontext_t*>(context)->uc_mcontext.gregs;
  registers[REG_RIP] -= 2;
  registers[REG_RAX] = info->si_syscall;
}

inline bool watchThread() {
  struct sigaction action;
  std::memset(&action, 0, sizeof(action));
  action.sa_sigaction = onSyscall;
  action.sa_flags = SA_SIGINFO;
  return sigaction(SIGSYS, &action, nullptr) == 0 &&
         prctl(kSyscallUserDispatch, 1UL, 0UL, 0UL, &syscall_filter) == 0;
}
#else
inline bool watchThread() { return false; }
#endif
}  // namespace internal

/// Watches the thread that makes it, while it lives. Scopes do not nest.
class SyscallScope {
 public:
  static bool available() {
    static thread_local const bool available = internal::watchThread();
    return available;
  }

  SyscallScope() {
    if (available()) {
      internal::first_syscall = -1;
      internal::syscall_filter = internal::kBlock;
    }
  }
  ~SyscallScope() { internal::syscall_filter = internal::kAllow; }
  SyscallScope(const SyscallScope&) = delete;
  SyscallScope& operator=(const SyscallScope&) = delete;

  bool called() const { return internal::first_syscall >= 0; }
  /// Of the first call, as in asm/unistd.h; -1 if there was none.
  int number() const { return internal::first_syscall; }
};

}  // namespace rt_guard
