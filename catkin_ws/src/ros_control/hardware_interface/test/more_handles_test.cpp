// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <hardware_interface/actuator_command_interface.h>
#include <hardware_interface/force_torque_sensor_interface.h>
#include <hardware_interface/imu_sensor_interface.h>
#include <hardware_interface/joint_mode_interface.h>
#include <hardware_interface/position_velocity_torque_gains_command_interface.h>
#include <hardware_interface/posvel_command_interface.h>
#include <hardware_interface/posvelacc_command_interface.h>

#include <stdexcept>
#include <string>

using namespace hardware_interface;
using testing::ElementsAre;
using testing::IsEmpty;

namespace {

template <class Exception, class Action>
std::string textOf(Action action) {
  try {
    action();
  } catch (const Exception& error) {
    return error.what();
  }
  return "(nothing was thrown)";
}

template <class Action>
std::string refusal(Action action) {
  return textOf<HardwareInterfaceException>(action);
}

class MoreHandles : public testing::Test {
 protected:
  double pos_{1.0}, vel_{2.0}, eff_{3.0}, abs_{4.0}, torque_{5.0};
  double a_{0.0}, b_{0.0}, c_{0.0}, d_{0.0}, e_{0.0};
  JointStateHandle joint_{"j", &pos_, &vel_, &eff_};
  ActuatorStateHandle motor_{"m", &pos_, &vel_, &eff_};
};

using MoreHandlesDeathTest = MoreHandles;

}  // namespace

TEST_F(MoreHandles, PositionWithVelocity) {
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

TEST_F(MoreHandles, PositionWithVelocityAndAcceleration) {
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

TEST_F(MoreHandles, PositionWithVelocityEffortAndGains) {
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

TEST_F(MoreHandles, Modes) {
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

TEST_F(MoreHandles, StatesOfActuators) {
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

TEST_F(MoreHandles, MissingActuatorSensorsThrow) {
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

TEST_F(MoreHandles, NullPointersOfActuatorsAreRefusedByName) {
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

TEST_F(MoreHandles, CommandsOfActuatorsClaimNothing) {
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

TEST_F(MoreHandles, ForceTorqueSensor) {
  const double force[3] = {1.0, 2.0, 3.0}, torque[3] = {4.0, 5.0, 6.0};
  ForceTorqueSensorInterface interface;
  interface.registerHandle(ForceTorqueSensorHandle("wrist", "panda_K", force, torque));
  const ForceTorqueSensorHandle handle = interface.getHandle("wrist");
  EXPECT_EQ("wrist", handle.getName());
  EXPECT_EQ("panda_K", handle.getFrameId());
  EXPECT_EQ(force, handle.getForce());
  EXPECT_EQ(torque, handle.getTorque());
  EXPECT_THAT(interface.getClaims(), IsEmpty());
  EXPECT_EQ(nullptr, ForceTorqueSensorHandle("f", "f", force, nullptr).getTorque());
}

TEST_F(MoreHandles, Imu) {
  double values[6] = {};
  ImuSensorHandle::Data data;
  EXPECT_EQ(nullptr, data.orientation);
  data.name = "imu";
  data.frame_id = "base";
  data.orientation = &values[0];
  data.orientation_covariance = &values[1];
  data.angular_velocity = &values[2];
  data.angular_velocity_covariance = &values[3];
  data.linear_acceleration = &values[4];
  data.linear_acceleration_covariance = &values[5];
  ImuSensorInterface interface;
  interface.registerHandle(data);
  interface.registerHandle(
      {"second", "base", &values[0], &values[1], &values[2], &values[3], &values[4], &values[5]});
  for (const char* name : {"imu", "second"}) {
    const ImuSensorHandle handle = interface.getHandle(name);
    EXPECT_EQ(name, handle.getName());
    EXPECT_EQ("base", handle.getFrameId());
    EXPECT_EQ(&values[0], handle.getOrientation());
    EXPECT_EQ(&values[1], handle.getOrientationCovariance());
    EXPECT_EQ(&values[2], handle.getAngularVelocity());
    EXPECT_EQ(&values[3], handle.getAngularVelocityCovariance());
    EXPECT_EQ(&values[4], handle.getLinearAcceleration());
    EXPECT_EQ(&values[5], handle.getLinearAccelerationCovariance());
  }
  EXPECT_EQ(nullptr, ImuSensorHandle().getOrientation());
}

TEST_F(MoreHandlesDeathTest, DefaultConstructedHandlesMustNotBeUsed) {
  EXPECT_DEATH(PosVelJointHandle().setCommandPosition(1.0), ".*");
  EXPECT_DEATH(PosVelJointHandle().getCommandVelocity(), ".*");
  EXPECT_DEATH(PosVelAccJointHandle().setCommandAcceleration(1.0), ".*");
  EXPECT_DEATH(PositionVelocityTorqueGainsJointHandle().getCommandKp(), ".*");
  EXPECT_DEATH(JointModeHandle().getMode(), ".*");
  EXPECT_DEATH(ActuatorStateHandle().getPosition(), ".*");
  EXPECT_DEATH(ActuatorHandle().setCommand(1.0), ".*");
}
