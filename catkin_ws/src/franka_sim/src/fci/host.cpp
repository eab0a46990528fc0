// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/fci/host.h>
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
constexpr std::uint64_t kLongestDeferral = 10000;

/// A longer delay of the host is not made up for (chosen here: a burst of ticks would lose more
/// commands).
constexpr std::chrono::milliseconds kMaxCatchUp{50};

/// Sockets are polled at least this often, even if commands come too fast for a poll.
constexpr std::chrono::milliseconds kServeAtLeast{1};

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

/// While the host makes up for a delay, clients still get this time for each answer (chosen here).
constexpr std::chrono::microseconds kLeastTimeToAnswer{400};

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

Host::Host(std::function<void()> step, const Pace& pace, std::function<void()> prepare)
    : step_(std::move(step)), prepare_(std::move(prepare)) {
  setPace(pace);
  // By default the system groups wake-ups within 50 us.
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
}

void Host::add(HostedRobot& robot) {
  entries_.push_back({&robot});
  fds_.reserve(16 * entries_.size());
}

void Host::add(Service& service) { services_.push_back(&service); }

void Host::remove(const HostedRobot& robot) {
  const auto is_robot = [&](const Entry& entry) { return entry.robot == &robot; };
  entries_.erase(std::remove_if(entries_.begin(), entries_.end(), is_robot), entries_.end());
}

void Host::remove(const Service& service) {
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

void Host::letRun(std::uint64_t ticks) { rolling_ = std::max(rolling_, ticks + kTicksAfterAction); }

void Host::advance(std::uint64_t ticks) { rolling_ = std::max(rolling_, ticks); }

void Host::beginAnew() {
  rolling_ = 0;
  letRun(1);
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
    if (heedsClock()) {
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
    entry.robot->publish(entry.robot->expectsCommand() ? 0 : 1, true);
  }
  serveAll();
  for (Service* service : services_) {
    service->published();
  }
  restartClock();
}

void Host::publishAll(bool same_moment) {
  published_at_ = Clock::now();
  for (Entry& entry : entries_) {
    publish(entry, same_moment, published_at_);
  }
  for (Service* service : services_) {
    service->published();
  }
}

void Host::publish(Entry& entry, bool same_moment, Clock::time_point now) {
  entry.robot->publish(std::max<std::uint64_t>(entry.unpublished_ticks, 1), same_moment);
  entry.unpublished_ticks = 0;
  entry.shown_at = now;
}

// System calls take longer than a control unit's tick, so sockets are read only when a poll reports
// data.
void Host::serveIfDue() {
  if (requests_ready_ || requests_left_ || Clock::now() - served_at_ >= kServeAtLeast) {
    serveAll();
  }
}

void Host::serveAll() {
  requests_ready_ = false;
  served_at_ = Clock::now();
  const bool stops_only = holdsRequestsBack();
  requests_left_ = stops_only;
  for (const Entry& entry : entries_) {
    entry.robot->serve(stops_only);
  }
  // The next states wait for commands, whose sender may itself wait for the answer of a service.
  const bool states_wait = pace_.waitsForClients() && clientsAreDue();
  for (Service* service : services_) {
    service->serve();
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
  return pace_.standsStill() && rolling_ > 0 && held_back_ < kLongestDeferral && !hand_busy &&
         !clientsAreDue() && !clientsAreAtLeisure();
}

bool Host::settled() const { return !pace_.standsStill() || isRestless() || atRest(); }

bool Host::isRestless() const { return pace_.standsStill() && held_back_ >= kLongestDeferral; }

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
  const auto left = std::max(deadline - Clock::now(), Clock::duration::zero());
  const timespec timeout = toTimespec(left);
  if (ppoll(fds_.data(), fds_.size(), &timeout, nullptr) > 0) {
    for (std::size_t i = commands; i < fds_.size(); i++) {
      requests_ready_ = requests_ready_ || fds_[i].revents != 0;
    }
  }
}

Host::Clock::time_point Host::nextDeadline() {
  deadline_ += period_;
  const Clock::time_point now = Clock::now();
  if (now - deadline_ > kMaxCatchUp) {
    deadline_ = now;
  }
  return deadline_;
}

void Host::waitInRealTime() {
  Clock::time_point end = nextDeadline();
  if (clientsAreDue()) {
    end = std::max(end, Clock::now() + std::min<Clock::duration>(kLeastTimeToAnswer, period_));
  }
  listenUntil(end);
}

void Host::listenUntil(Clock::time_point end) {
  do {
    pollUntil(end);
    receiveAll();
    serveIfDue();
  } while (Clock::now() < end);
}

bool Host::clientsAreDue() const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [](const Entry& entry) { return entry.isDue(); });
}

bool Host::clientsAreAtLeisure() const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [](const Entry& entry) { return entry.robot->asynchronous(); });
}

// In lock-step only the clock says when the next tick of an asynchronous motion is due; if time
// runs on, the other robots do.
bool Host::heedsClock() const {
  return pace_.mode == PaceMode::kPatient ||
         (pace_.mode != PaceMode::kFreeRunning && clientsAreAtLeisure());
}

// Whether an answer of a client that has not been given up is missing.
bool Host::answersAreMissing() const {
  return std::any_of(entries_.begin(), entries_.end(), [](const Entry& entry) {
    return entry.isDue() && !entry.given_up && !entry.robot->receiveCommand();
  });
}

bool Host::timeMustGoOn() {
  for (const Entry& entry : entries_) {
    if (entry.robot->settling() || entry.robot->handBusy() || entry.robot->asynchronous()) {
      rolling_ = std::max(rolling_, kTicksAfterAction);
    }
  }
  return rolling_ > 0;
}

bool Host::settlesInTime() const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [](const Entry& entry) { return entry.robot->settlesInTime(); });
}

void Host::giveUpOnTheSilent() {
  for (Entry& entry : entries_) {
    entry.given_up = entry.given_up || (entry.isDue() && !entry.robot->receiveCommand());
  }
}

void Host::waitInLockStep() {
  const bool news = std::any_of(entries_.begin(), entries_.end(),
                                [](const Entry& entry) { return entry.robot->hasNews(); });
  const bool due = clientsAreDue();
  if (due || news || heedsClock() || Clock::now() - published_at_ >= kTick) {
    publishAll();
  }
  beginWait();
  const Clock::time_point begin = looked_at_;
  prepare_();
  // An answer takes a while; if none is expected, one look at the sockets is enough.
  if (due) {
    spin_rule_.spin([this] { return receiveAll(); });
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
    if (timeMustGoOn()) {
      if (!settlesInTime()) {
        held_back_ = holdsRequestsBack() ? held_back_ + 1 : 0;
      }
      rolling_--;
      return;
    }
    held_back_ = 0;
    if (Clock::now() - published_at_ >= kTick) {
      publishAll(true);
    }
    pollUntil(published_at_ + kTick);
  }
}

void Host::beginWait() {
  looked_at_ = Clock::now();
  waited_ = {};
  for (Entry& entry : entries_) {
    entry.starts_shown = entry.isDue() ? 1 : 0;
  }
}

// @returns whether there is still something to wait for.
bool Host::waitForClients() {
  // Time in which this process did not run must not count as the clients' silence.
  constexpr Clock::duration kLongestLook = 2 * kTick;
  const Clock::time_point now = Clock::now();
  waited_ += std::min<Clock::duration>(now - looked_at_, kLongestLook);
  looked_at_ = now;
  if (!answersAreMissing() && (receiveAll() || waited_ >= kTick)) {
    return false;
  }
  if (waited_ >= pace_.patience) {
    giveUpOnTheSilent();
    return true;
  }
  showThatTimeStandsStill(now);
  pollUntil(now + kTick);
  return true;
}

// Other clients must see that the robots are there. A state that shows a motion's client nothing
// new keeps its number: the motion's clock, which counts states, stands still as well. A client
// that owes an answer gets no new state: it has all it needs.
void Host::showThatTimeStandsStill(Clock::time_point now) {
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
