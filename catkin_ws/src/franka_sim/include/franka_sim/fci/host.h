// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_state.h>
#include <poll.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace franka_sim::fci {

/// How simulated time follows wall-clock time.
enum class PaceMode {
  /// A tick is due every millisecond divided by the factor, whatever the clients do.
  kRealTime,
  /// Within a motion each tick waits for the client's answer, at most `patience`; motions run as
  /// fast as the machine and the clients allow, and time stands still between them (decision 21).
  /// An asynchronous motion runs by the clock, because its client need not answer.
  kLockStep,
  /// As kLockStep, but time runs on between motions, as fast as the machine allows: for a world
  /// that others use, too.
  kFreeRunning,
  /// As kFreeRunning, but no tick comes before the clock says so. The robot is as fast as a real
  /// one, and loses nothing on a machine that does not keep time.
  kPatient,
};

struct Pace {
  PaceMode mode{PaceMode::kRealTime};
  /// Simulated time per wall-clock time, in kRealTime and kPatient.
  double factor{1.0};
  /// After so long without an answer a client of a motion counts as lost, and its cycles are then
  /// waited for a millisecond each. Time in which this process itself does not run does not count.
  /// A client whose connection ends is waited for no longer. The value is chosen here: a starved
  /// machine stops a program for seconds (decision 50).
  std::chrono::milliseconds patience{30000};

  /// Whether a tick within a motion waits for the client's answer.
  bool waitsForClients() const noexcept { return mode != PaceMode::kRealTime; }
  /// Whether time stands still between motions.
  bool standsStill() const noexcept { return mode == PaceMode::kLockStep; }
};

/// One robot as the host drives it: a control unit on a plant, with its servers. One thread.
class HostedRobot {
 public:
  virtual ~HostedRobot() = default;

  /// First half of a tick: measure.
  virtual void observe() = 0;
  /// Second half: act on the answer to the last state, if there is one.
  virtual void actuate() = 0;

  /// Reads and answers requests. @param stops_only leaves all but those that stop something.
  virtual void serve(bool stops_only) = 0;
  /// Sends states, `ticks` after the last ones. @param same_moment time stands still since then.
  virtual void publish(std::uint64_t ticks, bool same_moment) = 0;
  /// Time stands still for long within a motion: shows its client the last state once more, as it
  /// was, unless an answer to it is due; and clients of what is mounted on the flange theirs.
  virtual void repeat() = 0;
  /// Somebody waits for the next state.
  virtual bool hasNews() const = 0;

  /// Reads commands. @returns whether the one that answers the last state is there.
  virtual bool receiveCommand() = 0;
  /// A motion runs for a client, which commands it.
  virtual bool expectsCommand() const = 0;
  /// That client sends commands when it likes: no tick waits for one.
  virtual bool asynchronous() const = 0;
  /// That motion has had its first command.
  virtual bool motionHasBegun() const = 0;
  /// The arm stops, recovers or is pushed, or its client has died in a motion: time must go on
  /// though no client answers.
  virtual bool settling() const = 0;
  /// The hand is at work.
  virtual bool handBusy() const = 0;

  /// Adds the socket on which commands come, if there is a client, and all others.
  virtual void addCommandDescriptor(std::vector<pollfd>& fds) const = 0;
  virtual void addDescriptors(std::vector<pollfd>& fds) const = 0;
};

/// Something else with sockets that the host's thread attends to.
class Service {
 public:
  virtual ~Service() = default;
  virtual void serve() = 0;
  /// States have gone out that show what was done before; or, where time waits for the command of a
  /// client in motion, are to follow that command.
  virtual void published() {}
  virtual void addDescriptors(std::vector<pollfd>& fds) const = 0;
};

/// Runs a world and its robots tick by tick: the host sends state k, waits for the answer to it,
/// and runs the physics from k to k + 1 with that answer (decision 20).
class Host {
 public:
  /// @param step advances the world by one millisecond.
  /// @param prepare does ahead what it can of that, before answers to a state are waited for.
  Host(std::function<void()> step, const Pace& pace, std::function<void()> prepare = [] {});

  /// Must outlive the host, or be removed.
  void add(HostedRobot& robot);
  void add(Service& service);
  /// Between ticks, as all that follows.
  void remove(const HostedRobot& robot);
  void setPace(const Pace& pace);
  bool empty() const noexcept { return guests_.empty() && services_.empty(); }

  /// Runs until `stop` is set.
  void run(const std::atomic<bool>& stop);
  /// One tick. In lock-step it begins with a wait until time goes on.
  void tick();
  /// One tick that heeds no clock: it waits for the answers of clients in motion alone.
  void tickAtOnce();
  /// Instead of a tick, about every millisecond while the world is halted: clients are heard and
  /// see that the robots are there. A motion that runs waits with its client, whose time stands
  /// still too.
  void standStill();
  /// After a hold-up that is not to be made up for.
  void restartClock() noexcept { deadline_ = Clock::now(); }
  /// For lock-step: lets this many ticks run without waiting for anybody, for what is done to the
  /// world from outside (a push) to take its course.
  void letRun(std::uint64_t ticks);
  /// After the world was reset: the same for a single tick, and nothing of what was to run before.
  void beginAnew();

  /// Whether the world has come to rest: in lock-step, that no motion runs and time stands still
  /// (or that it would not come to rest for 10 s of its time); otherwise always.
  bool settled() const;

  std::uint64_t ticks() const noexcept { return ticks_; }

 private:
  using Clock = std::chrono::steady_clock;

  struct Guest {
    HostedRobot* robot;
    bool given_up{false};  // silent for too long in lock-step
    int starts_shown{0};   // states sent to a client that is to begin
    Clock::time_point shown_at{};
    std::uint64_t unpublished_ticks{1};

    bool isDue() const { return robot->expectsCommand() && !robot->asynchronous(); }
    bool isStarting() const { return isDue() && !robot->motionHasBegun() && !given_up; }
  };

  void publishAll(bool same_moment = false);
  static void publish(Guest& guest, bool same_moment, Clock::time_point now);
  void serveAll();
  void serveIfDue();
  bool holdsRequestsBack() const;
  bool receiveAll();
  void pollUntil(Clock::time_point deadline);
  void waitInRealTime();
  Clock::time_point nextDeadline();
  void listenUntil(Clock::time_point end);
  void waitInLockStep();
  void awaitSwiftAnswers(Clock::time_point begin);
  void beginWait();
  bool waitForClients();
  void showThatTimeStandsStill(Clock::time_point now);
  bool clientsAreDue() const;
  bool clientsAreAtLeisure() const;
  bool heedsClock() const;
  bool somebodyIsAwaited() const;
  bool timeMustGoOn();
  void giveUpOnTheSilent();
  bool stopped() const;

  std::function<void()> step_;
  std::function<void()> prepare_;
  Pace pace_;
  std::vector<Guest> guests_;
  std::vector<Service*> services_;
  std::vector<pollfd> fds_;
  bool requests_ready_{true};
  bool requests_left_{false};  // read, but kept for later
  Clock::time_point served_at_{};
  const std::atomic<bool>* stop_{nullptr};
  Clock::duration period_{};
  Clock::time_point deadline_{};
  bool spin_;
  Clock::time_point published_at_{};
  Clock::time_point looked_at_{};
  Clock::duration waited_{};  // in this tick, as far as this process ran
  std::uint64_t rolling_{0};
  std::uint64_t held_back_{0};  // ticks in a row in which requests had to wait
  std::uint64_t ticks_{0};
};

}  // namespace franka_sim::fci
