// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/mjcf_inertial.h"

#include <Eigen/Eigenvalues>

#include "physics/xml_util.h"

namespace franka_sim::physics {

void writeInertial(const UrdfInertial& inertial, tinyxml2::XMLElement* body) {
  if (inertial.mass == 0) {
    return;
  }
  // Principal axes are computed here: MuJoCo's diagonalisation is accurate to 1e-8 only.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(inertial.inertia);
  Eigen::Matrix3d axes = solver.eigenvectors();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  tinyxml2::XMLElement* element = append(body, "inertial");
  element->SetAttribute("pos", toText(inertial.com).c_str());
  element->SetAttribute("quat", toText(Eigen::Quaterniond(axes).normalized()).c_str());
  element->SetAttribute("mass", toText({inertial.mass}).c_str());
  element->SetAttribute("diaginertia", toText(Eigen::Vector3d(solver.eigenvalues())).c_str());
}

}  // namespace franka_sim::physics
