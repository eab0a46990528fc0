// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <utility>

namespace franka_example_controllers {

/// Keeps a joint away from the ends of its range by a torque, like a padded wall.
///
/// Before each soft limit are two zones: the inner one with spring and damper, the outer one with a
/// damper only. A joint that is in a zone at the start is not pushed out: the zones shrink to its
/// position and grow back as it leaves. Called by one thread. Real-time safe. Exceptions: the
/// constructor, and computeTorque() when it throws.
class JointWall {
 public:
  /// @param soft_upper_joint_position_limit,soft_lower_joint_position_limit [rad]
  /// @param PD_zone_width,D_zone_width [rad] @param PD_zone_stiffness [Nm/rad]
  /// @param PD_zone_damping,D_zone_damping [Nm s/rad]
  /// Negative widths, stiffness and damping are taken as positive, with a warning.
  JointWall(double soft_upper_joint_position_limit, double soft_lower_joint_position_limit,
            double PD_zone_width, double D_zone_width, double PD_zone_stiffness,
            double PD_zone_damping, double D_zone_damping);
  JointWall() = delete;

  /// Torque against the wall [Nm]. @param q [rad] @param dq [rad/s]
  /// @throws std::runtime_error if the first q after a reset is outside the soft limits
  double computeTorque(double q, double dq);

  /// Resets the zones.
  void reset();

 private:
  /// Depth of q in the zones of the nearer limit: 0 outside, 1 at the limit.
  double depth(double q) const noexcept;
  void begin(double q);

  double upper_, lower_;
  double pd_width_, d_width_;
  double stiffness_, pd_damping_, d_damping_;
  bool begun_{false};
  double scale_{1.0};  // of the zones' widths
};

/// One wall per joint.
template <std::size_t num_dof>
class JointWallContainer {
 public:
  /// Like JointWall, for each joint.
  JointWallContainer(const std::array<double, num_dof>& soft_upper_joint_position_limits,
                     const std::array<double, num_dof>& soft_lower_joint_position_limits,
                     const std::array<double, num_dof>& PD_zone_widths,
                     const std::array<double, num_dof>& D_zone_widths,
                     const std::array<double, num_dof>& PD_zone_stiffnesses,
                     const std::array<double, num_dof>& PD_zone_dampings,
                     const std::array<double, num_dof>& D_zone_dampings) {
    for (std::size_t i = 0; i < num_dof; i++) {
      walls_[i] = std::make_unique<JointWall>(
          soft_upper_joint_position_limits[i], soft_lower_joint_position_limits[i],
          PD_zone_widths[i], D_zone_widths[i], PD_zone_stiffnesses[i], PD_zone_dampings[i],
          D_zone_dampings[i]);
    }
  }

  /// Torques of all joints [Nm]. @throws as JointWall::computeTorque
  std::array<double, num_dof> computeTorque(const std::array<double, num_dof>& q,
                                            const std::array<double, num_dof>& dq) {
    std::array<double, num_dof> torque;
    for (std::size_t i = 0; i < num_dof; i++) {
      torque[i] = walls_[i]->computeTorque(q[i], dq[i]);
    }
    return torque;
  }

  /// Starts again, as before the first cycle.
  void reset() {
    for (auto& wall : walls_) {
      wall->reset();
    }
  }

 private:
  std::array<std::unique_ptr<JointWall>, num_dof> walls_;
};

}  // namespace franka_example_controllers
