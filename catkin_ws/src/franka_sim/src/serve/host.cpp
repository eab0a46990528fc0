// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/serve/host.h>
#include <sys/prctl.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <utility>

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

/// Sockets are polled at least this often, even if commands come too fast for a poll.
constexpr std::chrono::milliseconds kMaxServeInterval{1};

/// Robots without clients are served so often if a poll reports nothing (chosen here: opens and
/// closes their ports in time). Serving one looks at three sockets, with a system call each.
constexpr std::chrono::milliseconds kMaxIdleServeInterval{10};

/// A client that waits for another one's answer gives up after a second without a state; genuine
/// clients and ours drop a repeated state and wait on. Chosen here: three repeats fit into that
/// second.
constexpr std::chrono::milliseconds kRepeatPeriod{300};

/// Before its first command a client needs two states that show the motion; they are sent at once.
/// Further states are for a client that missed them. They come as slowly as the client's timeout of
/// a second allows: each state that arrives while a starved client works on its first answer puts
/// its clock, which counts states, ahead of the arm's, and runs would not repeat (chosen here).
constexpr int kPromptStarts = 2;
constexpr std::chrono::milliseconds kLaterStarts{600};

/// The state that shows the end of a motion remains its client's newest one for so long, unless the
/// client sends a request before: a client that runs too late would find a state of the braking arm
/// in its place, and its exception would not repeat. Clients of libfranka send a StopMove within a
/// millisecond; others may be silent, and the timeout of a second is theirs, too (chosen here).
constexpr std::chrono::milliseconds kEndKept{600};

/// While the host catches up after a delay, clients still get this time for each answer (chosen
/// here).
constexpr std::chrono::microseconds kMinTimeToAnswer{400};

/// Interval of the calls of keep_waiting (chosen here: fast enough for Ctrl-C).
constexpr std::chrono::milliseconds kKeepWaitingPeriod{50};

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

Host::Host(std::function<void()> step, const Pace& pace, std::function<void()> prepare,
           HostClock clock)
    : step_(std::move(step)), prepare_(std::move(prepare)), clock_(std::move(clock)) {
  setPace(pace);
  // By default the system groups wake-ups within 50 us.
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
}

void Host::add(HostedRobot& robot) {
  entries_.push_back({&robot});
  fds_.reserve(16 * entries_.size());
}

void Host::add(Service& service) { services_.push_back(&service); }

void Host::remove(const HostedRobot& robot) noexcept {
  const auto is_robot = [&](const Entry& entry) { return entry.robot == &robot; };
  entries_.erase(std::remove_if(entries_.begin(), entries_.end(), is_robot), entries_.end());
}

void Host::remove(const Service& service) noexcept {
  services_.erase(std::remove(services_.begin(), services_.end(), &service), services_.end());
}

void Host::setPace(const Pace& pace) {
  pace_ = pace;
  period_ = std::chrono::nanoseconds(std::llround(1e6 / (pace.factor > 0.0 ? pace.factor : 1.0)));
  if (pace.wait != spin_rule_.mode()) {
    spin_rule_ = franka_core::SpinRule(pace.wait);
  }
  rolling_ = 0;
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
  for (const Entry& entry : entries_) {
    entry.robot->observe();
  }
  if (pace_.waitsForClients()) {
    waitInLockStep();
    if (followsClock()) {
      listenUntil(nextDeadline());
    }
  } else {
    publishAll();
    prepare_();
    waitInRealTime();
  }
  for (const Entry& entry : entries_) {
    entry.robot->actuate();
  }
  step_();
  ticks_++;
  for (Entry& entry : entries_) {
    entry.unpublished_ticks++;
  }
}

void Host::tickAtOnce() {
  const ModeGuard free_running(pace_, PaceMode::kFreeRunning);
  tick();
}

void Host::standStill() {
  for (const Entry& entry : entries_) {
    entry.robot->publish(entry.robot->expectsCommand() ? 0 : 1, true, false);
  }
  serveAll();
  for (Service* service : services_) {
    service->published();
  }
  restartClock();
}

void Host::publishAll(bool same_tick) {
  published_at_ = clock_.now();
  for (Entry& entry : entries_) {
    publish(entry, same_tick, published_at_);
  }
  for (Service* service : services_) {
    service->published();
  }
}

void Host::publish(Entry& entry, bool same_tick, Clock::time_point now) {
  if (entry.robot->expectsCommand()) {
    entry.ended_at.reset();
  } else if (!entry.ended_at) {
    entry.ended_at = now;
  }
  const bool keep_end =
      pace_.waitsForClients() && entry.ended_at && now - *entry.ended_at < kEndKept;
  entry.robot->publish(std::max<std::uint64_t>(entry.unpublished_ticks, 1), same_tick, keep_end);
  entry.unpublished_ticks = 0;
  entry.shown_at = now;
}

// System calls take longer than a control unit's tick, so sockets are read only when a poll reports
// data.
void Host::serveIfDue() {
  if (requests_ready_ || requests_left_ || clock_.now() - served_at_ >= kMaxServeInterval) {
    serveAll();
  }
}

void Host::serveAll() {
  served_at_ = clock_.now();
  const bool reported = std::exchange(requests_ready_, false);
  const bool polled = std::exchange(polled_, false);
  const bool all = reported || !polled || served_at_ - served_idle_at_ >= kMaxIdleServeInterval;
  served_idle_at_ = all ? served_at_ : served_idle_at_;
  const bool stops_only = holdsRequestsBack();
  requests_left_ = stops_only;
  for (const Entry& entry : entries_) {
    if (all || !entry.robot->idle()) {
      entry.robot->serve(stops_only);
    }
  }
  // The next states wait for commands, whose sender may itself wait for the answer of a service.
  const bool states_wait = pace_.waitsForClients() && clientsAreDue();
  for (Service* service : services_) {
    if (all || !service->idle()) {
      service->serve();
    }
    if (states_wait) {
      service->published();
    }
  }
}

// While the world comes to rest, a request would take effect at a tick that depends on the client's
// speed.
bool Host::holdsRequestsBack() const {
  const bool hand_busy = std::any_of(entries_.begin(), entries_.end(),
                                     [](const Entry& entry) { return entry.robot->handBusy(); });
  return pace_.standsStill() && rolling_ > 0 && held_back_ < kMaxDeferral && !hand_busy &&
         !clientsAreDue() && !hasAsynchronousMotion();
}

bool Host::settled() const { return !pace_.standsStill() || failsToSettle() || atRest(); }

bool Host::failsToSettle() const { return pace_.standsStill() && held_back_ >= kMaxDeferral; }

bool Host::atRest() const {
  const auto moves = [](const Entry& entry) {
    return entry.robot->expectsCommand() || entry.robot->settling() || entry.robot->handBusy();
  };
  return (!pace_.standsStill() || rolling_ == 0) &&
         std::none_of(entries_.begin(), entries_.end(), moves);
}

bool Host::inMotion() const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [](const Entry& entry) { return entry.robot->expectsCommand(); });
}

bool Host::receiveAll() {
  bool all = true;
  for (Entry& entry : entries_) {
    const bool here = entry.robot->receiveCommand();
    if (here) {
      entry.given_up = false;
    }
    all = all && (here || !entry.isDue());
  }
  return all;
}

void Host::pollUntil(Clock::time_point deadline) {
  fds_.clear();
  for (const Entry& entry : entries_) {
    entry.robot->addCommandDescriptor(fds_);
  }
  const std::size_t commands = fds_.size();
  for (const Entry& entry : entries_) {
    entry.robot->addDescriptors(fds_);
  }
  for (const Service* service : services_) {
    service->addDescriptors(fds_);
  }
  if (clock_.wait(fds_, std::max(deadline - clock_.now(), Clock::duration::zero()))) {
    for (std::size_t i = commands; i < fds_.size(); i++) {
      requests_ready_ = requests_ready_ || fds_[i].revents != 0;
    }
  }
  polled_ = true;
}

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
  if (idle_interval_ > Clock::duration::zero() && isIdle()) {
    waitIdle(end);
    return;
  }
  if (clientsAreDue()) {
    end = std::max(end, clock_.now() + std::min<Clock::duration>(kMinTimeToAnswer, period_));
  }
  listenUntil(end);
  slept_until_ = end;
}

bool Host::isIdle() const {
  return std::all_of(entries_.begin(), entries_.end(),
                     [](const Entry& entry) { return entry.robot->idle(); }) &&
         std::all_of(services_.begin(), services_.end(),
                     [](const Service* service) { return service->idle(); });
}

void Host::waitIdle(Clock::time_point end) {
  if (end - slept_until_ < idle_interval_ && slept_until_ < end) {
    return;
  }
  while (clock_.now() < end && isIdle()) {
    pollUntil(end);
    serveIfDue();
  }
  if (!isIdle()) {
    restartClock();  // a client does not wait for the time that the ticks are ahead
  }
  slept_until_ = deadline_;
}

void Host::listenUntil(Clock::time_point end) {
  do {
    pollUntil(end);
    receiveAll();
    serveIfDue();
  } while (clock_.now() < end);
}

bool Host::clientsAreDue() const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [](const Entry& entry) { return entry.isDue(); });
}

bool Host::hasAsynchronousMotion() const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [](const Entry& entry) { return entry.robot->asynchronous(); });
}

// In lock-step only the clock defines when the next tick of an asynchronous motion is due.
bool Host::followsClock() const {
  return pace_.mode == PaceMode::kPatient ||
         (pace_.mode != PaceMode::kFreeRunning && hasAsynchronousMotion());
}

// Whether an answer of a client that has not been given up is missing.
bool Host::isAnswerMissing() const {
  return std::any_of(entries_.begin(), entries_.end(), [](const Entry& entry) {
    return entry.isDue() && !entry.given_up && !entry.robot->receiveCommand();
  });
}

bool Host::mustAdvanceTime() {
  for (const Entry& entry : entries_) {
    if (entry.robot->settling() || entry.robot->handBusy() || entry.robot->asynchronous()) {
      rolling_ = std::max(rolling_, kTicksAfterAction);
    }
  }
  return rolling_ > 0;
}

bool Host::settlesInKnownTime() const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [](const Entry& entry) { return entry.robot->settlesInKnownTime(); });
}

void Host::dropSilentClients() {
  for (Entry& entry : entries_) {
    entry.given_up = entry.given_up || (entry.isDue() && !entry.robot->receiveCommand());
  }
}

void Host::waitInLockStep() {
  const bool news = std::any_of(entries_.begin(), entries_.end(),
                                [](const Entry& entry) { return entry.robot->hasPendingState(); });
  const bool due = clientsAreDue();
  if (due || news || followsClock() || clock_.now() - published_at_ >= kTick) {
    publishAll();
  }
  beginWait();
  const Clock::time_point begin = waited_until_;
  prepare_();
  // An answer takes a while; if none is expected, one look at the sockets is enough.
  if (due) {
    spin_rule_.spin([this] { return receiveAll(); }, [this] { return clock_.now(); });
  }
  if (!due || !receiveAll()) {
    pollUntil(due ? begin + kTick : begin);
  }
  while (!stopped()) {
    serveIfDue();
    receiveAll();
    if (clientsAreDue()) {
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
      if (!settlesInKnownTime()) {
        held_back_ = holdsRequestsBack() ? held_back_ + 1 : 0;
      }
      rolling_--;
      return;
    }
    held_back_ = 0;
    if (clock_.now() - published_at_ >= kTick) {
      publishAll(true);
    }
    pollUntil(published_at_ + kTick);
  }
}

void Host::beginWait() {
  waited_until_ = keep_waiting_called_at_ = clock_.now();
  waited_ = {};
  for (Entry& entry : entries_) {
    entry.starts_shown = entry.isDue() ? 1 : 0;
  }
}

// @returns whether there is still something to wait for.
bool Host::waitForClients() {
  // Time in which this process did not run must not count as the clients' silence.
  constexpr Clock::duration kMaxCountedTime = 2 * kTick;
  const Clock::time_point now = clock_.now();
  waited_ += std::min<Clock::duration>(now - waited_until_, kMaxCountedTime);
  waited_until_ = now;
  if (!isAnswerMissing() && (receiveAll() || waited_ >= kTick)) {
    return false;
  }
  if (hasTimedOut(now)) {
    dropSilentClients();
    return true;
  }
  publishWhileWaiting(now);
  pollUntil(now + kTick);
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

// Other clients must see that the robots are there. A state that shows a motion's client nothing
// new keeps its number: the motion's clock, which counts states, stands still as well. A client
// that has not answered gets no new state; it must answer the last one.
void Host::publishWhileWaiting(Clock::time_point now) {
  for (Entry& entry : entries_) {
    HostedRobot& robot = *entry.robot;
    if (entry.isStarting()) {
      // Before its first command a client receives states without answering them.
      if (now - entry.shown_at >= (entry.starts_shown < kPromptStarts ? kTick : kLaterStarts)) {
        publish(entry, true, now);
        entry.starts_shown++;
      }
    } else if (!robot.expectsCommand()) {
      if (now - entry.shown_at >= kTick) {
        publish(entry, true, now);
      }
    } else if (now - entry.shown_at >= kRepeatPeriod) {
      robot.repeat();
      entry.shown_at = now;
    }
  }
}

}  // namespace franka_sim::fci
