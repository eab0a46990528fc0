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
    kDone,       ///< the loop carried it out; the request's outcomes tell how
    kWithdrawn,  ///< the loop never began
    kAbandoned   ///< the loop began and stood still; it will give up when it runs again
  };

  /// @param gate which the loop passes; outlives the handover
  explicit SwitchHandover(LoopGate& gate);

  /// Carries the switch at hand on, if there is one. In the loop, during a visit; real-time safe. A
  /// switch that throws is over, and the exception goes on.
  void serve(hardware_interface::RobotHW& robot, const ros::Time& time);

  /// The right to switch. Thread-safe; waits for the switch before this one.
  class Turn {
   public:
    /// @param timeout [s] 0 waits for ever
    Turn(SwitchHandover& handover, double timeout);
    ~Turn();
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

    /// False if the time was over, or waiting was ended, before it was this one's turn.
    explicit operator bool() const { return granted_; }
    /// [s] since the turn was asked for
    double elapsed() const;

    /// Lays the request before the loop.
    void post(std::unique_ptr<SwitchRequest> request);
    /// Waits for what was posted. The posted request stays readable until the turn ends if done.
    Result await();
    const SwitchRequest& request() const { return *handover_.request_; }

   private:
    bool withdraw();

    SwitchHandover& handover_;
    const double timeout_;
    const Clock::time_point begin_;
    bool granted_{false};
  };

  /// Whether an unfinished switch starts or stops this controller; if not, the handover holds
  /// nothing of it. Thread-safe, does not wait.
  bool involves(const std::string& name);

  /// Ends all waiting, now and later, for the manager's end.
  void close() { closed_ = true; }
  /// Whether waiting was ended, here or for the whole program.
  bool mustEnd() const;

 private:
  bool grant();
  void finish(SwitchRequest& request);  ///< in the loop: it will not touch the request any more
  void dropFinished();                  ///< with the mutex locked

  LoopGate& gate_;
  std::atomic<SwitchRequest*> for_loop_{nullptr};
  std::atomic<bool> closed_{false};

  std::mutex mutex_;  ///< for what follows; the loop never takes it
  bool busy_{false};  ///< somebody holds the turn
  std::unique_ptr<SwitchRequest> request_;
  std::vector<std::unique_ptr<SwitchRequest>> withdrawn_;  ///< may still be read by the loop
};

}  // namespace internal
}  // namespace controller_manager
