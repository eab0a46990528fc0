// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <hardware_interface/actuator_command_interface.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/joint_state_interface.h>
#include <rt_guard/rt_guard.h>

#include <stdexcept>
#include <string>

#include "refusal.h"

using namespace hardware_interface;
using hardware_interface_test::refusal;
using testing::ElementsAre;
using testing::IsEmpty;

namespace {

class HandlesTest : public testing::Test {
 protected:
  double pos_{1.0}, vel_{2.0}, eff_{3.0}, cmd_{6.0};
  JointStateHandle state_{"joint", &pos_, &vel_, &eff_};
};

/// The states of joints and of actuators.
template <class Handle>
class StateHandles : public testing::Test {
 protected:
  double v_[5] = {1.0, 2.0, 3.0, 4.0, 5.0};
  const Handle plain_{"j", v_, v_ + 1, v_ + 2};
  const Handle both_{"j", v_, v_ + 1, v_ + 2, v_ + 3, v_ + 4};
  const Handle absolute_{"j", v_, v_ + 1, v_ + 2, v_ + 3};
  const Handle torque_{"j", v_, v_ + 1, v_ + 2, v_ + 4, true};
};
using StateHandleTypes = testing::Types<JointStateHandle, ActuatorStateHandle>;
TYPED_TEST_SUITE(StateHandles, StateHandleTypes);

}  // namespace

TYPED_TEST(StateHandles, ReadWhatTheRobotWrites) {
  const TypeParam copy = this->plain_;
  this->v_[0] = 7.0;
  EXPECT_EQ("j", copy.getName());
  EXPECT_EQ(7.0, copy.getPosition());
  EXPECT_EQ(2.0, copy.getVelocity());
  EXPECT_EQ(3.0, copy.getEffort());
  EXPECT_EQ(this->v_, copy.getPositionPtr());
  EXPECT_EQ(this->v_ + 1, copy.getVelocityPtr());
  EXPECT_EQ(this->v_ + 2, copy.getEffortPtr());
}

TYPED_TEST(StateHandles, ConstructorDefinesOptionalSensors) {
  for (const TypeParam* handle : {&this->both_, &this->absolute_}) {
    EXPECT_TRUE(handle->hasAbsolutePosition());
    EXPECT_EQ(4.0, handle->getAbsolutePosition());
    EXPECT_EQ(this->v_ + 3, handle->getAbsolutePositionPtr());
  }
  for (const TypeParam* handle : {&this->both_, &this->torque_}) {
    EXPECT_TRUE(handle->hasTorqueSensor());
    EXPECT_EQ(5.0, handle->getTorqueSensor());
    EXPECT_EQ(this->v_ + 4, handle->getTorqueSensorPtr());
  }
  for (const TypeParam* handle : {&this->plain_, &this->torque_}) {
    EXPECT_FALSE(handle->hasAbsolutePosition());
    EXPECT_THROW(handle->getAbsolutePosition(), std::runtime_error);
    EXPECT_THROW(handle->getAbsolutePositionPtr(), std::runtime_error);
  }
  for (const TypeParam* handle : {&this->plain_, &this->absolute_}) {
    EXPECT_FALSE(handle->hasTorqueSensor());
    EXPECT_THROW(handle->getTorqueSensor(), std::runtime_error);
    EXPECT_THROW(handle->getTorqueSensorPtr(), std::runtime_error);
  }
}

TYPED_TEST(StateHandles, NullPointersAreRefusedByName) {
  const double* const none = nullptr;
  const double* const p = this->v_;
  const std::string lead = "Cannot create handle 'j'. ";
  EXPECT_EQ(lead + "Position data pointer is null.", refusal([&] { TypeParam("j", none, p, p); }));
  EXPECT_EQ(lead + "Velocity data pointer is null.", refusal([&] { TypeParam("j", p, none, p); }));
  EXPECT_EQ(lead + "Effort data pointer is null.", refusal([&] { TypeParam("j", p, p, none); }));
  EXPECT_EQ(lead + "Absolute data pointer is null.",
            refusal([&] { TypeParam("j", p, p, p, none); }));
  const std::string torque = lead + "Torque sensor data pointer is null.";
  EXPECT_EQ(torque, refusal([&] { TypeParam("j", p, p, p, p, none); }));
  EXPECT_EQ(torque, refusal([&] { TypeParam("j", p, p, p, none, true); }));
}

TEST_F(HandlesTest, CommandsOfActuatorsClaimNothing) {
  const ActuatorStateHandle motor("m", &pos_, &vel_, &eff_);
  ActuatorHandle handle(motor, &cmd_);
  handle.setCommand(7.0);
  EXPECT_EQ(7.0, cmd_);
  *handle.getCommandPtr() = 8.0;
  EXPECT_EQ(8.0, handle.getCommand());
  EffortActuatorInterface efforts;
  efforts.registerHandle(handle);
  EXPECT_EQ(8.0, efforts.getHandle("m").getCommand());
  EXPECT_THAT(efforts.getClaims(), IsEmpty());
  EXPECT_EQ("Cannot create handle 'm'. Command data pointer is null.",
            refusal([&] { ActuatorHandle(motor, nullptr); }));
}

TEST_F(HandlesTest, CommandHandleWritesWhatTheRobotReads) {
  JointHandle handle(state_, &cmd_);
  EXPECT_EQ(6.0, handle.getCommand());
  handle.setCommand(8.0);
  EXPECT_EQ(8.0, cmd_);
  EXPECT_EQ(&cmd_, handle.getCommandPtr());
  EXPECT_EQ("joint", handle.getName());
  EXPECT_EQ("Cannot create handle 'joint'. Command data pointer is null.",
            refusal([&] { JointHandle(state_, nullptr); }));
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
  EXPECT_DEATH(ActuatorStateHandle().getPosition(), ".*");
  EXPECT_DEATH(ActuatorHandle().setCommand(1.0), ".*");
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
            refusal([&] { positions.getHandle("elbow"); }));
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
