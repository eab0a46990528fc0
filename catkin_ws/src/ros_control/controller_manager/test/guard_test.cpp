// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The loop's side neither allocates nor locks nor makes system calls, whatever other threads do.
#include <rt_guard/rt_guard.h>
#include <rt_guard/syscall_guard.h>
#include <unistd.h>

#include <algorithm>

#include "supervision_fixture.h"

using dummies::kStrict;
using hardware_interface::RobotHW;

namespace {

class GuardTest : public dummies::ManagerTest {
 protected:
  void SetUp() override { load({"a", "b", "c", "d"}); }

  /// A step whose calls are counted.
  void guardedStep(bool reset = false) {
    time_ += ros::Duration(0.001);
    const ros::Duration period(0.001);
    const rt_guard::Scope scope;
    const rt_guard::SyscallScope syscalls;
    manager_->update(time_, period, reset);
    allocations_ += scope.allocations();
    locks_ += scope.locks();
    sleeps_ += scope.sleeps();
    if (syscalls.called()) {
      syscall_ = syscalls.number();
    }
  }

  void guardedSwitch(const Names& start, const Names& stop, bool asap) {
    const auto answer = postSwitch(start, stop, kStrict, asap, 60.0);
    waitFor([&] {
      guardedStep();
      return isReady(answer);
    });
  }

  void TearDown() override {
    EXPECT_EQ(0u, allocations_);
    EXPECT_EQ(0u, locks_);
    EXPECT_EQ(0u, sleeps_);
    EXPECT_EQ(-1, syscall_) << "the number of a system call";
  }

  std::size_t allocations_{0}, locks_{0}, sleeps_{0};
  int syscall_{-1};
};

}  // namespace

TEST_F(GuardTest, GuardCountsAllocationsAndLocks) {
  ASSERT_TRUE(rt_guard::kActive);
  std::size_t allocations = 0;
  std::size_t locks = 0;
  {
    const rt_guard::Scope scope;
    // Volatile, so that the compiler does not remove both calls.
    void* volatile memory = std::malloc(1);
    std::free(memory);
    std::mutex mutex;
    mutex.lock();
    mutex.unlock();
    allocations = scope.allocations();
    locks = scope.locks();
  }
  EXPECT_EQ(2u, allocations);
  EXPECT_EQ(1u, locks);
}

TEST_F(GuardTest, GuardDetectsSystemCalls) {
  {
    const rt_guard::SyscallScope scope;
    EXPECT_GT(getppid(), -1);
    EXPECT_EQ(rt_guard::SyscallScope::available(), scope.called());
  }
  const rt_guard::SyscallScope scope;
  (void)std::chrono::steady_clock::now();
  EXPECT_FALSE(scope.called()) << scope.number();
}

TEST_F(GuardTest, SteadyStateIsRealTimeSafe) {
  ASSERT_TRUE(doSwitch({"a", "c", "d"}, {}));
  for (int i = 0; i < 1000; ++i) {
    guardedStep();
  }
  guardedStep(true);
}

TEST_F(GuardTest, SwitchesAreRealTimeSafe) {
  for (const bool asap : {false, true}) {
    robot_.script_.assign(robot_.result_calls_ + 20, RobotHW::SwitchState::ONGOING);
    guardedSwitch({"a", "c"}, {}, asap);
    EXPECT_TRUE(controller("a").isRunning());
    guardedSwitch({"b", "c"}, {"a", "c"}, asap);
    EXPECT_TRUE(controller("b").isRunning());
    robot_.after_script_ = RobotHW::SwitchState::ERROR;
    guardedSwitch({"d"}, {"b", "c"}, asap);
    EXPECT_TRUE(controller("d").isAborted());
    robot_.after_script_ = RobotHW::SwitchState::DONE;
  }
}

TEST_F(GuardTest, LoadingAndUnloadingKeepTheLoopRealTimeSafe) {
  ASSERT_TRUE(doSwitch({"c"}, {}));
  std::atomic<bool> done{false};
  const auto others = std::async(std::launch::async, [&] {
    for (int i = 0; i < 50; ++i) {
      EXPECT_TRUE(manager_->unloadController("a"));
      EXPECT_TRUE(manager_->loadController("a"));
    }
    done = true;
  });
  waitFor([&] {
    guardedStep();
    return done.load();
  });
}

using dummies::SupervisionTest;

TEST_F(SupervisionTest, SupervisionNeitherAllocatesNorLocks) {
  own_.setParam("statistics_rate", 50.0);
  own_.setParam("max_update_time", 60.0);
  renewGuarded();
  std::size_t allocations = 0;
  std::size_t locks = 0;
  const ros::Duration period(0.001);
  int i = 0;
  waitFor([&] {
    dummies::FaultyController::inUpdate() =
        i == 200 ? dummies::FaultKind::kNan : dummies::FaultKind::kNone;
    time_ += period;
    {
      const rt_guard::Scope scope;
      const rt_guard::SyscallScope syscalls;
      manager_->update(time_, period);
      allocations += scope.allocations();
      locks += scope.locks();
      EXPECT_FALSE(syscalls.called()) << syscalls.number();
    }
    return ++i == 300;
  });
  EXPECT_TRUE(controller("faulty").isAborted());
  EXPECT_EQ(0u, allocations);
  EXPECT_EQ(0u, locks);
}
