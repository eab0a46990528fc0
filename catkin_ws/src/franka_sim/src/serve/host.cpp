// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/serve/host.h>
#include <sys/prctl.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <utility>

#include "serve/cpu_latency_request.h"
#include "serve/hosted_robots.h"
#include "serve/lock_step_turn.h"

namespace franka_sim::fci {

namespace {

constexpr std::chrono::milliseconds kTick{1};

/// Physics continues for this long after an action, then until everything is at rest (decision 21).
constexpr std::uint64_t kTicksAfterAction = 100;

/// In lock-step, requests wait until the world is at rest, but no longer than this. Chosen here:
/// the world may never come to rest, for example when two arms press on each other.
constexpr std::uint64_t kMaxDeferral = 10000;

/// The host does not catch up after a longer delay (chosen here: a burst of ticks would lose more
/// commands).
constexpr std::chrono::milliseconds kMaxCatchUp{50};

/// While the host catches up after a delay, clients still get this time for each answer (chosen
/// here).
constexpr std::chrono::microseconds kMinTimeToAnswer{400};

/// Interval of the calls of keep_waiting (chosen here: fast enough for Ctrl-C).
constexpr std::chrono::milliseconds kKeepWaitingPeriod{50};

/// Silence of a client that is reported. Chosen here: late clients on a busy machine are quicker,
/// and users begin to wonder.
constexpr std::chrono::seconds kLongSilence{1};

timespec toTimespec(std::chrono::nanoseconds duration) noexcept {
  constexpr std::int64_t kNanoseconds = 1000000000;
  return {static_cast<time_t>(duration.count() / kNanoseconds),
          static_cast<long>(duration.count() % kNanoseconds)};
}

/// Sets another pace mode for its lifetime.
class ModeGuard {
 public:
  ModeGuard(Pace& pace, PaceMode mode) noexcept : pace_(pace), before_(pace.mode) {
    pace_.mode = mode;
  }
  ~ModeGuard() { pace_.mode = before_; }
  ModeGuard(const ModeGuard&) = delete;
  ModeGuard& operator=(const ModeGuard&) = delete;

 private:
  Pace& pace_;
  const PaceMode before_;
};

}  // namespace

bool HostClock::poll(std::vector<pollfd>& fds, Clock::duration limit) {
  const timespec timeout = toTimespec(limit);
  return ppoll(fds.data(), fds.size(), &timeout, nullptr) > 0;
}

std::function<void(bool quick)> HostClock::makeWakeUpRequest() {
  return [request = std::make_shared<CpuLatencyRequest>()](bool quick) {
    if (quick) {
      request->begin();
    } else {
      request->end();
    }
  };
}

std::shared_ptr<LockStepTurn> HostClock::makeTurn() { return std::make_shared<LockStepTurn>(); }

Host::Host(std::function<void()> step, const Pace& pace, std::function<void()> prepare,
           HostClock clock)
    : step_(std::move(step)),
      prepare_(std::move(prepare)),
      clock_(std::move(clock)),
      robots_(std::make_unique<HostedRobots>(pace_, clock_)),
      turn_(clock_.make_turn()) {
  setPace(pace);
  // By default the system groups wake-ups within 50 us.
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
}

Host::~Host() = default;

void Host::add(HostedRobot& robot) { robots_->add(robot); }

void Host::add(Service& service) { robots_->add(service); }

void Host::remove(const HostedRobot& robot) noexcept { robots_->remove(robot); }

void Host::remove(const Service& service) noexcept { robots_->remove(service); }

bool Host::empty() const noexcept { return robots_->empty(); }

void Host::setPace(const Pace& pace) {
  pace_ = pace;
  period_ = std::chrono::nanoseconds(std::llround(1e6 / (pace.factor > 0.0 ? pace.factor : 1.0)));
  if (pace.wait != spin_rule_.mode()) {
    spin_rule_ = franka_core::SpinRule(pace.wait);
  }
  rolling_ = 0;
  endTurn();
  restartClock();
}

void Host::runFree(std::uint64_t ticks) {
  rolling_ = std::max(rolling_, ticks + kTicksAfterAction);
}

void Host::advance(std::uint64_t ticks) { rolling_ = std::max(rolling_, ticks); }

void Host::restartAfterReset() {
  rolling_ = 0;
  runFree(1);
}

void Host::run(const std::atomic<bool>& stop) {
  restartClock();
  stop_ = &stop;
  while (!stopped()) {
    tick();
  }
  stop_ = nullptr;
}

bool Host::stopped() const { return stop_ != nullptr && stop_->load(std::memory_order_relaxed); }

void Host::tick() {
  robots_->observe();
  if (pace_.waitsForClients()) {
    waitInLockStep();
    if (followsClock()) {
      listenUntil(nextDeadline());
    }
  } else {
    robots_->publish();
    prepare_();
    waitInRealTime();
  }
  robots_->actuate();
  step_();
  ticks_++;
  robots_->finishTick();
}

void Host::tickAtOnce() {
  const ModeGuard free_running(pace_, PaceMode::kFreeRunning);
  tick();
}

void Host::standStill() {
  endTurn();
  robots_->publishHalted();
  robots_->serve(holdsRequestsBack());
  robots_->reportPublished();
  restartClock();
}

void Host::serveIfDue() {
  if (robots_->isServeDue()) {
    robots_->serve(holdsRequestsBack());
  }
}

// While the world comes to rest, a request would take effect at a tick that depends on the client's
// speed.
bool Host::holdsRequestsBack() const {
  return pace_.standsStill() && rolling_ > 0 && held_back_ < kMaxDeferral &&
         !robots_->any(&HostedRobot::handBusy) && !robots_->clientsAreDue() &&
         !robots_->any(&HostedRobot::asynchronous);
}

bool Host::settled() const { return !pace_.standsStill() || failsToSettle() || atRest(); }

bool Host::failsToSettle() const { return pace_.standsStill() && held_back_ >= kMaxDeferral; }

bool Host::atRest() const {
  return (!pace_.standsStill() || rolling_ == 0) && !inMotion() &&
         !robots_->any(&HostedRobot::settling) && !robots_->any(&HostedRobot::handBusy);
}

bool Host::inMotion() const { return robots_->any(&HostedRobot::expectsCommand); }

Host::Clock::time_point Host::nextDeadline() {
  deadline_ += period_;
  const Clock::time_point now = clock_.now();
  if (now - deadline_ > kMaxCatchUp) {
    deadline_ = now;
  }
  return deadline_;
}

void Host::waitInRealTime() {
  Clock::time_point end = nextDeadline();
  if (idle_interval_ > Clock::duration::zero() && robots_->isIdle()) {
    waitIdle(end);
    return;
  }
  if (robots_->clientsAreDue()) {
    end = std::max(end, clock_.now() + std::min<Clock::duration>(kMinTimeToAnswer, period_));
  }
  listenUntil(end);
  slept_until_ = end;
}

void Host::waitIdle(Clock::time_point end) {
  if (end - slept_until_ < idle_interval_ && slept_until_ < end) {
    return;
  }
  while (clock_.now() < end && robots_->isIdle()) {
    robots_->pollUntil(end);
    serveIfDue();
  }
  if (!robots_->isIdle()) {
    restartClock();  // a client does not wait for the time that the ticks are ahead
  }
  slept_until_ = deadline_;
}

void Host::listenUntil(Clock::time_point end) {
  do {
    robots_->pollUntil(end);
    robots_->receiveCommands();
    serveIfDue();
  } while (clock_.now() < end);
}

// In lock-step only the clock defines when the next tick of an asynchronous motion is due.
bool Host::followsClock() const {
  return pace_.mode == PaceMode::kPatient ||
         (pace_.mode != PaceMode::kFreeRunning && robots_->any(&HostedRobot::asynchronous));
}

bool Host::mustAdvanceTime() {
  if (robots_->any(&HostedRobot::settling) || robots_->any(&HostedRobot::handBusy) ||
      robots_->any(&HostedRobot::asynchronous)) {
    rolling_ = std::max(rolling_, kTicksAfterAction);
  }
  return rolling_ > 0;
}

void Host::waitInLockStep() {
  takeTurn();
  const bool news = robots_->any(&HostedRobot::hasPendingState);
  const bool due = robots_->clientsAreDue();
  if (due || news || followsClock() || clock_.now() - robots_->publishedAt() >= kTick) {
    robots_->publish();
  }
  beginWait();
  const Clock::time_point begin = waited_until_;
  prepare_();
  // An answer takes a while; if none is expected, one look at the sockets is enough.
  if (due) {
    const bool answered = spin_rule_.spin([this] { return robots_->receiveCommands(); },
                                          [this] { return clock_.now(); });
    // A client may sleep in each exchange. If it takes so long that this thread sleeps as well,
    // quick wake-ups gain little.
    const bool is_answered_soon =
        answered || (quick_wake_ups_ && spin_rule_.pauseLeft(begin) == Clock::duration::zero());
    requestQuickWakeUps(is_answered_soon && exchanges());
  }
  if (!due || !robots_->receiveCommands()) {
    robots_->pollUntil(due ? begin + kTick : begin);
  }
  while (!stopped()) {
    serveIfDue();
    robots_->receiveCommands();
    if (robots_->clientsAreDue()) {
      if (!waitForClients()) {
        rolling_ = kTicksAfterAction;
        return;
      }
      continue;
    }
    if (!pace_.standsStill()) {
      return;
    }
    if (mustAdvanceTime()) {
      if (!robots_->any(&HostedRobot::settlesInKnownTime)) {
        held_back_ = holdsRequestsBack() ? held_back_ + 1 : 0;
      }
      rolling_--;
      return;
    }
    held_back_ = 0;
    if (clock_.now() - robots_->publishedAt() >= kTick) {
      robots_->publish(true);
    }
    robots_->pollUntil(robots_->publishedAt() + kTick);
  }
}

// Whether the next tick depends on a client on this machine, and on nothing else.
bool Host::exchanges() const {
  return pace_.standsStill() && robots_->clientsAreDue() &&
         robots_->any(&HostedRobot::clientIsLocal);
}

// Pairs of robots and clients on this machine take turns, so that each finds its data in a
// processor's cache.
void Host::takeTurn() {
  while (exchanges()) {
    if (turn_->take(clock_.now()) || stopped()) {
      return;
    }
    waitForTurn();
  }
  endTurn();
}

// Only the motion waits: others are served and see that their robots are there.
void Host::waitForTurn() {
  const Clock::time_point retry = clock_.now() + turn_->retryAfter(clock_.now());
  bool is_woken = false;
  while (!is_woken && clock_.now() < retry) {
    turn_descriptor_.clear();
    if (turn_->descriptor() >= 0) {
      turn_descriptor_.push_back({turn_->descriptor(), POLLIN, 0});
    }
    const Clock::time_point now = clock_.now();
    const bool others = robots_->publishToOthers(now);
    const Clock::duration rest = std::max(retry - now, Clock::duration::zero());
    is_woken =
        clock_.wait(turn_descriptor_, others ? std::min<Clock::duration>(rest, kTick) : rest);
    robots_->pollUntil(clock_.now());
    serveIfDue();
  }
}

void Host::endTurn() {
  turn_->give();
  requestQuickWakeUps(false);
}

void Host::requestQuickWakeUps(bool quick) {
  if (std::exchange(quick_wake_ups_, quick) != quick) {
    clock_.request_wake_ups(quick);
  }
}

void Host::beginWait() {
  waited_until_ = keep_waiting_called_at_ = clock_.now();
  waited_ = {};
  robots_->beginWait();
}

// @returns whether there is still something to wait for.
bool Host::waitForClients() {
  // Time in which this process did not run must not count as the clients' silence.
  constexpr Clock::duration kMaxCountedTime = 2 * kTick;
  const Clock::time_point now = clock_.now();
  waited_ += std::min<Clock::duration>(now - waited_until_, kMaxCountedTime);
  waited_until_ = now;
  if (!robots_->isAnswerMissing() && (robots_->receiveCommands() || waited_ >= kTick)) {
    return false;
  }
  if (waited_ >= LockStepTurn::kQuickAnswer) {
    turn_->giveForSilence(now);
    requestQuickWakeUps(false);
  }
  if (waited_ >= kLongSilence) {
    robots_->reportSilentClients();
  }
  if (hasTimedOut(now)) {
    robots_->dropSilentClients(waited_ >= pace_.patience);
    return true;
  }
  robots_->publishWhileWaiting(now, waited_);
  robots_->pollUntil(now + kTick);
  return true;
}

bool Host::hasTimedOut(Clock::time_point now) {
  if (waited_ >= pace_.patience) {
    return true;
  }
  if (!keep_waiting_ || now - keep_waiting_called_at_ < kKeepWaitingPeriod) {
    return false;
  }
  keep_waiting_called_at_ = now;
  return !keep_waiting_();
}

}  // namespace franka_sim::fci
