// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "serve/hosted_robots.h"

#include <algorithm>
#include <utility>

namespace franka_sim::fci {

namespace {

/// While time stands still, clients receive the last state so often.
constexpr std::chrono::milliseconds kStateInterval{1};

/// Sockets are polled at least this often, even if commands come too fast for a poll.
constexpr std::chrono::milliseconds kMaxServeInterval{1};

/// Robots without clients are served so often if a poll reports nothing (chosen here: opens and
/// closes their ports in time). Serving one looks at three sockets, with a system call each.
constexpr std::chrono::milliseconds kMaxIdleServeInterval{10};

/// A client that waits for another one's answer gives up after a second without a state; genuine
/// clients and ours drop a repeated state and wait on. Chosen here: three repeats fit into that
/// second.
constexpr std::chrono::milliseconds kRepeatPeriod{300};

/// Before its first command a client needs two states that show the motion, one after the other;
/// they are sent at once. Clients of libfranka take the newest state in their socket, so the next
/// one is sent when the client has read the last one.
/// Further states are for a client that missed one of them. Each that arrives while a client works
/// on its first answer puts its clock, which counts states, ahead of the arm's, and runs would not
/// repeat. So a client gets one only if it waits for it: it has read a repeat of the last state,
/// and has not answered that state. If it is unknown what the client has read, it gets one as late
/// as its timeout of a second allows, without the time in which this process did not run (chosen
/// here).
constexpr int kPromptStarts = 2;
constexpr std::chrono::milliseconds kLaterStarts{600};

/// The state that shows the end of a motion remains its client's newest one for so long, unless the
/// client sends a request before: a client that runs too late would find a state of the braking arm
/// in its place, and its exception would not repeat. Clients of libfranka send a StopMove within a
/// millisecond; others may be silent, and the timeout of a second is theirs, too (chosen here).
constexpr std::chrono::milliseconds kEndKept{600};

}  // namespace

void HostedRobots::add(HostedRobot& robot) {
  entries_.push_back({&robot});
  fds_.reserve(16 * entries_.size());
}

void HostedRobots::remove(const HostedRobot& robot) noexcept {
  const auto is_robot = [&](const Entry& entry) { return entry.robot == &robot; };
  entries_.erase(std::remove_if(entries_.begin(), entries_.end(), is_robot), entries_.end());
}

void HostedRobots::remove(const Service& service) noexcept {
  services_.erase(std::remove(services_.begin(), services_.end(), &service), services_.end());
}

void HostedRobots::observe() {
  for (const Entry& entry : entries_) {
    entry.robot->observe();
  }
}

void HostedRobots::actuate() {
  for (const Entry& entry : entries_) {
    entry.robot->actuate();
  }
}

void HostedRobots::finishTick() noexcept {
  for (Entry& entry : entries_) {
    entry.unpublished_ticks++;
  }
}

void HostedRobots::publish(bool same_tick) {
  published_at_ = clock_.now();
  for (Entry& entry : entries_) {
    publish(entry, same_tick, published_at_);
  }
  reportPublished();
}

void HostedRobots::publish(Entry& entry, bool same_tick, Clock::time_point now) {
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

void HostedRobots::publishHalted() {
  for (const Entry& entry : entries_) {
    entry.robot->publish(entry.robot->expectsCommand() ? 0 : 1, true, false);
  }
}

void HostedRobots::reportPublished() {
  for (Service* service : services_) {
    service->published();
  }
}

// Other clients must see that the robots are there. A state that shows a motion's client nothing
// new keeps its number: the motion's clock, which counts states, stands still as well. A client
// that has not answered gets no new state; it must answer the last one.
void HostedRobots::publishWhileWaiting(Clock::time_point now, Clock::duration waited) {
  for (Entry& entry : entries_) {
    // Before its first command a client receives states without answering them.
    if (entry.isStarting() && isStartDue(entry, now, waited - entry.start_shown_after)) {
      publish(entry, true, now);
      entry.starts_shown++;
      entry.start_shown_after = waited;
      entry.start_is_repeated = false;
    } else {
      repeatIfDue(entry, now);
    }
  }
}

// Remembers whether it is known what the client has read.
// @param waited since the last state of this start
bool HostedRobots::isStartDue(Entry& entry, Clock::time_point now, Clock::duration waited) {
  const bool is_late = waited >= kLaterStarts;
  const bool has_answers = entry.robot->hasPendingState();  // they follow a state
  if (entry.starts_shown < kPromptStarts) {
    if (waited < kStateInterval) {
      return false;
    }
    const std::optional<bool> has_read = entry.robot->clientHasReadStates();
    entry.reads_are_known = has_read.has_value();
    return is_late || has_answers || has_read.value_or(true);
  }
  if (has_answers || !entry.reads_are_known) {
    return is_late;
  }
  // A client that works on its answer sends it before it reads the repeat.
  return entry.start_is_repeated && now - entry.shown_at >= kRepeatPeriod &&
         entry.robot->clientHasReadStates().value_or(false) && entry.isMissing();
}

// The client of a motion gets no new state; the last one, repeated, keeps it waiting.
bool HostedRobots::publishToOthers(Clock::time_point now) {
  bool exist = false;
  for (Entry& entry : entries_) {
    exist = exist || !entry.robot->expectsCommand();
    repeatIfDue(entry, now);
  }
  return exist;
}

void HostedRobots::repeatIfDue(Entry& entry, Clock::time_point now) {
  if (!entry.robot->expectsCommand()) {
    if (now - entry.shown_at >= kStateInterval) {
      publish(entry, true, now);
    }
  } else if (now - entry.shown_at >= kRepeatPeriod) {
    entry.start_is_repeated = entry.robot->repeat();
    entry.shown_at = now;
  }
}

bool HostedRobots::isServeDue() const {
  return requests_ready_ || requests_left_ || clock_.now() - served_at_ >= kMaxServeInterval;
}

void HostedRobots::serve(bool stops_only) {
  served_at_ = clock_.now();
  const bool reported = std::exchange(requests_ready_, false);
  const bool polled = std::exchange(polled_, false);
  const bool all = reported || !polled || served_at_ - served_idle_at_ >= kMaxIdleServeInterval;
  served_idle_at_ = all ? served_at_ : served_idle_at_;
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

bool HostedRobots::receiveCommands() {
  bool all = true;
  for (Entry& entry : entries_) {
    const bool here = entry.robot->receiveCommand();
    if (here) {
      entry.given_up = entry.silence_reported = false;
    }
    all = all && (here || !entry.isDue());
  }
  return all;
}

void HostedRobots::pollUntil(Clock::time_point deadline) {
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

void HostedRobots::beginWait() {
  for (Entry& entry : entries_) {
    entry.starts_shown = entry.isDue() ? 1 : 0;
    entry.start_shown_after = {};
    entry.reads_are_known = entry.start_is_repeated = false;
  }
}

void HostedRobots::dropSilentClients(bool report) {
  for (Entry& entry : entries_) {
    if (entry.isMissing()) {
      entry.given_up = true;
      if (report) {
        entry.robot->reportSilence(Silence::kGivenUp);
      }
    }
  }
}

void HostedRobots::reportSilentClients() {
  for (Entry& entry : entries_) {
    if (!entry.silence_reported && entry.isMissing()) {
      entry.silence_reported = true;
      entry.robot->reportSilence(Silence::kLong);
    }
  }
}

bool HostedRobots::isAnswerMissing() const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [](const Entry& entry) { return entry.isMissing(); });
}

bool HostedRobots::isIdle() const {
  return std::all_of(entries_.begin(), entries_.end(),
                     [](const Entry& entry) { return entry.robot->idle(); }) &&
         std::all_of(services_.begin(), services_.end(),
                     [](const Service* service) { return service->idle(); });
}

bool HostedRobots::clientsAreDue() const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [](const Entry& entry) { return entry.isDue(); });
}

bool HostedRobots::any(bool (HostedRobot::*is)() const) const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [is](const Entry& entry) { return (entry.robot->*is)(); });
}

}  // namespace franka_sim::fci
