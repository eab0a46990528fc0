// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Handles of actuators.
#include <gmock/gmock.h>
#include <hardware_interface/actuator_command_interface.h>

#include <stdexcept>

#include "refusal.h"

using namespace hardware_interface;
using hardware_interface_test::refusal;
using hardware_interface_test::textOf;
using testing::IsEmpty;

namespace {

class ActuatorHandles : public testing::Test {
 protected:
  double pos_{1.0}, vel_{2.0}, eff_{3.0}, abs_{4.0}, torque_{5.0}, a_{0.0};
  ActuatorStateHandle motor_{"m", &pos_, &vel_, &eff_};
};

}  // namespace

TEST_F(ActuatorHandles, StatesOfActuators) {
  EXPECT_EQ("m", motor_.getName());
  EXPECT_EQ(1.0, motor_.getPosition());
  EXPECT_EQ(2.0, motor_.getVelocity());
  EXPECT_EQ(3.0, motor_.getEffort());
  EXPECT_EQ(&pos_, motor_.getPositionPtr());
  EXPECT_EQ(&vel_, motor_.getVelocityPtr());
  EXPECT_EQ(&eff_, motor_.getEffortPtr());
  EXPECT_FALSE(motor_.hasAbsolutePosition() || motor_.hasTorqueSensor());

  const ActuatorStateHandle both("m", &pos_, &vel_, &eff_, &abs_, &torque_);
  EXPECT_EQ(4.0, both.getAbsolutePosition());
  EXPECT_EQ(5.0, both.getTorqueSensor());
  const ActuatorStateHandle absolute("m", &pos_, &vel_, &eff_, &abs_);
  EXPECT_TRUE(absolute.hasAbsolutePosition() && !absolute.hasTorqueSensor());
  const ActuatorStateHandle torque("m", &pos_, &vel_, &eff_, &torque_, true);
  EXPECT_TRUE(torque.hasTorqueSensor() && !torque.hasAbsolutePosition());
  EXPECT_EQ(&torque_, torque.getTorqueSensorPtr());
}

TEST_F(ActuatorHandles, MissingActuatorSensorsThrow) {
  for (const auto& action : {+[](const ActuatorStateHandle& h) { h.getAbsolutePosition(); },
                             +[](const ActuatorStateHandle& h) { h.getAbsolutePositionPtr(); }}) {
    EXPECT_EQ("Actuator does not support absolute encoders",
              textOf<std::runtime_error>([&] { action(motor_); }));
  }
  for (const auto& action : {+[](const ActuatorStateHandle& h) { h.getTorqueSensor(); },
                             +[](const ActuatorStateHandle& h) { h.getTorqueSensorPtr(); }}) {
    EXPECT_EQ("Actuator does not support torque sensors",
              textOf<std::runtime_error>([&] { action(motor_); }));
  }
}

TEST_F(ActuatorHandles, NullPointersOfActuatorsAreRefusedByName) {
  const double* const none = nullptr;
  const std::string lead = "Cannot create handle 'm'. ";
  EXPECT_EQ(lead + "Position data pointer is null.",
            refusal([&] { ActuatorStateHandle("m", none, &vel_, &eff_); }));
  EXPECT_EQ(lead + "Velocity data pointer is null.",
            refusal([&] { ActuatorStateHandle("m", &pos_, none, &eff_); }));
  EXPECT_EQ(lead + "Effort data pointer is null.",
            refusal([&] { ActuatorStateHandle("m", &pos_, &vel_, none); }));
  EXPECT_EQ(lead + "Absolute data pointer is null.",
            refusal([&] { ActuatorStateHandle("m", &pos_, &vel_, &eff_, none); }));
  EXPECT_EQ(lead + "Torque sensor data pointer is null.",
            refusal([&] { ActuatorStateHandle("m", &pos_, &vel_, &eff_, &abs_, none); }));
  EXPECT_EQ(lead + "Torque sensor data pointer is null.",
            refusal([&] { ActuatorStateHandle("m", &pos_, &vel_, &eff_, none, true); }));
  EXPECT_EQ(lead + "Command data pointer is null.",
            refusal([&] { ActuatorHandle(motor_, nullptr); }));
}

TEST_F(ActuatorHandles, CommandsOfActuatorsClaimNothing) {
  ActuatorHandle handle(motor_, &a_);
  handle.setCommand(7.0);
  EXPECT_EQ(7.0, a_);
  *handle.getCommandPtr() = 8.0;
  EXPECT_EQ(8.0, handle.getCommand());
  EffortActuatorInterface efforts;
  efforts.registerHandle(handle);
  EXPECT_EQ(8.0, efforts.getHandle("m").getCommand());
  EXPECT_THAT(efforts.getClaims(), IsEmpty());
  EXPECT_EQ("Could not find resource 'x' in 'hardware_interface::EffortActuatorInterface'.",
            refusal([&] { efforts.getHandle("x"); }));
}

TEST(ActuatorHandlesDeathTest, DefaultConstructedHandlesMustNotBeUsed) {
  EXPECT_DEATH(ActuatorStateHandle().getPosition(), ".*");
  EXPECT_DEATH(ActuatorHandle().setCommand(1.0), ".*");
}
