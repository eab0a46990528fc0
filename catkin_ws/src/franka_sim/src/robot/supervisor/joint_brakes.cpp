// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/supervisor/joint_brakes.h"

namespace franka_sim {

namespace {

constexpr int kRestingTicks = 20;  // of standstill until a stop or a recovery ends
// Chosen here: the time for the arm to come to rest after its desired motion. The brakes also close
// on an arm that something else still moves then.
constexpr int kClosingTicks = 100;

}  // namespace

void JointBrakes::close(bool rests) noexcept {
  ticks_ = 0;
  resting_ticks_ = 0;
  closed_ = closed_ || rests;
}

bool JointBrakes::hasComeToRest(bool rests) noexcept {
  resting_ticks_ = rests ? resting_ticks_ + 1 : 0;
  return resting_ticks_ >= kRestingTicks;
}

// They wait for the end of what still swings: 0.01 rad/s stopped in one tick are 7 Nm at the first
// joint.
void JointBrakes::step(bool rests) noexcept {
  ticks_++;
  closed_ = hasComeToRest(rests) || ticks_ >= kClosingTicks;
}

void JointBrakes::restart(bool closed) noexcept {
  resting_ticks_ = 0;
  closed_ = closed;
}

}  // namespace franka_sim
