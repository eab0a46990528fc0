// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

namespace franka_sim_mujoco {

/// Requests of other threads that the stepping thread executes between two ticks.
///
/// Any thread may call `run` and `close`; the stepping thread calls `adopt`, `serve` and
/// `waitForWork`. With an empty queue `serve` costs one atomic load: an undisturbed tick takes no
/// lock.
class RequestQueue {
 public:
  using Clock = std::chrono::steady_clock;

  static constexpr std::chrono::milliseconds kDefaultTimeout{10000};
  /// A call of `serve` begins no more work after this time. Chosen here: a fifth of a tick; dozens
  /// of short requests fit into it.
  static constexpr std::chrono::microseconds kServingTime{200};

  /// @param now the clock of kServingTime; tests have one of their own
  explicit RequestQueue(std::function<Clock::time_point()> now = Clock::now)
      : now_(std::move(now)) {}

  /// Waits until the stepping thread has done `work`; in the stepping thread itself, does it at
  /// once. Rethrows exceptions of `work`. When this returns or throws, `work` neither runs nor will
  /// run.
  /// @param timeout for the start of the work; once started its end is awaited
  /// @throws std::runtime_error if it did not start in time, or after close()
  void run(const std::function<void()>& work, std::chrono::milliseconds timeout = kDefaultTimeout);

  /// Makes the calling thread the serving one.
  void adopt();
  /// Does queued work in order of arrival, for about kServingTime: at least one piece of work, so
  /// that every caller gets its turn, and the rest in later calls, so that ticks go on.
  void serve();
  /// How much work waits. Thread-safe.
  std::size_t pending();
  /// Sleeps until work is queued, the queue is closed or the time is over.
  void waitForWork(std::chrono::milliseconds timeout);
  /// Refuses all waiting and future work.
  void close() noexcept;

 private:
  enum class Phase { kWaiting, kRunning, kDone };
  struct Job {
    const std::function<void()>* work;
    Phase phase{Phase::kWaiting};
    std::exception_ptr error;
  };

  std::function<Clock::time_point()> now_;
  std::mutex mutex_;
  std::condition_variable work_arrived_, work_done_;
  std::deque<std::shared_ptr<Job>> jobs_;
  std::atomic<bool> has_jobs_{false};
  std::atomic<std::thread::id> server_{};
  bool closed_{false};
};

}  // namespace franka_sim_mujoco
