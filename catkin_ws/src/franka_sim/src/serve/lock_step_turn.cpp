// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "serve/lock_step_turn.h"

#include <fcntl.h>
#include <sched.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <utility>

namespace franka_sim::fci {

namespace {

constexpr mode_t kOwnerOnly = 0700;

/// Opens a directory, if nobody but this user may write to it. Else nothing is opened: another
/// user's process could hold places for ever.
Descriptor openOwnDirectory(const std::string& path) noexcept {
  Descriptor directory(open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
  struct stat found{};
  const bool is_own = directory && fstat(directory.get(), &found) == 0 &&
                      found.st_uid == geteuid() && (found.st_mode & 0077) == 0;
  return is_own ? std::move(directory) : Descriptor();
}

/// The user's runtime directory, or one below /tmp where there is none, as in containers: the same
/// for all processes of a user.
Descriptor openUserDirectory() {
  const std::string user = std::to_string(geteuid());
  for (const std::string& path : {"/run/user/" + user + "/franka_sim", "/tmp/franka_sim-" + user}) {
    mkdir(path.c_str(), kOwnerOnly);
    if (Descriptor directory = openOwnDirectory(path)) {
      return directory;
    }
  }
  return Descriptor();
}

constexpr int kOpenFlags = O_RDWR | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC;

/// Locks a file of the directory, without waiting. @param create 0 or O_CREAT
/// @returns an empty descriptor if another process has it: then errno is EWOULDBLOCK
Descriptor lock(const Descriptor& directory, const char* name, int create) noexcept {
  Descriptor file(openat(directory.get(), name, kOpenFlags | create, 0600));
  if (file && flock(file.get(), LOCK_EX | LOCK_NB) != 0) {
    const int error = errno;
    file.close();
    errno = error;
  }
  return file;
}

/// "lock-step-3": the digits are the processors, a bit for each.
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
  return "lock-step-" + digits.substr(0, 64);
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

LockStepTurn::LockStepTurn(Descriptor directory, const std::string& name, int places)
    : directory_(std::move(directory)), name_(name), queue_(name + ".queue") {
  places_ = directory_ ? places : 0;
  if (directory_) {
    // Pipes hold what wakes the head; other files would grow.
    mkfifoat(directory_.get(), queue_.c_str(), 0600);
  }
}

LockStepTurn::LockStepTurn(const std::string& directory, const std::string& name, int places)
    : LockStepTurn(openOwnDirectory(directory), name, places) {}

LockStepTurn::LockStepTurn()
    : LockStepTurn(openUserDirectory(), nameOfProcessors(ownProcessors()),
                   countOf(ownProcessors())) {}

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
    head_ = lock(directory_, queue_.c_str(), 0);
    if (!head_) {
      return errno != EWOULDBLOCK && goWithout(now + kWithoutTurn);
    }
  }
  char bytes[16];
  while (read(head_.get(), bytes, sizeof(bytes)) > 0) {
  }
  return takePlace(now);
}

// Who has waited for long looks more often, so that the queue is nearly one in order.
LockStepTurn::Clock::duration LockStepTurn::retryAfter(Clock::time_point now) const noexcept {
  return std::max<Clock::duration>(kMaxRetry - (now - waiting_since_) / 20, kMinRetry);
}

bool LockStepTurn::takePlace(Clock::time_point now) noexcept {
  for (int place = 0; place < places_; place++) {
    char file[128];
    std::snprintf(file, sizeof(file), "%s.%d", name_.c_str(), place);
    place_ = lock(directory_, file, O_CREAT);
    if (place_) {
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
  const Descriptor queue(openat(directory_.get(), queue_.c_str(), kOpenFlags));
  if (!queue || flock(queue.get(), LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) {
    return false;
  }
  const char byte = 0;
  // A full pipe wakes it as well.
  return write(queue.get(), &byte, sizeof(byte)) >= 0 || errno == EAGAIN;
}

}  // namespace franka_sim::fci
