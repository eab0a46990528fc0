// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/whole_robot.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace franka_sim::test {

/// The parts of what can be seen of a robot from outside.
enum class Part : std::size_t {
  kState,
  kStatus,
  kLoad,
  kEndEffector,
  kNominalFrame,
  kEndEffectorFrame,
  kStiffnessFrame,
  kThresholds,
  kCartesianStiffness,
  kProtocolVersion,
  kOtherParameters,
  kVirtualWalls,
  kSafety,
  kOperatorMotion,
  kHand,
};
constexpr std::array<const char*, 15> kPartNames{
    "state",      "status",        "load",         "end effector",        "F_T_NE",
    "NE_T_EE",    "EE_T_K",        "thresholds",   "Cartesian stiffness", "protocol version",
    "parameters", "virtual walls", "safety state", "operator motion",     "hand"};

/// A hash of each part, of all its bits.
class Observation {
 public:
  explicit Observation(const WholeRobot& robot);

  bool isEqual(const Observation& other, Part part) const {
    return hashes_[static_cast<std::size_t>(part)] == other.hashes_[static_cast<std::size_t>(part)];
  }
  /// The names of the parts that differ, or nothing.
  std::string differences(const Observation& other) const;

 private:
  std::array<std::uint64_t, kPartNames.size()> hashes_;
};

}  // namespace franka_sim::test
