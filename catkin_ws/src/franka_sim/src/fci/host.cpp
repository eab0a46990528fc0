// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/fci/host.h>
#include <sys/prctl.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <thread>
#include <utility>

namespace franka_sim::fci {

namespace {

constexpr std::chrono::milliseconds kTick{1};

/// Physics continues for this long after an action, until everything has come to rest
/// (decision 21).
constexpr std::uint64_t kTicksAfterAction = 100;

/// In lock-step requests wait until the world has come to rest, but for no more ticks than this: it
/// may never do so, as where two arms press on each other (our choice).
constexpr std::uint64_t kLongestDeferral = 10000;

/// A host that was held up for longer does not make up for it (our choice).
constexpr std::chrono::milliseconds kForgivenDelay{50};

/// Sockets are looked after so often even where commands come so fast that nobody polls.
constexpr std::chrono::milliseconds kServeAtLeast{1};

/// A client that waits for another one's answer gives up after a second without a state; genuine
/// ones and ours drop a state that they have already, and wait on (our choice).
constexpr std::chrono::milliseconds kSignOfLife{300};

/// In lock-step, for so long an answer is waited for without going to sleep, where another
/// processor can work on it meanwhile (our choice).
constexpr std::chrono::microseconds kSwiftAnswer{100};

/// Before its first command a client takes two states that show the motion, at once. More are for
/// one that missed them. They come as slowly as the second after which clients give up allows: each
/// that comes while a starved client works on its first answer puts its clock, which counts states,
/// ahead of the arm's, and runs would not repeat (our choice).
constexpr int kPromptStarts = 2;
constexpr std::chrono::milliseconds kLaterStarts{600};

/// While it makes up for a delay, clients still get so long for each answer (our choice).
constexpr std::chrono::microseconds kLeastTimeToAnswer{400};

timespec toTimespec(std::chrono::nanoseconds duration) noexcept {
  constexpr std::int64_t kNanoseconds = 1000000000;
  return {static_cast<time_t>(duration.count() / kNanoseconds),
          static_cast<long>(duration.count() % kNanoseconds)};
}

/// Another mode while it lives.
class ModeForNow {
 public:
  ModeForNow(Pace& pace, PaceMode mode) noexcept : pace_(pace), before_(pace.mode) {
    pace_.mode = mode;
  }
  ~ModeForNow() { pace_.mode = before_; }
  ModeForNow(const ModeForNow&) = delete;
  ModeForNow& operator=(const ModeForNow&) = delete;

 private:
  Pace& pace_;
  const PaceMode before_;
};

}  // namespace

Host::Host(std::function<void()> step, const Pace& pace, std::function<void()> prepare)
    : step_(std::move(step)),
      prepare_(std::move(prepare)),
      spin_(std::thread::hardware_concurrency() > 1) {
  setPace(pace);
  // Wake-ups are otherwise gathered within 50 us.
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
}

void Host::add(HostedRobot& robot) {
  guests_.push_back({&robot});
  fds_.reserve(16 * guests_.size());
}

void Host::add(Service& service) { services_.push_back(&service); }

void Host::remove(const HostedRobot& robot) {
  const auto is_robot = [&](const Guest& guest) { return guest.robot == &robot; };
  guests_.erase(std::remove_if(guests_.begin(), guests_.end(), is_robot), guests_.end());
}

void Host::setPace(const Pace& pace) {
  pace_ = pace;
  period_ = std::chrono::nanoseconds(std::llround(1e6 / (pace.factor > 0.0 ? pace.factor : 1.0)));
  rolling_ = 0;
  restartClock();
}

void Host::letRun(std::uint64_t ticks) { rolling_ = std::max(rolling_, ticks + kTicksAfterAction); }

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
  for (const Guest& guest : guests_) {
    guest.robot->observe();
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
  for (const Guest& guest : guests_) {
    guest.robot->actuate();
  }
  step_();
  ticks_++;
  for (Guest& guest : guests_) {
    guest.unpublished_ticks++;
  }
}

void Host::tickAtOnce() {
  const ModeForNow free_running(pace_, PaceMode::kFreeRunning);
  tick();
}

void Host::standStill() {
  for (const Guest& guest : guests_) {
    guest.robot->publish(guest.robot->expectsCommand() ? 0 : 1, true);
  }
  serveAll();
  restartClock();
}

void Host::publishAll(bool same_moment) {
  published_at_ = Clock::now();
  for (Guest& guest : guests_) {
    publish(guest, same_moment, published_at_);
  }
  for (Service* service : services_) {
    service->published();
  }
}

void Host::publish(Guest& guest, bool same_moment, Clock::time_point now) {
  guest.robot->publish(std::max<std::uint64_t>(guest.unpublished_ticks, 1), same_moment);
  guest.unpublished_ticks = 0;
  guest.shown_at = now;
}

// System calls cost more than a control unit's tick: sockets are asked only when they have
// something to say.
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
  for (const Guest& guest : guests_) {
    guest.robot->serve(stops_only);
  }
  // The next states wait for commands. Their sender may be waiting for an answer of a service.
  const bool states_wait = pace_.waitsForClients() && clientsAreDue();
  for (Service* service : services_) {
    service->serve();
    if (states_wait) {
      service->published();
    }
  }
}

// While the world comes to rest by itself, a request must not meet it at a tick that depends on
// how fast the client was.
bool Host::holdsRequestsBack() const {
  const bool hand_busy = std::any_of(guests_.begin(), guests_.end(),
                                     [](const Guest& guest) { return guest.robot->handBusy(); });
  return pace_.standsStill() && rolling_ > 0 && held_back_ < kLongestDeferral && !hand_busy &&
         !clientsAreDue() && !clientsAreAtLeisure();
}

bool Host::settled() const {
  const auto moves = [](const Guest& guest) {
    return guest.robot->expectsCommand() || guest.robot->settling() || guest.robot->handBusy();
  };
  return !pace_.standsStill() || held_back_ >= kLongestDeferral ||
         (rolling_ == 0 && std::none_of(guests_.begin(), guests_.end(), moves));
}

bool Host::receiveAll() {
  bool all = true;
  for (Guest& guest : guests_) {
    const bool here = guest.robot->receiveCommand();
    if (here) {
      guest.given_up = false;
    }
    all = all && (here || !guest.isDue());
  }
  return all;
}

void Host::pollUntil(Clock::time_point deadline) {
  fds_.clear();
  for (const Guest& guest : guests_) {
    guest.robot->addCommandDescriptor(fds_);
  }
  const std::size_t commands = fds_.size();
  for (const Guest& guest : guests_) {
    guest.robot->addDescriptors(fds_);
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
  if (now - deadline_ > kForgivenDelay) {
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
  return std::any_of(guests_.begin(), guests_.end(),
                     [](const Guest& guest) { return guest.isDue(); });
}

bool Host::clientsAreAtLeisure() const {
  return std::any_of(guests_.begin(), guests_.end(),
                     [](const Guest& guest) { return guest.robot->asynchronous(); });
}

// In lock-step nothing but the clock says when the next tick of an asynchronous motion is due; in
// time that flows the others do.
bool Host::heedsClock() const {
  return pace_.mode == PaceMode::kPatient ||
         (pace_.mode != PaceMode::kFreeRunning && clientsAreAtLeisure());
}

// Of those that have not been given up.
bool Host::somebodyIsAwaited() const {
  return std::any_of(guests_.begin(), guests_.end(), [](const Guest& guest) {
    return guest.isDue() && !guest.given_up && !guest.robot->receiveCommand();
  });
}

bool Host::timeMustGoOn() {
  for (const Guest& guest : guests_) {
    if (guest.robot->settling() || guest.robot->handBusy() || guest.robot->asynchronous()) {
      rolling_ = std::max(rolling_, kTicksAfterAction);
    }
  }
  return rolling_ > 0;
}

void Host::giveUpOnTheSilent() {
  for (Guest& guest : guests_) {
    guest.given_up = guest.given_up || (guest.isDue() && !guest.robot->receiveCommand());
  }
}

void Host::waitInLockStep() {
  const bool news = std::any_of(guests_.begin(), guests_.end(),
                                [](const Guest& guest) { return guest.robot->hasNews(); });
  const bool due = clientsAreDue();
  if (due || news || heedsClock() || Clock::now() - published_at_ >= kTick) {
    publishAll();
  }
  beginWait();
  const Clock::time_point begin = looked_at_;
  prepare_();
  // Whoever answers takes a while; where nobody does, one look at the sockets is enough.
  if (due) {
    awaitSwiftAnswers(begin);
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
      held_back_ = holdsRequestsBack() ? held_back_ + 1 : 0;
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

// Going to sleep and waking up takes longer than many a client needs to answer.
void Host::awaitSwiftAnswers(Clock::time_point begin) {
  while (spin_ && !receiveAll() && Clock::now() - begin < kSwiftAnswer) {
  }
}

void Host::beginWait() {
  looked_at_ = Clock::now();
  waited_ = {};
  for (Guest& guest : guests_) {
    guest.starts_shown = guest.isDue() ? 1 : 0;
  }
}

// @returns whether there is still something to wait for.
bool Host::waitForClients() {
  // A process that was held up itself has heard nobody meanwhile: that is not the clients' silence.
  constexpr Clock::duration kLongestLook = 2 * kTick;
  const Clock::time_point now = Clock::now();
  waited_ += std::min<Clock::duration>(now - looked_at_, kLongestLook);
  looked_at_ = now;
  if (!somebodyIsAwaited() && (receiveAll() || waited_ >= kTick)) {
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

// Clients that the tick does not wait for must see that the robots are there. A state that shows a
// motion's client nothing new keeps its number: the motion's clock, which counts states, stands
// still as well. Nothing new goes to a client that owes an answer: it has all it needs.
void Host::showThatTimeStandsStill(Clock::time_point now) {
  for (Guest& guest : guests_) {
    HostedRobot& robot = *guest.robot;
    if (guest.isStarting()) {
      // Until its first command a client takes states without answering them.
      if (now - guest.shown_at >= (guest.starts_shown < kPromptStarts ? kTick : kLaterStarts)) {
        publish(guest, true, now);
        guest.starts_shown++;
      }
    } else if (!robot.expectsCommand()) {
      if (now - guest.shown_at >= kTick) {
        publish(guest, true, now);
      }
    } else if (now - guest.shown_at >= kSignOfLife) {
      robot.repeat();
      guest.shown_at = now;
    }
  }
}

}  // namespace franka_sim::fci
