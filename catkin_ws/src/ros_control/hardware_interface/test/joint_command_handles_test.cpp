// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Handles that command a joint by several values, and its mode.
#include <gmock/gmock.h>
#include <hardware_interface/joint_mode_interface.h>
#include <hardware_interface/position_velocity_torque_gains_command_interface.h>
#include <hardware_interface/posvel_command_interface.h>
#include <hardware_interface/posvelacc_command_interface.h>

#include "refusal.h"

using namespace hardware_interface;
using hardware_interface_test::refusal;
using testing::ElementsAre;
using testing::IsEmpty;

namespace {

class JointCommandHandles : public testing::Test {
 protected:
  double pos_{1.0}, vel_{2.0}, eff_{3.0};
  double a_{0.0}, b_{0.0}, c_{0.0}, d_{0.0}, e_{0.0};
  JointStateHandle joint_{"j", &pos_, &vel_, &eff_};
};

}  // namespace

TEST_F(JointCommandHandles, PositionWithVelocity) {
  PosVelJointHandle handle(joint_, &a_, &b_);
  handle.setCommand(1.5, 2.5);
  EXPECT_EQ(1.5, a_);
  EXPECT_EQ(2.5, b_);
  handle.setCommandPosition(3.5);
  handle.setCommandVelocity(4.5);
  EXPECT_EQ(3.5, handle.getCommandPosition());
  EXPECT_EQ(4.5, handle.getCommandVelocity());
  EXPECT_EQ(&a_, handle.getCommandPositionPtr());
  EXPECT_EQ(&b_, handle.getCommandVelocityPtr());
  EXPECT_EQ(2.0, handle.getVelocity()) << "the state is another thing";
  EXPECT_EQ("Cannot create handle 'j'. Command position pointer is null.",
            refusal([&] { PosVelJointHandle(joint_, nullptr, &b_); }));
  EXPECT_EQ("Cannot create handle 'j'. Command velocity  pointer is null.",
            refusal([&] { PosVelJointHandle(joint_, &a_, nullptr); }));
  PosVelJointInterface interface;
  interface.registerHandle(handle);
  interface.getHandle("j");
  EXPECT_THAT(interface.getClaims(), ElementsAre("j"));
}

TEST_F(JointCommandHandles, PositionWithVelocityAndAcceleration) {
  PosVelAccJointHandle handle(joint_, &a_, &b_, &c_);
  handle.setCommand(1.5, 2.5, 3.5);
  EXPECT_EQ(1.5, a_);
  EXPECT_EQ(2.5, b_);
  EXPECT_EQ(3.5, c_);
  handle.setCommandAcceleration(4.5);
  EXPECT_EQ(4.5, handle.getCommandAcceleration());
  EXPECT_EQ(&c_, handle.getCommandAccelerationPtr());
  EXPECT_EQ("Cannot create handle 'j'. Command acceleration data pointer is null.",
            refusal([&] { PosVelAccJointHandle(joint_, &a_, &b_, nullptr); }));
  PosVelAccJointInterface interface;
  interface.registerHandle(handle);
  interface.getHandle("j");
  EXPECT_THAT(interface.getClaims(), ElementsAre("j"));
}

TEST_F(JointCommandHandles, PositionWithVelocityEffortAndGains) {
  typedef PositionVelocityTorqueGainsJointHandle Handle;
  Handle handle(joint_, &a_, &b_, &c_, &d_, &e_);
  handle.setCommand(1.5, 2.5, 3.5, 4.5, 5.5);
  EXPECT_EQ(1.5, handle.getCommandPosition());
  EXPECT_EQ(2.5, handle.getCommandVelocity());
  EXPECT_EQ(3.5, handle.getCommandEffort());
  EXPECT_EQ(4.5, handle.getCommandKp());
  EXPECT_EQ(5.5, handle.getCommandKd());
  EXPECT_EQ(3.5, c_);
  EXPECT_EQ(4.5, d_);
  EXPECT_EQ(5.5, e_);
  const std::string lead = "Cannot create handle 'j'. Command ";
  EXPECT_EQ(lead + "effort data pointer is null.",
            refusal([&] { Handle(joint_, &a_, &b_, nullptr, &d_, &e_); }));
  EXPECT_EQ(lead + "position gain data pointer is null.",
            refusal([&] { Handle(joint_, &a_, &b_, &c_, nullptr, &e_); }));
  EXPECT_EQ(lead + "derivative gain data pointer is null.",
            refusal([&] { Handle(joint_, &a_, &b_, &c_, &d_, nullptr); }));
  PositionVelocityTorqueGainsJointInterface interface;
  interface.registerHandle(handle);
  interface.getHandle("j");
  EXPECT_THAT(interface.getClaims(), ElementsAre("j"));
}

TEST_F(JointCommandHandles, Modes) {
  JointCommandModes mode = JointCommandModes::NOMODE;
  JointModeHandle handle("j", &mode);
  EXPECT_EQ("j", handle.getName());
  handle.setMode(JointCommandModes::MODE_EFFORT);
  EXPECT_EQ(JointCommandModes::MODE_EFFORT, mode);
  EXPECT_EQ(JointCommandModes::MODE_EFFORT, handle.getMode());
  EXPECT_EQ(&mode, handle.getModePtr());
  EXPECT_EQ("Cannot create mode interface. Mode data pointer is null.",
            refusal([] { JointModeHandle("j", nullptr); }));
  const char* const names[] = {"not_operational", "position",  "velocity", "effort", "other",
                               "emergency_stop",  "switching", "error",    "unknown"};
  for (int value = -1; value <= 7; ++value) {
    EXPECT_EQ(names[value + 1], handle.getModeName(static_cast<JointCommandModes>(value)));
  }
  JointModeInterface interface;
  interface.registerHandle(handle);
  interface.getHandle("j");
  EXPECT_THAT(interface.getClaims(), IsEmpty());
}

TEST(JointCommandHandlesDeathTest, DefaultConstructedHandlesMustNotBeUsed) {
  EXPECT_DEATH(PosVelJointHandle().setCommandPosition(1.0), ".*");
  EXPECT_DEATH(PosVelJointHandle().getCommandVelocity(), ".*");
  EXPECT_DEATH(PosVelAccJointHandle().setCommandAcceleration(1.0), ".*");
  EXPECT_DEATH(PositionVelocityTorqueGainsJointHandle().getCommandKp(), ".*");
  EXPECT_DEATH(JointModeHandle().getMode(), ".*");
}
