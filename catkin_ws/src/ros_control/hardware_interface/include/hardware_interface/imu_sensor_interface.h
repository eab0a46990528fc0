// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/internal/hardware_resource_manager.h>

#include <string>

namespace hardware_interface {

/// Reads one inertial measurement unit. Pointers of missing quantities are null. Real-time safe.
/// Exceptions: the constructors, getName and getFrameId.
class ImuSensorHandle {
 public:
  /// Values that the robot writes, in the sensor's frame. Vectors are (x, y, z); covariances are
  /// 3x3, row by row, as in sensor_msgs/Imu.
  struct Data {
    std::string name;                                 ///< of the sensor
    std::string frame_id;                             ///< in which it measures
    double* orientation{nullptr};                     ///< quaternion (x, y, z, w)
    double* orientation_covariance{nullptr};          ///< [rad^2]
    double* angular_velocity{nullptr};                ///< [rad/s]
    double* angular_velocity_covariance{nullptr};     ///< [rad^2/s^2]
    double* linear_acceleration{nullptr};             ///< [m/s^2]
    double* linear_acceleration_covariance{nullptr};  ///< [m^2/s^4]
  };

  ImuSensorHandle() = default;
  ImuSensorHandle(const Data& data)  // NOLINT: implicit, as clients use it
      : ImuSensorHandle(data.name, data.frame_id, data.orientation, data.orientation_covariance,
                        data.angular_velocity, data.angular_velocity_covariance,
                        data.linear_acceleration, data.linear_acceleration_covariance) {}
  ImuSensorHandle(const std::string& name, const std::string& frame_id, const double* orientation,
                  const double* orientation_covariance, const double* angular_velocity,
                  const double* angular_velocity_covariance, const double* linear_acceleration,
                  const double* linear_acceleration_covariance)
      : name_(name),
        frame_id_(frame_id),
        orientation_(orientation),
        orientation_covariance_(orientation_covariance),
        angular_velocity_(angular_velocity),
        angular_velocity_covariance_(angular_velocity_covariance),
        linear_acceleration_(linear_acceleration),
        linear_acceleration_covariance_(linear_acceleration_covariance) {}

  /// @name The sensor and its values, with the units of Data
  /// @{
  std::string getName() const { return name_; }
  std::string getFrameId() const { return frame_id_; }
  const double* getOrientation() const { return orientation_; }
  const double* getOrientationCovariance() const { return orientation_covariance_; }
  const double* getAngularVelocity() const { return angular_velocity_; }
  const double* getAngularVelocityCovariance() const { return angular_velocity_covariance_; }
  const double* getLinearAcceleration() const { return linear_acceleration_; }
  const double* getLinearAccelerationCovariance() const { return linear_acceleration_covariance_; }
  /// @}

 private:
  std::string name_;
  std::string frame_id_;
  const double* orientation_{nullptr};
  const double* orientation_covariance_{nullptr};
  const double* angular_velocity_{nullptr};
  const double* angular_velocity_covariance_{nullptr};
  const double* linear_acceleration_{nullptr};
  const double* linear_acceleration_covariance_{nullptr};
};

/// Inertial measurement units, for any number of readers.
class ImuSensorInterface : public HardwareResourceManager<ImuSensorHandle> {};

}  // namespace hardware_interface
