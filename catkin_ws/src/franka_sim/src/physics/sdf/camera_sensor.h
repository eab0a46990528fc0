// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tinyxml2.h>

#include <Eigen/Geometry>
#include <set>
#include <string>
#include <vector>

namespace franka_sim::physics {

/// A camera of an SDF text, or of a <gazebo> element in a URDF.
struct CameraSensor {
  std::string name;
  Eigen::Isometry3d pose{Eigen::Isometry3d::Identity()};  ///< in the link; looks along x, z is up
  double horizontal_view{1.047};                          ///< [rad]
  int width{640}, height{480};                            ///< [pixel]
  double rate{30};                                        ///< [Hz]
};

/// Reads the cameras of a <sensor>: usually one, several of a multicamera; none of other sensors.
/// @param pose of the sensor in its link
/// @param name of the sensor in the world
/// @param notes gets what of the sensor is not simulated: its type, its plugins
/// @throws std::runtime_error for values that no camera has
std::vector<CameraSensor> readCameras(const tinyxml2::XMLElement& sensor,
                                      const Eigen::Isometry3d& pose, const std::string& name,
                                      std::set<std::string>* notes);

/// Writes a camera into an MJCF body (or the worldbody). @param link_pose of its link in the body
void writeCamera(const CameraSensor& camera, const Eigen::Isometry3d& link_pose,
                 tinyxml2::XMLElement* body);

}  // namespace franka_sim::physics
