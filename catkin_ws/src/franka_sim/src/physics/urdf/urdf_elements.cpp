// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/urdf/urdf_elements.h"

#include <franka_core/rotations.h>

#include <stdexcept>

#include "physics/mjcf/xml_util.h"

namespace franka_sim::physics {

using tinyxml2::XMLElement;

void failAt(const std::string& where, const std::string& what) {
  throw std::runtime_error(where + ": " + what);
}

Eigen::Vector3d readVector(const XMLElement& element, const char* attribute,
                           const std::array<double, 3>& fallback, const std::string& where) {
  const auto values = numbers(element, attribute, {fallback[0], fallback[1], fallback[2]}, where);
  return {values[0], values[1], values[2]};
}

Eigen::Isometry3d readOrigin(const XMLElement& parent, const std::string& where) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const XMLElement* origin = parent.FirstChildElement("origin");
  if (origin == nullptr) {
    return pose;
  }
  pose.translation() = readVector(*origin, "xyz", {0, 0, 0}, where);
  const Eigen::Vector3d rpy = readVector(*origin, "rpy", {0, 0, 0}, where);
  if (rpy != Eigen::Vector3d::Zero()) {
    pose.linear() = franka_core::rotationFromRpy(rpy);
  }
  return pose;
}

}  // namespace franka_sim::physics
