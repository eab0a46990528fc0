// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/serve/host.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace franka_sim::fci {

/// The robots and services of a host: serves their sockets, sends states, remembers what each
/// robot's client has received, and answers questions about all of them. The host decides when.
/// Called by the host's thread. Times are those of the host's clock.
class HostedRobots {
 public:
  using Clock = HostClock::Clock;

  /// @param pace, clock of the host; must outlive this
  HostedRobots(const Pace& pace, const HostClock& clock) : pace_(pace), clock_(clock) {}

  void add(HostedRobot& robot);
  void add(Service& service) { services_.push_back(&service); }
  void remove(const HostedRobot& robot) noexcept;
  void remove(const Service& service) noexcept;
  bool empty() const noexcept { return entries_.empty() && services_.empty(); }

  void observe();
  void actuate();
  /// Call after the physics of a tick.
  void finishTick() noexcept;

  /// Sends states to all. @param same_tick whether time has stood still since the last ones
  void publish(bool same_tick = false);
  /// While the world is halted: shows clients that the robots are there.
  void publishHalted();
  /// While a tick waits for the clients of motions.
  /// @param waited for clients in this tick, without the time in which this process did not run
  void publishWhileWaiting(Clock::time_point now, Clock::duration waited);
  /// While a tick waits for something else: to clients that need not answer, and the last state
  /// again to those of motions. @returns whether there are any of the former
  bool publishToOthers(Clock::time_point now);
  void reportPublished();  ///< to the services
  Clock::time_point publishedAt() const noexcept { return published_at_; }

  /// Whether serve() has something to do: system calls take longer than a control unit's tick, so
  /// sockets are read only when a poll reports data.
  bool isServeDue() const;
  /// @param stops_only serves only requests that stop something
  void serve(bool stops_only);
  /// Reads commands. @returns whether none of a motion is missing
  bool receiveCommands();
  /// Waits until a socket is ready, until `deadline` at most.
  void pollUntil(Clock::time_point deadline);

  void beginWait();  ///< of a tick, for the clients of motions
  /// The wait is over for clients whose answer is missing. @param report whether to report it
  void dropSilentClients(bool report);
  void reportSilentClients();    ///< each once, until it answers
  bool isAnswerMissing() const;  ///< of a client that has not been given up

  /// Whether nothing has to be done until a poll reports something.
  bool isIdle() const;
  /// Whether ticks wait for the client of a motion.
  bool clientsAreDue() const;
  /// Whether this is true of a robot, as in any(&HostedRobot::handBusy).
  bool any(bool (HostedRobot::*is)() const) const;

 private:
  struct Entry {
    HostedRobot* robot;
    bool given_up{false};  // silent for too long in lock-step
    bool silence_reported{false};
    int starts_shown{0};  // states sent to a client that has not sent its first command
    Clock::duration start_shown_after{};  // waiting for it in this tick
    bool reads_are_known{false};          // see HostedRobot::clientHasReadStates
    bool start_is_repeated{false};        // the last of these states
    Clock::time_point shown_at{};
    std::optional<Clock::time_point> ended_at{};  // first shown without a motion
    std::uint64_t unpublished_ticks{1};

    bool isDue() const { return robot->expectsCommand() && !robot->asynchronous(); }
    bool isStarting() const { return isDue() && !robot->motionHasBegun() && !given_up; }
    /// Whether the tick waits for its answer.
    bool isMissing() const { return isDue() && !given_up && !robot->receiveCommand(); }
  };

  void publish(Entry& entry, bool same_tick, Clock::time_point now);
  void repeatIfDue(Entry& entry, Clock::time_point now);
  static bool isStartDue(Entry& entry, Clock::time_point now, Clock::duration waited);

  const Pace& pace_;
  const HostClock& clock_;
  std::vector<Entry> entries_;
  std::vector<Service*> services_;
  std::vector<pollfd> fds_;
  bool requests_ready_{true};
  bool requests_left_{false};  // read, but deferred
  bool polled_{false};         // since robots and services were served
  Clock::time_point served_at_{};
  Clock::time_point served_idle_at_{};
  Clock::time_point published_at_{};
};

}  // namespace franka_sim::fci
