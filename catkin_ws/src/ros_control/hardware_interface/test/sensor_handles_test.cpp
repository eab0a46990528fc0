// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Handles of sensors.
#include <gmock/gmock.h>
#include <hardware_interface/force_torque_sensor_interface.h>
#include <hardware_interface/imu_sensor_interface.h>

using namespace hardware_interface;
using testing::IsEmpty;

TEST(SensorHandles, ForceTorqueSensor) {
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

TEST(SensorHandles, Imu) {
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
