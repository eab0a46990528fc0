// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

/// @file
/// Kinematics of a mobile base with two drive modules, from its description (URDF). An arm's
/// description is refused; no robot that this library supports sends one of a mobile base.

namespace franka {

/// The drive modules of a mobile base. The vendor's names of the two are not known.
enum class MobileFrame : std::uint8_t {
  kDriveModule1,  ///< where the joint `..._joint_1` moves
  kDriveModule2   ///< where the joint `..._joint_3` moves
};

/// Positions [rad] of the joints whose names end with _joint_0 to _joint_3.
struct MobileJointPositions {
  double joint_0{0.0};  ///< [rad]
  double joint_1{0.0};  ///< [rad]
  double joint_2{0.0};  ///< [rad]
  double joint_3{0.0};  ///< [rad]
};

/// Whether a description (URDF) is of a mobile base: its robot's name begins with "tmr".
/// Not real-time safe. Thread-safe.
bool isMobileRobotUrdf(const std::string& urdf);

/// Poses of a mobile base's drive modules. Thread-safe.
class MobileModel {
 public:
  /// @param urdf the description from Robot::getRobotModel. Not real-time safe.
  /// @throws ModelException if it is not that of a mobile base, or lacks a joint.
  explicit MobileModel(const std::string& urdf);
  MobileModel(MobileModel&& other) noexcept;
  MobileModel& operator=(MobileModel&& other) noexcept;
  ~MobileModel() noexcept;

  /// Pose of a drive module in the description's root frame, 4x4 column-major. Further movable
  /// joints of the description count as 0. Real-time safe.
  /// @throws std::invalid_argument for an invalid frame.
  std::array<double, 16> pose(MobileFrame frame, const MobileJointPositions& q) const;

  MobileModel(const MobileModel&) = delete;
  MobileModel& operator=(const MobileModel&) = delete;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace franka
