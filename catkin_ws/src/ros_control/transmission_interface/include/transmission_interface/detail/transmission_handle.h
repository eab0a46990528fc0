// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <transmission_interface/transmission.h>
#include <transmission_interface/transmission_interface_exception.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace transmission_interface {

/// A transmission with the values that it maps. Derived handles map one kind of values in one
/// direction, by their propagate(). Real-time safe. Exceptions: the constructor and getName.
class TransmissionHandle {
 public:
  std::string getName() const { return name_; }
  /// Whether the handle uses this transmission.
  bool maps(const Transmission* transmission) const noexcept {
    return transmission_ == transmission;
  }

 protected:
  /// @param transmission must outlive the handle; so must the values that the data point to.
  /// @throws TransmissionInterfaceException without a transmission or any data, and for vectors of
  /// another size or with null pointers.
  TransmissionHandle(const std::string& name, Transmission* transmission,
                     const ActuatorData& actuator_data, const JointData& joint_data)
      : name_(name),
        transmission_(transmission),
        actuator_data_(actuator_data),
        joint_data_(joint_data) {
    if (transmission == nullptr) {
      refuse("there is no transmission");
    }
    const std::size_t with_data = check("actuator", actuator_data_, transmission->numActuators()) +
                                  check("joint", joint_data_, transmission->numJoints());
    if (with_data == 0) {
      refuse("all data vectors are empty, so there is nothing to map");
    }
  }

  /// Requires the kind of values that a handle maps on both sides.
  void require(const std::vector<double*>& actuator_values,
               const std::vector<double*>& joint_values, const char* kind) const {
    if (actuator_values.empty() || joint_values.empty()) {
      refuse(std::string("it maps ") + kind +
             ", but the actuators or the joints have no such data");
    }
  }

  std::string name_;
  Transmission* transmission_;
  ActuatorData actuator_data_;
  JointData joint_data_;

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw TransmissionInterfaceException("Cannot create transmission handle '" + name_ +
                                         "': " + why + ".");
  }

  /// @returns the number of nonempty vectors.
  template <class Data>
  std::size_t check(const std::string& side, const Data& data, std::size_t size) const {
    return check(side + " position", data.position, size) +
           check(side + " velocity", data.velocity, size) +
           check(side + " effort", data.effort, size) +
           check(side + " absolute position", data.absolute_position, size) +
           check(side + " torque sensor", data.torque_sensor, size);
  }
  std::size_t check(const std::string& what, const std::vector<double*>& values,
                    std::size_t size) const {
    if (values.empty()) {
      return 0;
    }
    if (values.size() != size) {
      refuse("the size of the " + what + " data is " + std::to_string(values.size()) +
             ", that of the transmission " + std::to_string(size));
    }
    if (std::count(values.begin(), values.end(), nullptr) > 0) {
      refuse("the " + what + " data contain a null pointer");
    }
    return 1;
  }
};

}  // namespace transmission_interface
