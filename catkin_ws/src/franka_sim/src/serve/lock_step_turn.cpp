// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "serve/lock_step_turn.h"

#include <sched.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <utility>

namespace franka_sim::fci {

namespace {

constexpr int kHead = -1;

struct Name {
  sockaddr_un address;
  socklen_t size;
};

/// "NAME 0" for the first place, "NAME queue" for the head of the queue.
Name nameOf(const std::string& name, int place) noexcept {
  Name result{};
  result.address.sun_family = AF_UNIX;
  char* const text = result.address.sun_path + 1;  // after the zero of the abstract namespace
  constexpr std::size_t kCapacity = sizeof(result.address.sun_path) - 1;
  const int length = place == kHead ? std::snprintf(text, kCapacity, "%s queue", name.c_str())
                                    : std::snprintf(text, kCapacity, "%s %d", name.c_str(), place);
  const std::size_t used = std::min<std::size_t>(std::max(length, 0), kCapacity - 1);
  result.size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + used);
  return result;
}

Descriptor makeSocket() noexcept {
  return Descriptor(socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
}

bool bindTo(const Descriptor& socket, const Name& name) noexcept {
  return bind(socket.get(), reinterpret_cast<const sockaddr*>(&name.address), name.size) == 0;
}

/// "franka_sim lock-step 3": the digits are the processors, a bit for each.
std::string nameOfProcessors(const cpu_set_t& processors) {
  std::string digits;
  for (int i = 0; i < CPU_SETSIZE; i += 4) {
    int digit = 0;
    for (int bit = 0; bit < 4; bit++) {
      digit |= CPU_ISSET(i + bit, &processors) ? 1 << bit : 0;
    }
    digits += "0123456789abcdef"[digit];
  }
  digits.erase(digits.find_last_not_of('0') + 1);
  return "franka_sim lock-step " + digits.substr(0, 64);
}

/// Empty on machines with more processors than the set has places for.
cpu_set_t ownProcessors() noexcept {
  cpu_set_t processors;
  CPU_ZERO(&processors);
  sched_getaffinity(0, sizeof(processors), &processors);
  return processors;
}

int countOf(const cpu_set_t& processors) noexcept { return CPU_COUNT(&processors); }

}  // namespace

LockStepTurn::LockStepTurn(std::string name, int places)
    : name_(std::move(name)), places_(places) {}

LockStepTurn::LockStepTurn()
    : LockStepTurn(nameOfProcessors(ownProcessors()), countOf(ownProcessors())) {}

bool LockStepTurn::take(Clock::time_point now) noexcept {
  if (place_) {
    slow_answers_ = 0;
    if (now - since_ < kLength) {
      return true;
    }
    place_.close();
    if (!wakeNext() && takePlace(now)) {
      return true;
    }
  }
  if (places_ == 0 || now < without_until_) {
    return true;
  }
  if (waiting_since_ == Clock::time_point{}) {
    waiting_since_ = now;
  }
  if (now - waiting_since_ >= kMaxWait) {
    timeouts_++;
    return goWithout(timeouts_ == 1 ? now + kLength : now + kWithoutTurn);
  }
  if (!head_) {
    Descriptor socket = makeSocket();
    if (!socket) {
      return goWithout(now + kWithoutTurn);
    }
    if (!bindTo(socket, nameOf(name_, kHead))) {
      return errno != EADDRINUSE && goWithout(now + kWithoutTurn);
    }
    head_ = std::move(socket);
  }
  char datagram = 0;
  while (recv(head_.get(), &datagram, sizeof(datagram), 0) >= 0) {
  }
  return takePlace(now);
}

// Who has waited for long looks more often, so that the queue is nearly one in order.
LockStepTurn::Clock::duration LockStepTurn::retryAfter(Clock::time_point now) const noexcept {
  return std::max<Clock::duration>(kMaxRetry - (now - waiting_since_) / 20, kMinRetry);
}

bool LockStepTurn::takePlace(Clock::time_point now) noexcept {
  Descriptor socket = makeSocket();
  for (int place = 0; place < places_; place++) {
    if (bindTo(socket, nameOf(name_, place))) {
      place_ = std::move(socket);
      head_.close();
      since_ = now;
      timeouts_ = 0;
      waiting_since_ = {};
      return true;
    }
  }
  return false;
}

bool LockStepTurn::goWithout(Clock::time_point end) noexcept {
  head_.close();
  without_until_ = end;
  waiting_since_ = {};
  return true;
}

void LockStepTurn::give() noexcept {
  head_.close();
  waiting_since_ = {};
  if (place_) {
    place_.close();
    wakeNext();
  }
}

void LockStepTurn::giveForSilence(Clock::time_point now) noexcept {
  if (!place_) {
    return;
  }
  give();
  if (++slow_answers_ == kSlowAnswers) {
    slow_answers_ = 0;
    without_until_ = now + kSlowClient;
  }
}

// @returns whether a process is at the head of the queue.
bool LockStepTurn::wakeNext() noexcept {
  const Descriptor socket = makeSocket();
  const Name head = nameOf(name_, kHead);
  const char datagram = 0;
  const auto* const address = reinterpret_cast<const sockaddr*>(&head.address);
  // A full queue of datagrams wakes it as well.
  return sendto(socket.get(), &datagram, sizeof(datagram), 0, address, head.size) >= 0 ||
         errno == EAGAIN;
}

}  // namespace franka_sim::fci
