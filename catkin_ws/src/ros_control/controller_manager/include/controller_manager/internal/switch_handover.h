// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_manager/internal/loop_gate.h>
#include <controller_manager/internal/switch_request.h>
#include <hardware_interface/robot_hw.h>
#include <ros/time.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace controller_manager {
namespace internal {

/// Passes switches to the control loop, one at a time, and waits for them. The loop neither locks
/// nor notifies: the waiting thread polls every 200 µs while a switch is under way.
class SwitchHandover {
 public:
  typedef std::chrono::steady_clock Clock;

  enum class Result {
    kDone,       ///< the loop carried it out; see the request's outcomes
    kWithdrawn,  ///< the loop did not start it
    kAbandoned   ///< the loop started it and stood still; it will abort it when it runs again
  };

  /// @param gate that the loop passes; must outlive the handover
  explicit SwitchHandover(LoopGate& gate);

  /// Continues the pending switch, if any. Called by the loop during a visit. An exception ends the
  /// switch and propagates. Real-time safe.
  void serve(hardware_interface::RobotHW& robot, const ros::Time& time);

  /// The exclusive right to switch; waits for the switch before this one. Thread-safe.
  class Turn {
   public:
    /// @param timeout [s] 0 waits for ever
    Turn(SwitchHandover& handover, double timeout);
    ~Turn();
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

    /// False if the time was over, or waiting was ended, before the turn was granted.
    explicit operator bool() const { return granted_; }
    /// [s] since the construction
    double elapsed() const;

    /// Passes the request to the loop.
    void post(std::unique_ptr<SwitchRequest> request);
    /// Waits for the posted request. If done, it stays readable until the turn ends.
    Result await();
    const SwitchRequest& request() const { return *handover_.request_; }

   private:
    bool withdraw();

    SwitchHandover& handover_;
    const double timeout_;
    const Clock::time_point begin_;
    bool granted_{false};
  };

  /// Whether an unfinished switch starts or stops this controller; if not, the handover has no
  /// reference to it. Does not wait. Thread-safe.
  bool involves(const std::string& name);

  /// Waits until no switch is under way, or one has been for `limit`. Thread-safe.
  void awaitEnd(Clock::duration limit);

  /// Ends all present and future waits, for the manager's shutdown.
  void close() { closed_ = true; }
  /// Whether waiting must end, here or for the whole program.
  bool mustEnd() const;

 private:
  bool grant();
  void finish(SwitchRequest& request);  ///< in the loop, which will not access the request any more
  void dropFinished();                  ///< with the mutex locked

  LoopGate& gate_;
  std::atomic<SwitchRequest*> for_loop_{nullptr};
  std::atomic<bool> closed_{false};

  std::mutex mutex_;  ///< for the members below; the loop never takes it
  bool busy_{false};  ///< a thread holds the turn
  Clock::time_point busy_since_;
  std::unique_ptr<SwitchRequest> request_;
  std::vector<std::unique_ptr<SwitchRequest>> withdrawn_;  ///< may still be read by the loop
};

}  // namespace internal
}  // namespace controller_manager
