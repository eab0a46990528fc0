// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost_bind_compat/global_placeholders.h>

#include <mutex>

namespace realtime_tools {

/// A value guarded by a mutex, for threads that may wait for each other during a copy.
///
/// Thread-safe. Not real-time safe. Both sides lock; a control loop uses RealtimeBuffer.
///
/// @tparam T copyable.
template <class T>
class RealtimeBox {
 public:
  explicit RealtimeBox(const T& initial = T()) : value_(initial) {}

  /// Replaces the value.
  void set(const T& value) {
    std::lock_guard<std::mutex> lock(mutex_);
    value_ = value;
  }

  /// Copies the value to `value`.
  void get(T& value) {
    std::lock_guard<std::mutex> lock(mutex_);
    value = value_;
  }

 private:
  T value_;
  std::mutex mutex_;
};

}  // namespace realtime_tools
