// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/hardware_interface.h>

#include <cassert>
#include <stdexcept>
#include <string>

namespace hardware_interface {

/// What JointStateHandle and ActuatorStateHandle have in common: reads the state of one joint or
/// actuator. It points to values that the robot writes in `read()`; copies point to the same
/// values. Units: position [rad] or [m], velocity [rad/s] or [m/s], effort [Nm] or [N].
/// Real-time safe. Exceptions: the constructors and getName.
/// @tparam Texts the errors of sensors that do not exist
template <class Texts>
class StateHandle {
 public:
  StateHandle() = default;

  /// All constructors: @throws HardwareInterfaceException if a pointer is null.
  StateHandle(const std::string& name, const double* pos, const double* vel, const double* eff)
      : name_(name),
        pos_(require(pos, "Position")),
        vel_(require(vel, "Velocity")),
        eff_(require(eff, "Effort")) {}

  /// With an absolute encoder and a torque sensor.
  StateHandle(const std::string& name, const double* pos, const double* vel, const double* eff,
              const double* absolute_pos, const double* torque_sensor)
      : StateHandle(name, pos, vel, eff) {
    absolute_pos_ = require(absolute_pos, "Absolute");
    torque_sensor_ = require(torque_sensor, "Torque sensor");
  }

  /// With an absolute encoder.
  StateHandle(const std::string& name, const double* pos, const double* vel, const double* eff,
              const double* absolute_pos)
      : StateHandle(name, pos, vel, eff) {
    absolute_pos_ = require(absolute_pos, "Absolute");
  }

  /// With a torque sensor; the bool only distinguishes this constructor from the previous one.
  StateHandle(const std::string& name, const double* pos, const double* vel, const double* eff,
              const double* torque_sensor, bool /*tag*/)
      : StateHandle(name, pos, vel, eff) {
    torque_sensor_ = require(torque_sensor, "Torque sensor");
  }

  /// The name of the joint or actuator.
  std::string getName() const { return name_; }

  /// @name The measured values
  /// @{
  double getPosition() const {
    assert(pos_);
    return *pos_;
  }
  double getVelocity() const {
    assert(vel_);
    return *vel_;
  }
  double getEffort() const {
    assert(eff_);
    return *eff_;
  }
  /// @}
  /// @throws std::runtime_error for those without an absolute encoder.
  double getAbsolutePosition() const {
    if (!hasAbsolutePosition()) {
      throw std::runtime_error(Texts::kNoAbsolutePosition);
    }
    return *absolute_pos_;
  }
  /// @throws std::runtime_error for those without a torque sensor.
  double getTorqueSensor() const {
    if (!hasTorqueSensor()) {
      throw std::runtime_error(Texts::kNoTorqueSensor);
    }
    return *torque_sensor_;
  }

  /// @name Where the robot writes the measured values
  /// @{
  const double* getPositionPtr() const { return pos_; }
  const double* getVelocityPtr() const { return vel_; }
  const double* getEffortPtr() const { return eff_; }
  /// @}
  /// @throws std::runtime_error for those without an absolute encoder.
  const double* getAbsolutePositionPtr() const {
    if (!hasAbsolutePosition()) {
      throw std::runtime_error(Texts::kNoAbsolutePositionPtr);
    }
    return absolute_pos_;
  }
  /// @throws std::runtime_error for those without a torque sensor.
  const double* getTorqueSensorPtr() const {
    if (!hasTorqueSensor()) {
      throw std::runtime_error(Texts::kNoTorqueSensor);
    }
    return torque_sensor_;
  }

  /// @name Whether it has these sensors
  /// @{
  bool hasAbsolutePosition() const { return absolute_pos_ != nullptr; }
  bool hasTorqueSensor() const { return torque_sensor_ != nullptr; }
  /// @}

 private:
  const double* require(const double* data, const char* quantity) const {
    if (data == nullptr) {
      throw HardwareInterfaceException("Cannot create handle '" + name_ + "'. " + quantity +
                                       " data pointer is null.");
    }
    return data;
  }

  std::string name_;
  const double* pos_{nullptr};
  const double* vel_{nullptr};
  const double* eff_{nullptr};
  const double* absolute_pos_{nullptr};
  const double* torque_sensor_{nullptr};
};

}  // namespace hardware_interface
