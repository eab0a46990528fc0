// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

namespace franka_sim_mujoco {

/// Work that other threads want done by the stepping thread between two ticks.
///
/// Any thread may call `run` and `close`; the stepping thread calls `adopt`, `serve` and
/// `waitForWork`. While nothing is queued `serve` costs one atomic load: no lock is taken in an
/// undisturbed tick.
class RequestQueue {
 public:
  static constexpr std::chrono::milliseconds kDefaultTimeout{10000};

  /// Waits until the stepping thread has done `work`; called by the stepping thread itself, does it
  /// at once. Rethrows what `work` throws. When this returns or throws, `work` is not and will not
  /// be running.
  /// @param timeout how long the work may wait for its turn; once begun it is waited for to its end
  /// @throws std::runtime_error when its turn did not come, or after close()
  void run(const std::function<void()>& work, std::chrono::milliseconds timeout = kDefaultTimeout);

  /// Makes the calling thread the one that serves.
  void adopt();
  /// Does what is queued, in order of arrival.
  void serve();
  /// Sleeps until something is queued, the queue is closed or the time is over.
  void waitForWork(std::chrono::milliseconds timeout);
  /// Refuses everything that waits and everything that comes.
  void close();

 private:
  enum class Phase { kWaiting, kRunning, kDone };
  struct Job {
    const std::function<void()>* work;
    Phase phase{Phase::kWaiting};
    std::exception_ptr error;
  };

  std::mutex mutex_;
  std::condition_variable work_arrived_, work_done_;
  std::deque<std::shared_ptr<Job>> jobs_;
  std::atomic<bool> pending_{false};
  std::atomic<std::thread::id> server_{};
  bool closed_{false};
};

}  // namespace franka_sim_mujoco
