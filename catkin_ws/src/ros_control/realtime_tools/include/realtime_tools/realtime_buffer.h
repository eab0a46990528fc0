// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost_bind_compat/global_placeholders.h>
#include <realtime_tools/latest_value.h>

#include <atomic>
#include <mutex>
#include <thread>

namespace realtime_tools {

/// Passes the newest value of other threads to one real-time thread.
///
/// readFromRT() always succeeds at once and never sees a half-written value: see LatestValue.
///
/// One real-time thread calls readFromRT() and initRT(); any other thread calls the rest, which
/// takes a mutex that the real-time thread never uses. Assigning a T must neither allocate nor
/// lock.
///
/// @tparam T copyable; default-constructible only if the buffer is default-constructed.
template <class T>
class RealtimeBuffer {
 public:
  RealtimeBuffer() = default;
  RealtimeBuffer(const T& data) : values_(data), latest_(data) {}
  /// Copies the last value of `source`.
  RealtimeBuffer(const RealtimeBuffer& source) : RealtimeBuffer(source.copyOfLatest()) {}
  /// The same; no other thread may use this buffer meanwhile.
  RealtimeBuffer& operator=(const RealtimeBuffer& source) {
    if (this != &source) {
      initRT(source.copyOfLatest());
    }
    return *this;
  }
  ~RealtimeBuffer() = default;

  /// The newest value, without waiting. Real-time safe. It belongs to the real-time thread, which
  /// may also write through the pointer, until its next call; without a new value it returns the
  /// same pointer.
  T* readFromRT() noexcept { return &values_.read(); }

  /// The last value of writeFromNonRT(), initRT() or the constructor; valid until the next of these
  /// calls. Excludes changes by the real-time thread through its pointer. Not real-time safe.
  T* readFromNonRT() const {
    std::lock_guard<std::mutex> lock(mutex_);
    return &latest_;
  }

  /// Replaces the value; the real-time thread gets it in its next readFromRT(). Not real-time safe.
  void writeFromNonRT(const T& data) {
    std::lock_guard<std::mutex> lock(mutex_);
    const LatestGuard guard(latest_busy_);
    latest_ = data;
    values_.write(data);
  }

  /// Sets the value from the real-time thread, as controllers do in starting(), or from any thread
  /// before others use the buffer. A simultaneous write counts as the later one. Real-time safe.
  void initRT(const T& data) {
    if (latest_busy_.test_and_set(std::memory_order_acquire)) {
      values_.held() = data;
      return;
    }
    values_.read() = data;
    latest_ = data;
    latest_busy_.clear(std::memory_order_release);
  }

 private:
  /// Excludes initRT() from `latest_`. Only initRT() can hold the flag, for the time of two copies,
  /// so yielding is sufficient.
  class LatestGuard {
   public:
    explicit LatestGuard(std::atomic_flag& flag) : flag_(flag) {
      while (flag_.test_and_set(std::memory_order_acquire)) {
        std::this_thread::yield();
      }
    }
    ~LatestGuard() { flag_.clear(std::memory_order_release); }
    LatestGuard(const LatestGuard&) = delete;
    LatestGuard& operator=(const LatestGuard&) = delete;

   private:
    std::atomic_flag& flag_;
  };

  T copyOfLatest() const {
    std::lock_guard<std::mutex> lock(mutex_);
    const LatestGuard guard(latest_busy_);
    return latest_;
  }

  LatestValue<T> values_;
  mutable T latest_{};
  mutable std::mutex mutex_;  ///< for the threads that are not real-time
  mutable std::atomic_flag latest_busy_ = ATOMIC_FLAG_INIT;
};

}  // namespace realtime_tools
