// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// The part of the public interface that the stub's user needs, with recognizable results.
#include <franka/exception.h>
#include <franka/robot.h>

namespace franka {

class Robot::Impl {};

Robot::Robot(const std::string& /*address*/, RealtimeConfig /*config*/, size_t /*log_size*/) {
  throw NetworkException("this is the other libfranka");
}
Robot::~Robot() noexcept = default;

Torques::Torques(const std::array<double, 7>& torques) noexcept : tau_J(torques) {}
JointPositions::JointPositions(const std::array<double, 7>& positions) noexcept : q(positions) {}
JointVelocities::JointVelocities(const std::array<double, 7>& velocities) noexcept
    : dq(velocities) {}
CartesianPose::CartesianPose(const std::array<double, 16>& pose) noexcept : O_T_EE(pose) {}
CartesianVelocities::CartesianVelocities(const std::array<double, 6>& velocities) noexcept
    : O_dP_EE(velocities) {}

}  // namespace franka
