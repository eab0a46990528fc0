// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// The control loop on real sockets neither allocates, locks nor sleeps on its own thread.
#include <franka/active_control_base.h>
#include <rt_guard/rt_guard.h>

#include <optional>

#include "robot_fixture.h"

namespace franka_test {
namespace {

using franka::Duration;
using franka::RobotState;

constexpr int kFirst = 10, kLast = 210;

/// Counts from one callback to the next; operations inside the callbacks are the user's and not
/// counted.
class Window {
 public:
  void tick() {
    ticks_++;
    if (ticks_ == kFirst) {
      scope_.emplace();
    } else if (ticks_ == kLast) {
      allocations_ = scope_->allocations();
      locks_ = scope_->locks();
      sleeps_ = scope_->sleeps();
      scope_.reset();
    }
  }
  bool isOver() const { return ticks_ >= kLast; }
  void expectNothing() const {
    EXPECT_GE(ticks_, kLast);
    EXPECT_EQ(0u, allocations_);
    EXPECT_EQ(0u, locks_);
    EXPECT_EQ(0u, sleeps_);
  }

 private:
  int ticks_{0};
  std::optional<rt_guard::Scope> scope_;
  std::size_t allocations_{1}, locks_{1}, sleeps_{1};
};

using RealTime = EveryVersion;

template <typename Value>
std::function<Value(const RobotState&, Duration)> ticking(Window& window, const Value& value) {
  return [&window, value](const RobotState&, Duration) {
    window.tick();
    return window.isOver() ? franka::MotionFinished(value) : value;
  };
}

template <typename Value>
std::function<Value(const RobotState&, Duration)> constantly(const Value& value) {
  return [value](const RobotState&, Duration) { return value; };
}

TEST_P(RealTime, LoopsNeitherAllocateNorLock) {
  const franka::Torques torques({1, 2, 3, 4, 5, 6, 7});
  const franka::JointPositions positions({0.1, -0.8, 0, -2.4, 0, 1.6, 0.8});
  const franka::JointVelocities velocities({0.1, 0.2, 0, 0, 0, 0, 0});
  const franka::CartesianPose pose({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.1, 0.2, 0.3, 1},
                                   {0.1, -1.0});
  const franka::CartesianVelocities twist({0.1, 0, 0, 0, 0, 0.1}, {0.1, -1.0});
  const auto robot = connect(fake);
  const std::function<void(Window&)> motions[] = {
      [&](Window& w) { robot->control(ticking(w, torques)); },
      [&](Window& w) { robot->control(ticking(w, positions)); },
      [&](Window& w) { robot->control(ticking(w, velocities)); },
      [&](Window& w) { robot->control(ticking(w, pose)); },
      [&](Window& w) { robot->control(ticking(w, twist)); },
      [&](Window& w) { robot->control(constantly(torques), ticking(w, positions)); },
      [&](Window& w) { robot->control(constantly(torques), ticking(w, twist)); },
  };
  for (const auto& motion : motions) {
    Window window;
    motion(window);
    if (rt_guard::kActive) {
      window.expectNothing();
    }
  }
}

TEST_P(RealTime, ActiveControlNeitherAllocatesNorLocks) {
  const auto robot = connect(fake);
  const auto motion = robot->startTorqueControl();
  Window window;
  while (!window.isOver()) {
    motion->readOnce();
    motion->writeOnce(franka::Torques({1, 2, 3, 4, 5, 6, 7}));
    window.tick();
  }
  if (rt_guard::kActive) {
    window.expectNothing();
  }
}

// Shows that the count works.
TEST(RealTimeWindow, DetectsAllocationsOfACallback) {
  FakeRobot fake(5);
  const auto robot = connect(fake);
  int cycles = 0;
  std::size_t allocations = 0;
  rt_guard::Scope scope;
  robot->control([&](const RobotState&, Duration) {
    const std::size_t before = scope.allocations();
    const auto allocated = std::make_unique<volatile int>(1);
    allocations += scope.allocations() - before;
    const franka::Torques torques({0, 0, 0, 0, 0, 0, 0});
    return ++cycles == 10 ? franka::MotionFinished(torques) : torques;
  });
  EXPECT_EQ(rt_guard::kActive ? 10u : 0u, allocations);  // a sanitizer owns malloc
}

INSTANTIATE_TEST_SUITE_P(All, RealTime, ::testing::ValuesIn(kVersions), versionName);

}  // namespace
}  // namespace franka_test
