// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/control_types.h>

#include <algorithm>
#include <stdexcept>
#include <string>

namespace franka {

namespace {

template <std::size_t kSize>
std::array<double, kSize> toArray(std::initializer_list<double> values, const char* type) {
  if (values.size() != kSize) {
    throw std::invalid_argument(std::string("libfranka: ") + type + " needs " +
                                std::to_string(kSize) + " values, but " +
                                std::to_string(values.size()) + " were given.");
  }
  std::array<double, kSize> result{};
  std::copy(values.begin(), values.end(), result.begin());
  return result;
}

bool isCommanded(const std::array<double, 2>& elbow) noexcept {
  return elbow[0] != 0.0 || elbow[1] != 0.0;
}

}  // namespace

Torques::Torques(const std::array<double, 7>& torques) noexcept : tau_J(torques) {}

Torques::Torques(std::initializer_list<double> torques)
    : tau_J(toArray<7>(torques, "franka::Torques")) {}

JointPositions::JointPositions(const std::array<double, 7>& joint_positions) noexcept
    : q(joint_positions) {}

JointPositions::JointPositions(std::initializer_list<double> joint_positions)
    : q(toArray<7>(joint_positions, "franka::JointPositions")) {}

JointVelocities::JointVelocities(const std::array<double, 7>& joint_velocities) noexcept
    : dq(joint_velocities) {}

JointVelocities::JointVelocities(std::initializer_list<double> joint_velocities)
    : dq(toArray<7>(joint_velocities, "franka::JointVelocities")) {}

CartesianPose::CartesianPose(const std::array<double, 16>& cartesian_pose) noexcept
    : O_T_EE(cartesian_pose) {}

CartesianPose::CartesianPose(const std::array<double, 16>& cartesian_pose,
                             const std::array<double, 2>& elbow) noexcept
    : O_T_EE(cartesian_pose), elbow(elbow) {}

CartesianPose::CartesianPose(std::initializer_list<double> cartesian_pose)
    : O_T_EE(toArray<16>(cartesian_pose, "franka::CartesianPose")) {}

CartesianPose::CartesianPose(std::initializer_list<double> cartesian_pose,
                             std::initializer_list<double> elbow)
    : O_T_EE(toArray<16>(cartesian_pose, "franka::CartesianPose")),
      elbow(toArray<2>(elbow, "The elbow of franka::CartesianPose")) {}

bool CartesianPose::hasElbow() const noexcept { return isCommanded(elbow); }

CartesianVelocities::CartesianVelocities(const std::array<double, 6>& cartesian_velocities) noexcept
    : O_dP_EE(cartesian_velocities) {}

CartesianVelocities::CartesianVelocities(const std::array<double, 6>& cartesian_velocities,
                                         const std::array<double, 2>& elbow) noexcept
    : O_dP_EE(cartesian_velocities), elbow(elbow) {}

CartesianVelocities::CartesianVelocities(std::initializer_list<double> cartesian_velocities)
    : O_dP_EE(toArray<6>(cartesian_velocities, "franka::CartesianVelocities")) {}

CartesianVelocities::CartesianVelocities(std::initializer_list<double> cartesian_velocities,
                                         std::initializer_list<double> elbow)
    : O_dP_EE(toArray<6>(cartesian_velocities, "franka::CartesianVelocities")),
      elbow(toArray<2>(elbow, "The elbow of franka::CartesianVelocities")) {}

bool CartesianVelocities::hasElbow() const noexcept { return isCommanded(elbow); }

}  // namespace franka
