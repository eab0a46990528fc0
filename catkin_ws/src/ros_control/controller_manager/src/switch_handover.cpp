// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <controller_manager/internal/switch_handover.h>
#include <ros/init.h>

#include <limits>
#include <thread>
#include <utility>

namespace controller_manager {
namespace internal {

using Phase = SwitchRequest::Phase;

namespace {
constexpr std::chrono::microseconds kPollPeriod{200};
// The original's extra time beyond the timeout, for a loop whose clock stands still.
constexpr double kExtraTime = 1.0;
}  // namespace

SwitchHandover::SwitchHandover(LoopGate& gate) : gate_(gate) {}

void SwitchHandover::serve(hardware_interface::RobotHW& robot, const ros::Time& time) {
  SwitchRequest* request = for_loop_.load(std::memory_order_seq_cst);
  if (request == nullptr) {
    return;
  }
  bool settled = false;
  try {
    settled = request->advance(robot, time);
  } catch (...) {
    finish(*request);
    throw;
  }
  if (settled) {
    finish(*request);
  }
}

void SwitchHandover::finish(SwitchRequest& request) {
  for_loop_.store(nullptr, std::memory_order_release);
  request.phase.store(Phase::kDone, std::memory_order_release);
}

bool SwitchHandover::mustEnd() const { return closed_ || !ros::ok(); }

bool SwitchHandover::grant() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (busy_) {
    return false;
  }
  dropFinished();
  if (request_) {
    return false;
  }
  busy_ = true;
  busy_since_ = Clock::now();
  return true;
}

bool SwitchHandover::involves(const std::string& name) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!busy_) {
    dropFinished();
  }
  return request_ && request_->phase != Phase::kDone && request_->involves(name);
}

void SwitchHandover::awaitEnd(Clock::duration limit) {
  const auto under_way = [&] {
    const std::lock_guard<std::mutex> lock(mutex_);
    return busy_ && Clock::now() - busy_since_ < limit;
  };
  while (under_way() && !mustEnd()) {
    std::this_thread::sleep_for(kPollPeriod);
  }
}

void SwitchHandover::dropFinished() {
  if (request_ && request_->phase == Phase::kDone) {
    request_.reset();
  }
}

SwitchHandover::Turn::Turn(SwitchHandover& handover, double timeout)
    : handover_(handover), timeout_(timeout), begin_(Clock::now()) {
  while (!(granted_ = handover_.grant()) && !handover_.mustEnd() &&
         !(timeout_ > 0.0 && elapsed() > timeout_)) {
    std::this_thread::sleep_for(kPollPeriod);
  }
}

SwitchHandover::Turn::~Turn() {
  if (granted_) {
    const std::lock_guard<std::mutex> lock(handover_.mutex_);
    handover_.dropFinished();
    handover_.busy_ = false;
  }
}

double SwitchHandover::Turn::elapsed() const {
  return std::chrono::duration<double>(Clock::now() - begin_).count();
}

void SwitchHandover::Turn::post(std::unique_ptr<SwitchRequest> request) {
  const std::lock_guard<std::mutex> lock(handover_.mutex_);
  handover_.request_ = std::move(request);
  handover_.for_loop_.store(handover_.request_.get(), std::memory_order_seq_cst);
}

SwitchHandover::Result SwitchHandover::Turn::await() {
  // Only the holder of the turn replaces the request, so it may be read without the mutex.
  SwitchRequest& request = *handover_.request_;
  while (request.phase.load(std::memory_order_acquire) != Phase::kDone) {
    const double limit = timeout_ > 0.0 ? timeout_ : std::numeric_limits<double>::infinity();
    const bool must_end = handover_.mustEnd();
    if ((must_end || elapsed() > limit) && withdraw()) {
      return Result::kWithdrawn;
    }
    if (must_end || elapsed() > limit + kExtraTime) {
      request.canceled.store(true, std::memory_order_relaxed);
      return Result::kAbandoned;
    }
    std::this_thread::sleep_for(kPollPeriod);
  }
  return Result::kDone;
}

bool SwitchHandover::Turn::withdraw() {
  Phase expected = Phase::kPosted;
  if (!handover_.request_->phase.compare_exchange_strong(expected, Phase::kWithdrawn)) {
    return false;
  }
  handover_.for_loop_.store(nullptr, std::memory_order_seq_cst);
  const bool left = handover_.gate_.waitUntilLeft(LoopGate::kMaxCycleTime);
  const std::lock_guard<std::mutex> lock(handover_.mutex_);
  handover_.withdrawn_.push_back(std::move(handover_.request_));
  if (left) {
    handover_.withdrawn_.clear();
  }
  return true;
}

}  // namespace internal
}  // namespace controller_manager
