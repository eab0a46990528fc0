// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/joint_state_interface.h>
#include <rt_guard/rt_guard.h>

#include <string>

#include "refusal.h"

using namespace hardware_interface;
using hardware_interface_test::textOf;
using testing::ElementsAre;
using testing::IsEmpty;

namespace {

class HandlesTest : public testing::Test {
 protected:
  double pos_{1.0}, vel_{2.0}, eff_{3.0}, abs_{4.0}, torque_{5.0}, cmd_{6.0};
  JointStateHandle state_{"joint", &pos_, &vel_, &eff_};
};

}  // namespace

TEST_F(HandlesTest, StateHandleReadsWhatTheRobotWrites) {
  EXPECT_EQ("joint", state_.getName());
  EXPECT_EQ(1.0, state_.getPosition());
  EXPECT_EQ(2.0, state_.getVelocity());
  EXPECT_EQ(3.0, state_.getEffort());
  const JointStateHandle copy = state_;
  pos_ = 7.0;
  EXPECT_EQ(7.0, copy.getPosition());
  EXPECT_EQ(&pos_, state_.getPositionPtr());
  EXPECT_EQ(&vel_, state_.getVelocityPtr());
  EXPECT_EQ(&eff_, state_.getEffortPtr());
}

TEST_F(HandlesTest, ConstructorDefinesOptionalSensors) {
  const JointStateHandle both("j", &pos_, &vel_, &eff_, &abs_, &torque_);
  EXPECT_TRUE(both.hasAbsolutePosition());
  EXPECT_TRUE(both.hasTorqueSensor());
  EXPECT_EQ(4.0, both.getAbsolutePosition());
  EXPECT_EQ(5.0, both.getTorqueSensor());
  EXPECT_EQ(&abs_, both.getAbsolutePositionPtr());
  EXPECT_EQ(&torque_, both.getTorqueSensorPtr());

  const JointStateHandle absolute("j", &pos_, &vel_, &eff_, &abs_);
  EXPECT_TRUE(absolute.hasAbsolutePosition());
  EXPECT_FALSE(absolute.hasTorqueSensor());

  const JointStateHandle torque("j", &pos_, &vel_, &eff_, &torque_, true);
  EXPECT_FALSE(torque.hasAbsolutePosition());
  EXPECT_TRUE(torque.hasTorqueSensor());
  EXPECT_EQ(5.0, torque.getTorqueSensor());
}

TEST_F(HandlesTest, MissingSensorsThrow) {
  EXPECT_EQ("Joint state handle does not contain absolute encoder position information",
            textOf<std::runtime_error>([&] { state_.getAbsolutePosition(); }));
  EXPECT_EQ("Joint state handle does not contain absolute position sensor information",
            textOf<std::runtime_error>([&] { state_.getAbsolutePositionPtr(); }));
  EXPECT_EQ("Joint state handle does not contain torque sensor information",
            textOf<std::runtime_error>([&] { state_.getTorqueSensor(); }));
  EXPECT_EQ("Joint state handle does not contain torque sensor information",
            textOf<std::runtime_error>([&] { state_.getTorqueSensorPtr(); }));
}

TEST_F(HandlesTest, NullPointersAreRefusedByName) {
  using E = HardwareInterfaceException;
  const double* const none = nullptr;
  EXPECT_EQ("Cannot create handle 'j'. Position data pointer is null.",
            textOf<E>([&] { JointStateHandle("j", none, &vel_, &eff_); }));
  EXPECT_EQ("Cannot create handle 'j'. Velocity data pointer is null.",
            textOf<E>([&] { JointStateHandle("j", &pos_, none, &eff_); }));
  EXPECT_EQ("Cannot create handle 'j'. Effort data pointer is null.",
            textOf<E>([&] { JointStateHandle("j", &pos_, &vel_, none); }));
  EXPECT_EQ("Cannot create handle 'j'. Absolute data pointer is null.",
            textOf<E>([&] { JointStateHandle("j", &pos_, &vel_, &eff_, none); }));
  EXPECT_EQ("Cannot create handle 'j'. Torque sensor data pointer is null.",
            textOf<E>([&] { JointStateHandle("j", &pos_, &vel_, &eff_, &abs_, none); }));
  EXPECT_EQ("Cannot create handle 'j'. Torque sensor data pointer is null.",
            textOf<E>([&] { JointStateHandle("j", &pos_, &vel_, &eff_, none, true); }));
  EXPECT_EQ("Cannot create handle 'joint'. Command data pointer is null.",
            textOf<E>([&] { JointHandle(state_, nullptr); }));
}

TEST_F(HandlesTest, CommandHandleWritesWhatTheRobotReads) {
  JointHandle handle(state_, &cmd_);
  EXPECT_EQ(6.0, handle.getCommand());
  handle.setCommand(8.0);
  EXPECT_EQ(8.0, cmd_);
  EXPECT_EQ(&cmd_, handle.getCommandPtr());
  EXPECT_EQ("joint", handle.getName());
}

TEST_F(HandlesTest, AccessInTheLoopNeitherAllocatesNorLocks) {
  JointHandle handle(state_, &cmd_);
  rt_guard::Scope scope;
  for (int i = 0; i < 1000; ++i) {
    handle.setCommand(handle.getPosition() + handle.getVelocity() + handle.getEffort());
  }
  EXPECT_EQ(0u, scope.allocations());
  EXPECT_EQ(0u, scope.locks());
}

TEST(HandlesDeathTest, DefaultConstructedHandlesMustNotBeUsed) {
  EXPECT_DEATH(JointStateHandle().getPosition(), ".*");
  EXPECT_DEATH(JointStateHandle().getVelocity(), ".*");
  EXPECT_DEATH(JointStateHandle().getEffort(), ".*");
  EXPECT_DEATH(JointHandle().getCommand(), ".*");
  EXPECT_DEATH(JointHandle().setCommand(1.0), ".*");
}

TEST_F(HandlesTest, OnlyCommandInterfacesClaim) {
  JointStateInterface states;
  states.registerHandle(state_);
  states.getHandle("joint");
  EXPECT_THAT(states.getClaims(), IsEmpty());

  EffortJointInterface efforts;
  efforts.registerHandle(JointHandle(state_, &cmd_));
  efforts.getHandle("joint");
  efforts.getHandle("joint");
  EXPECT_THAT(efforts.getClaims(), ElementsAre("joint"));
  efforts.clearClaims();
  EXPECT_THAT(efforts.getClaims(), IsEmpty());
}

TEST_F(HandlesTest, FailedLookUpThrowsAndClaimsNothing) {
  PositionJointInterface positions;
  positions.registerHandle(JointHandle(state_, &cmd_));
  EXPECT_EQ("Could not find resource 'elbow' in 'hardware_interface::PositionJointInterface'.",
            textOf<HardwareInterfaceException>([&] { positions.getHandle("elbow"); }));
  EXPECT_THAT(positions.getClaims(), IsEmpty());
}

TEST_F(HandlesTest, HandleOfTheSameNameReplaces) {
  VelocityJointInterface velocities;
  double other = 9.0;
  velocities.registerHandle(JointHandle(state_, &cmd_));
  velocities.registerHandle(JointHandle(state_, &other));
  EXPECT_THAT(velocities.getNames(), ElementsAre("joint"));
  EXPECT_EQ(9.0, velocities.getHandle("joint").getCommand());
}

TEST_F(HandlesTest, NamesAreSorted) {
  JointStateInterface states;
  for (const char* name : {"c", "a", "b"}) {
    states.registerHandle(JointStateHandle(name, &pos_, &vel_, &eff_));
  }
  EXPECT_THAT(states.getNames(), ElementsAre("a", "b", "c"));
}

TEST(DemangleTest, NamesMatchTheSource) {
  EXPECT_EQ("hardware_interface::EffortJointInterface",
            internal::demangledTypeName<EffortJointInterface>());
  const EffortJointInterface efforts;
  const HardwareInterface& base = efforts;
  EXPECT_EQ("hardware_interface::EffortJointInterface", internal::demangledTypeName(base));
  EXPECT_EQ("no mangled name", internal::demangleSymbol("no mangled name"));
}
