// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_state.h>
#include <franka_core/spin_rule.h>
#include <poll.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
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
  /// that has other users too.
  kFreeRunning,
  /// As kFreeRunning, but no tick comes earlier than the clock demands. The robot is as fast as a
  /// real one, and loses no commands on a machine that is too slow for real time.
  kPatient,
};

struct Pace {
  /// A patience without end: a hundred years, which nanoseconds can represent.
  static constexpr std::chrono::hours kForever{24 * 365 * 100};

  PaceMode mode{PaceMode::kRealTime};
  /// Simulated time per wall-clock time, in kRealTime and kPatient.
  double factor{1.0};
  /// After this time without an answer in a motion the client counts as lost; from then on each of
  /// its cycles waits only a millisecond. Time in which this process itself does not run does not
  /// count, and a closed connection ends the wait. Chosen here: a starved machine stops a program
  /// for seconds (decision 50).
  std::chrono::milliseconds patience{30000};
  /// How this process waits for these answers; the results do not depend on it.
  franka_core::WaitMode wait{franka_core::WaitMode::kAuto};

  /// Whether a tick within a motion waits for the client's answer.
  bool waitsForClients() const noexcept { return mode != PaceMode::kRealTime; }
  /// Whether time stands still between motions.
  bool standsStill() const noexcept { return mode == PaceMode::kLockStep; }
};

class HostedRobots;
class LockStepTurn;

/// How a host reads the time, waits for sockets, requests quick wake-ups and takes turns. Tests
/// have functions of their own.
struct HostClock {
  using Clock = std::chrono::steady_clock;
  /// Waits until one of the descriptors is ready, for `limit` at most. @returns whether one is.
  static bool poll(std::vector<pollfd>& fds, Clock::duration limit);
  /// A function that requests quick wake-ups of sleeping threads from the kernel, or ends the
  /// request (serve/cpu_latency_request.h).
  static std::function<void(bool quick)> makeWakeUpRequest();
  /// Turns with all processes of the user (decision 65).
  static std::shared_ptr<LockStepTurn> makeTurn();

  std::function<Clock::time_point()> now{Clock::now};
  std::function<bool(std::vector<pollfd>& fds, Clock::duration limit)> wait{poll};
  std::function<void(bool quick)> request_wake_ups{makeWakeUpRequest()};
  std::function<std::shared_ptr<LockStepTurn>()> make_turn{makeTurn};
};

/// How long a motion's client has not answered a state.
enum class Silence {
  kLong,     ///< a second: the tick still waits
  kGivenUp,  ///< the patience is over: time goes on
};

/// One robot as the host drives it: a control unit on a plant, with its servers. Called by one
/// thread.
class HostedRobot {
 public:
  virtual ~HostedRobot() = default;

  /// First half of a tick: measure.
  virtual void observe() = 0;
  /// Second half: act on the answer to the last state, if there is one.
  virtual void actuate() = 0;

  /// Reads and answers requests. @param stops_only serves only requests that stop something.
  virtual void serve(bool stops_only) = 0;
  /// Whether no client is connected: then serve() has nothing to do until a poll reports a new one,
  /// except for opening and closing ports.
  virtual bool idle() const { return false; }
  /// Sends states, `ticks` after the last ones. @param same_tick whether time has stood still
  /// since. @param keep_end see RobotServer::publish.
  virtual void publish(std::uint64_t ticks, bool same_tick, bool keep_end) = 0;
  /// For long standstills of time within a motion: sends the client the last state again,
  /// unchanged, unless an answer to it is due and the motion has begun or the client may not have
  /// read its states; also to clients of the device on the flange.
  /// @returns whether it has sent the client the state
  virtual bool repeat() = 0;
  /// Whether a client waits for the next state.
  virtual bool hasPendingState() const = 0;

  /// Reads commands. @returns whether the answer to the last state has arrived.
  virtual bool receiveCommand() = 0;
  /// Reports that a tick waits, or no longer waits, for the motion's client. Called once for each
  /// silence of the client, and once more if it is given up.
  virtual void reportSilence(Silence /*silence*/) {}
  /// Whether a motion runs for a client, which commands it.
  virtual bool expectsCommand() const = 0;
  /// Whether the client is on this machine, as far as its address shows.
  virtual bool clientIsLocal() const { return false; }
  /// Whether the client has read every state that was sent to it; nothing if that is unknown.
  virtual std::optional<bool> clientHasReadStates() const { return std::nullopt; }
  /// Whether that client may send commands at any time, so that no tick waits for one.
  virtual bool asynchronous() const = 0;
  /// Whether that motion has had its first command.
  virtual bool motionHasBegun() const = 0;
  /// Whether the arm stops, recovers or is pushed, or its client has disconnected in a motion: then
  /// time advances even if no client answers.
  virtual bool settling() const = 0;
  /// Whether it settles for a time that is known: however long that is, requests wait for its end.
  virtual bool settlesInKnownTime() const { return false; }
  /// Whether a command of the hand runs.
  virtual bool handBusy() const = 0;

  /// Adds the command socket, if there is a client, and all others.
  virtual void addCommandDescriptor(std::vector<pollfd>& fds) const = 0;
  virtual void addDescriptors(std::vector<pollfd>& fds) const = 0;
};

/// Another user of sockets that the host's thread serves.
class Service {
 public:
  virtual ~Service() = default;
  virtual void serve() = 0;
  /// Whether serve() has nothing to do until a poll reports something, or for some milliseconds.
  virtual bool idle() const { return false; }
  /// Called when states that show the effect of earlier requests have been sent; or, if time waits
  /// for the command of a client in motion, when they will follow that command.
  virtual void published() {}
  virtual void addDescriptors(std::vector<pollfd>& fds) const = 0;
};

/// Runs a world and its robots tick by tick: the host sends state k, waits for the answer to it,
/// and runs the physics from k to k + 1 with that answer (decision 20).
class Host {
 public:
  /// @param step advances the world by one millisecond.
  /// @param prepare computes in advance what it can of the step, before the wait for answers.
  Host(
      std::function<void()> step, const Pace& pace, std::function<void()> prepare = [] {},
      HostClock clock = {});
  ~Host();
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  /// Must outlive the host, or be removed.
  void add(HostedRobot& robot);
  void add(Service& service);
  /// Call between ticks, like all functions below.
  void remove(const HostedRobot& robot) noexcept;
  void remove(const Service& service) noexcept;
  void setPace(const Pace& pace);
  /// Sets a function that is called about 20 times per second while a tick waits for a client. If
  /// it returns false, the tick continues as after the end of patience.
  void whileWaiting(std::function<bool()> keep_waiting) { keep_waiting_ = std::move(keep_waiting); }
  /// In real time, while all robots and services are idle: lets the ticks of this time run
  /// together, which needs fewer wake-ups. A world with other users must leave it at 0: one by one.
  void setIdleInterval(std::chrono::milliseconds interval) { idle_interval_ = interval; }
  bool empty() const noexcept;

  /// Runs until `stop` is set.
  void run(const std::atomic<bool>& stop);
  /// One tick. In lock-step it first waits until time may advance.
  void tick();
  /// One tick that ignores the clock: it waits only for the answers of clients in motion.
  void tickAtOnce();
  /// Call about every millisecond, instead of a tick, while the world is halted: serves clients and
  /// shows them that the robots are there. A running motion is suspended along with its client's
  /// time.
  void standStill();
  /// Call after a delay that must not be recovered by faster ticks.
  void restartClock() { deadline_ = clock_.now(); }
  /// For lock-step: lets this many ticks run without waiting for clients, so that an external
  /// change of the world (a push) can take effect.
  void runFree(std::uint64_t ticks);
  /// The same for exactly this many ticks, if nothing else advances the time.
  void advance(std::uint64_t ticks);
  /// Call after a reset of the world: lets one tick run and cancels ticks of earlier runFree()
  /// calls.
  void restartAfterReset();

  /// Whether the world has come to rest: in lock-step, that no motion runs and time stands still
  /// (or that it did not come to rest within 10 s of simulated time); otherwise always true.
  bool settled() const;
  /// Whether no motion runs, nothing stops or recovers and no hand works; in lock-step also that
  /// time stands still.
  bool atRest() const;
  /// Whether, in lock-step, the world has not come to rest within 10 s of simulated time.
  bool failsToSettle() const;
  /// Whether a motion runs for a client.
  bool inMotion() const;

  std::uint64_t ticks() const noexcept { return ticks_; }

 private:
  using Clock = HostClock::Clock;

  void serveIfDue();
  bool holdsRequestsBack() const;
  void waitInRealTime();
  void waitIdle(Clock::time_point end);
  Clock::time_point nextDeadline();
  void listenUntil(Clock::time_point end);
  void waitInLockStep();
  bool exchanges() const;
  void takeTurn();
  void waitForTurn();
  void endTurn();
  void requestQuickWakeUps(bool quick);
  void beginWait();
  bool waitForClients();
  bool followsClock() const;
  bool mustAdvanceTime();
  bool hasTimedOut(Clock::time_point now);
  bool stopped() const;

  std::function<void()> step_;
  std::function<void()> prepare_;
  HostClock clock_;
  std::function<bool()> keep_waiting_;
  Pace pace_;
  std::unique_ptr<HostedRobots> robots_;
  std::shared_ptr<LockStepTurn> turn_;
  std::vector<pollfd> turn_descriptor_;
  bool quick_wake_ups_{false};  ///< whether they are requested
  Clock::duration idle_interval_{};
  Clock::time_point slept_until_{};  ///< in real time
  const std::atomic<bool>* stop_{nullptr};
  Clock::duration period_{};
  Clock::time_point deadline_{};
  franka_core::SpinRule spin_rule_;
  Clock::time_point waited_until_{};
  Clock::time_point keep_waiting_called_at_{};
  Clock::duration waited_{};  // in this tick, without time in which this process did not run
  std::uint64_t rolling_{0};
  std::uint64_t held_back_{0};  // consecutive ticks in which requests were deferred
  std::uint64_t ticks_{0};
};

}  // namespace franka_sim::fci
