// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <transmission_interface/transmission.h>
#include <transmission_interface/transmission_interface_exception.h>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace transmission_interface {
namespace internal {

/// Base of transmissions with two actuators and two joints: a reduction at each of them, an offset
/// at the joints, and access to two values.
class PairTransmission : public Transmission {
 public:
  std::size_t numActuators() const override { return 2; }
  std::size_t numJoints() const override { return 2; }

  const std::vector<double>& getActuatorReduction() const { return act_reduction_; }
  const std::vector<double>& getJointReduction() const { return jnt_reduction_; }
  const std::vector<double>& getJointOffset() const { return jnt_offset_; }

 protected:
  /// @param kind of transmission, for the text of the exception
  /// @throws TransmissionInterfaceException for sizes other than two and reductions of zero.
  PairTransmission(const std::string& kind, const std::vector<double>& actuator_reduction,
                   const std::vector<double>& joint_reduction,
                   const std::vector<double>& joint_offset)
      : act_reduction_(actuator_reduction),
        jnt_reduction_(joint_reduction),
        jnt_offset_(joint_offset) {
    if (act_reduction_.size() != 2 || jnt_reduction_.size() != 2 || jnt_offset_.size() != 2) {
      throw TransmissionInterfaceException("Reduction and offset vectors of a " + kind +
                                           " transmission must have size 2.");
    }
    for (const auto* reductions : {&act_reduction_, &jnt_reduction_}) {
      if (std::count(reductions->begin(), reductions->end(), 0.0) > 0) {
        throw TransmissionInterfaceException("Transmission reduction ratios cannot be zero.");
      }
    }
  }

  struct Pair {
    double first;
    double second;
  };

  static Pair get(const std::vector<double*>& values) {
    assert(values.size() == 2 && values[0] != nullptr && values[1] != nullptr);
    return {*values[0], *values[1]};
  }
  static void set(std::vector<double*>& values, const Pair& pair) {
    assert(values.size() == 2 && values[0] != nullptr && values[1] != nullptr);
    *values[0] = pair.first;
    *values[1] = pair.second;
  }

  Pair withOffset(const Pair& joints) const {
    return {joints.first + jnt_offset_[0], joints.second + jnt_offset_[1]};
  }
  Pair withoutOffset(const Pair& joints) const {
    return {joints.first - jnt_offset_[0], joints.second - jnt_offset_[1]};
  }

  std::vector<double> act_reduction_;
  std::vector<double> jnt_reduction_;
  std::vector<double> jnt_offset_;
};

}  // namespace internal
}  // namespace transmission_interface
