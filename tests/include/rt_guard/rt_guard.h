// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Proof that a piece of code neither allocates nor locks, for test executables.
///
/// The header *defines* malloc, free, pthread_mutex_lock and similar functions, so it sees every
/// call of the process, also from its shared libraries, before glibc. Therefore include it in
/// exactly one translation unit of an executable, and never in a library.
///
///   rt_guard::Scope scope;
///   manager.update(now, period);
///   EXPECT_EQ(0u, scope.allocations());
///   EXPECT_EQ(0u, scope.locks());
///
/// Only calls made by the thread that owns the scope, while it lives, are counted; scopes nest.
/// Built with a sanitizer (which owns malloc itself) nothing is interposed: kActive is then false
/// and all counts stay 0.

#include <dlfcn.h>
#include <pthread.h>
#include <time.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdlib>

// clang takes its own declaration of posix_memalign only before another one that is noexcept.
#if defined(__clang__) && __has_include(<mm_malloc.h>)
#include <mm_malloc.h>
#endif

namespace rt_guard {

struct Counts {
  std::size_t allocations{0};
  std::size_t locks{0};
  std::size_t sleeps{0};
};

namespace internal {

// Plain thread-local data without a constructor: access to it does not allocate, even in the first
// instructions of a thread.
static thread_local Counts* active = nullptr;

inline void countAllocation() {
  if (active != nullptr) {
    ++active->allocations;
  }
}

inline void countLock() {
  if (active != nullptr) {
    ++active->locks;
  }
}

inline void countSleep() {
  if (active != nullptr) {
    ++active->sleeps;
  }
}

/// The function that would have been called without this header. Condition variables exist twice in
/// glibc on x86-64, and an unversioned look-up may find the one from before 2.3.2: hence `version`.
template <typename Function>
Function next(std::atomic<void*>& cache, const char* name, const char* version) {
  void* found = cache.load(std::memory_order_acquire);
  if (found == nullptr) {
    if (version != nullptr) {
      found = dlvsym(RTLD_NEXT, name, version);
    }
    if (found == nullptr) {
      found = dlsym(RTLD_NEXT, name);
    }
    if (found == nullptr) {
      std::abort();
    }
    cache.store(found, std::memory_order_release);
  }
  return reinterpret_cast<Function>(found);
}

}  // namespace internal

/// Counts calls of its own thread from construction to destruction.
class Scope {
 public:
  Scope() : outer_(internal::active) { internal::active = &counts_; }
  ~Scope() {
    internal::active = outer_;
    if (outer_ != nullptr) {
      outer_->allocations += counts_.allocations;
      outer_->locks += counts_.locks;
      outer_->sleeps += counts_.sleeps;
    }
  }
  Scope(const Scope&) = delete;
  Scope& operator=(const Scope&) = delete;

  /// Calls of the allocator, for allocation or release.
  std::size_t allocations() const { return counts_.allocations; }
  /// Mutexes and read-write locks taken or tried, condition variables waited on or signaled.
  std::size_t locks() const { return counts_.locks; }
  /// Calls of the nanosleep family.
  std::size_t sleeps() const { return counts_.sleeps; }

 private:
  Counts counts_;
  Counts* outer_;
};

}  // namespace rt_guard

#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)

namespace rt_guard {
constexpr bool kActive = false;
}

#else

namespace rt_guard {
constexpr bool kActive = true;
}

// glibc's own entry points: calling them instead of looking malloc up avoids the recursion of a
// look-up that allocates.
extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier)  glibc's names
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);
// NOLINTEND(bugprone-reserved-identifier)

void* malloc(std::size_t size) noexcept {
  rt_guard::internal::countAllocation();
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) noexcept {
  rt_guard::internal::countAllocation();
  return __libc_calloc(count, size);
}

void* realloc(void* memory, std::size_t size) noexcept {
  rt_guard::internal::countAllocation();
  return __libc_realloc(memory, size);
}

void free(void* memory) noexcept {
  if (memory != nullptr) {
    rt_guard::internal::countAllocation();
  }
  __libc_free(memory);
}

void* memalign(std::size_t alignment, std::size_t size) noexcept {
  rt_guard::internal::countAllocation();
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  rt_guard::internal::countAllocation();
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  rt_guard::internal::countAllocation();
  if (alignment < sizeof(void*) || (alignment & (alignment - 1)) != 0) {
    return EINVAL;
  }
  void* result = __libc_memalign(alignment, size);
  if (result == nullptr) {
    return ENOMEM;
  }
  *memory = result;
  return 0;
}
}  // extern "C"

// One forwarding definition: counts, then calls the genuine function with the same arguments.
// NOLINTBEGIN(bugprone-macro-parentheses)  names and lists of parameters take no parentheses
#define RT_GUARD_FORWARD(count, version, name, specifier, parameters, arguments)  \
  extern "C" int name parameters specifier {                                      \
    static std::atomic<void*> genuine{nullptr};                                   \
    using Function = int(*) parameters;                                           \
    rt_guard::internal::count();                                                  \
    return rt_guard::internal::next<Function>(genuine, #name, version) arguments; \
  }
// NOLINTEND(bugprone-macro-parentheses)

RT_GUARD_FORWARD(countLock, nullptr, pthread_mutex_lock, noexcept, (pthread_mutex_t * mutex),
                 (mutex))
RT_GUARD_FORWARD(countLock, nullptr, pthread_mutex_trylock, noexcept, (pthread_mutex_t * mutex),
                 (mutex))
RT_GUARD_FORWARD(countLock, nullptr, pthread_mutex_timedlock, noexcept,
                 (pthread_mutex_t * mutex, const timespec* until), (mutex, until))
RT_GUARD_FORWARD(countLock, nullptr, pthread_rwlock_rdlock, noexcept, (pthread_rwlock_t * lock),
                 (lock))
RT_GUARD_FORWARD(countLock, nullptr, pthread_rwlock_wrlock, noexcept, (pthread_rwlock_t * lock),
                 (lock))
RT_GUARD_FORWARD(countLock, "GLIBC_2.3.2", pthread_cond_wait, ,
                 (pthread_cond_t * condition, pthread_mutex_t* mutex), (condition, mutex))
RT_GUARD_FORWARD(countLock, "GLIBC_2.3.2", pthread_cond_timedwait, ,
                 (pthread_cond_t * condition, pthread_mutex_t* mutex, const timespec* until),
                 (condition, mutex, until))
RT_GUARD_FORWARD(countLock, "GLIBC_2.3.2", pthread_cond_signal, noexcept,
                 (pthread_cond_t * condition), (condition))
RT_GUARD_FORWARD(countLock, "GLIBC_2.3.2", pthread_cond_broadcast, noexcept,
                 (pthread_cond_t * condition), (condition))
RT_GUARD_FORWARD(countSleep, nullptr, nanosleep, , (const timespec* duration, timespec* left),
                 (duration, left))
RT_GUARD_FORWARD(countSleep, nullptr, clock_nanosleep, ,
                 (clockid_t clock, int flags, const timespec* time, timespec* left),
                 (clock, flags, time, left))

#undef RT_GUARD_FORWARD

#endif
