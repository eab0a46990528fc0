// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/limits.h>
#include <franka_core/numbers.h>
#include <franka_hw/resource_helpers.h>
#include <franka_hw/robot_mismatch.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>

namespace franka_hw {

namespace {

using franka_core::ArmLimits;

// How far a description may exceed the robot's range. Chosen here: accepts ranges that were rounded
// to degrees; the two robots differ by 0.46 rad at joint 6. [rad]
constexpr double kTolerance = 0.1;

// Distances of frames that count as rounding of their numbers (chosen here). [m], [rad]
constexpr double kFrameTolerance = 1e-4, kAngleTolerance = 1e-3;

/// The widest range of this kind of robot; older FR3s have narrower ones.
const ArmLimits& limitsOf(bool is_fr3) {
  return is_fr3 ? franka_core::kFr3Limits : franka_core::kFerLimits;
}

/// The first joint (0 to 6) that can move further in the description than in this kind of robot.
std::optional<std::size_t> tooWide(const urdf::Model& description,
                                   const std::array<std::string, 7>& joint_names,
                                   const ArmLimits& limits) {
  for (std::size_t i = 0; i < joint_names.size(); i++) {
    const urdf::JointConstSharedPtr joint = description.getJoint(joint_names[i]);
    if (joint && joint->limits &&
        (joint->limits->lower < limits.q_min[i] - kTolerance ||
         joint->limits->upper > limits.q_max[i] + kTolerance)) {
      return i;
    }
  }
  return std::nullopt;
}

/// The arms whose first joints are in the description, as "'panda', 'left'".
std::string armsIn(const urdf::Model& description) {
  const std::string ending = "_joint1";
  std::set<std::string> arms;
  for (const auto& [name, joint] : description.joints_) {
    if (name.size() > ending.size() &&
        name.compare(name.size() - ending.size(), ending.size(), ending) == 0 &&
        name.find("_finger") == std::string::npos) {
      arms.insert("'" + name.substr(0, name.size() - ending.size()) + "'");
    }
  }
  std::string list;
  for (const std::string& arm : arms) {
    list += (list.empty() ? "" : ", ") + arm;
  }
  return list.empty() ? "no arm" : list;
}

double distanceOf(const std::array<double, 16>& a, const std::array<double, 16>& b) {
  return std::hypot(a[12] - b[12], a[13] - b[13], a[14] - b[14]);
}

double angleBetween(const std::array<double, 16>& a, const std::array<double, 16>& b) {
  std::array<std::array<double, 3>, 3> turn{};  // from a to b
  for (std::size_t i = 0; i < 9; i++) {
    const std::size_t row = i / 3, column = i % 3;
    for (std::size_t k = 0; k < 3; k++) {
      turn[row][column] += a[4 * row + k] * b[4 * column + k];
    }
  }
  const double sine =
      0.5 * std::hypot(turn[2][1] - turn[1][2], turn[0][2] - turn[2][0], turn[1][0] - turn[0][1]);
  // Not by the cosine alone: numbers with four digits would give 4 mrad.
  return std::atan2(sine, 0.5 * (turn[0][0] + turn[1][1] + turn[2][2] - 1.0));
}

std::string wrongNames(const urdf::Model& description, const std::string& arm_id,
                       const std::array<std::string, 7>& joint_names) {
  for (const std::string& name : joint_names) {
    std::string arm;
    if (!findArmIdInResourceId(name, &arm) || arm != arm_id) {
      return "arm_id is '" + arm_id + "', but joint_names holds '" + name +
             "': joints of this arm are named " + arm_id + "_joint1 to " + arm_id + "_joint7.";
    }
    if (!description.getJoint(name)) {
      return "the arm is called '" + arm_id + "' (arm_id), but robot_description holds no joint '" +
             name + "': it describes " + armsIn(description) + ". Give both the same arm_id.";
    }
  }
  return "";
}

}  // namespace

std::string robotMismatch(const urdf::Model& description, const std::string& arm_id,
                          const std::array<std::string, 7>& joint_names, unsigned protocol) {
  const std::string names = wrongNames(description, arm_id, joint_names);
  if (!names.empty()) {
    return names;
  }
  const bool is_fr3 = protocol > 5;
  const ArmLimits& limits = limitsOf(is_fr3);
  const std::optional<std::size_t> joint = tooWide(description, joint_names, limits);
  if (!joint) {
    return "";
  }
  const bool describes_other = !tooWide(description, joint_names, limitsOf(!is_fr3));
  const auto& range = *description.getJoint(joint_names[*joint])->limits;
  const auto from_to = [](double lower, double upper) {
    return "from " + franka_core::numberText(lower) + " to " + franka_core::numberText(upper) +
           " rad";
  };
  const std::string described =
      !describes_other ? "another robot's" : (is_fr3 ? "a Panda's" : "an FR3's");
  return std::string("the robot is ") + (is_fr3 ? "an FR3" : "a Panda") + " (protocol " +
         std::to_string(protocol) + "), but robot_description is " + described + ": it lets '" +
         joint_names[*joint] + "' move " + from_to(range.lower, range.upper) + ", the robot can " +
         from_to(limits.q_min[*joint], limits.q_max[*joint]) +
         ". Load the description of this robot (launch files: robot:=" +
         (is_fr3 ? "fr3" : "panda") + ").";
}

std::string endEffectorMismatch(const std::optional<std::array<double, 16>>& described,
                                const std::array<double, 16>& F_T_NE, const std::string& arm_id) {
  if (!described) {
    return "";
  }
  const double distance = distanceOf(*described, F_T_NE);
  const double angle = angleBetween(*described, F_T_NE);
  if (distance <= kFrameTolerance && angle <= kAngleTolerance) {
    return "";
  }
  std::string numbers;
  for (const double value : *described) {
    numbers += (numbers.empty() ? "" : " ") + franka_core::numberText(value, 4);
  }
  return "its F_T_NE puts the end effector " +
         franka_core::numberText(std::round(1e4 * distance) / 10.0, 3) + " mm and " +
         franka_core::numberText(std::round(1e4 * angle) / 1e4, 3) + " rad away from '" + arm_id +
         "_hand_tcp' of the robot's description, so O_T_EE and TF differ. F_T_NE of the "
         "description is " +
         numbers + " (column-major).";
}

}  // namespace franka_hw
