// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_core/numbers.h>
#include <franka_sim/physics/physics_config.h>
#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_gravity.h>
#include <gtest/gtest.h>
#include <source_file.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "../support/arrays.h"

namespace franka_sim::test {

constexpr std::array<double, 7> kHome{0, -0.785, 0, -2.356, 0, 1.571, 0.785};
constexpr double kRotorInertia = 0.1;

/// `panda` or `fr3`, with hand, root `<arm_id>_link0`.
inline std::string urdfOf(const std::string& arm_id) {
  return franka_test::readSource("franka_sim/robots/" + arm_id + ".urdf");
}

inline std::string world(const std::string& name) {
  return franka_test::sourceFile("franka_sim/worlds/" + name + ".xml");
}

inline Pose at(double x, double y, double z) {
  Pose pose;
  pose.position = {x, y, z};
  return pose;
}

inline void run(World& world, int ticks) {
  for (int i = 0; i < ticks; ++i) {
    world.step();
  }
}

inline Eigen::Isometry3d toEigen(const Pose& pose) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  const auto& q = pose.orientation;
  result.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  result.translation() = Eigen::Vector3d(pose.position.data());
  return result;
}

inline std::string replaceAll(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// A robot in its home pose, named `arm_id`, with the numbers of `kind`.
inline RobotDescription robot(const std::string& kind, const std::string& arm_id) {
  RobotDescription description;
  description.name = arm_id;
  description.urdf = replaceAll(urdfOf(kind), kind + "_", arm_id + "_");
  setInitialPositions(kHome, arm_id, description);
  for (int i = 0; i < 7; ++i) {
    const std::string joint = arm_id + "_joint" + std::to_string(i + 1);
    description.rotor_inertia[joint] = kRotorInertia;
    description.stops[joint] = {-4.7, 4.7};
  }
  return description;
}

inline RobotDescription robot(const std::string& kind) { return robot(kind, kind); }

/// Two Pandas `left` and `right` in one description. @param of_right <origin> of the right one's
/// base
inline RobotDescription twoArms(const std::string& of_right = "") {
  RobotDescription both = robot("panda", "left");
  both.name = "both";
  both.urdf = "<robot name='both'><link name='world'/>";
  for (const std::string side : {"left", "right"}) {
    const RobotDescription arm = robot("panda", side);
    const std::size_t begin = arm.urdf.find("<robot name=\"panda\">") + 20;
    both.urdf += arm.urdf.substr(begin, arm.urdf.rfind("</robot>") - begin) + "<joint name='" +
                 side + "_mount' type='fixed'>" + (side == "left" ? "" : of_right) +
                 "<parent link='world'/><child link='" + side + "_link0'/></joint>";
    both.initial_positions.insert(arm.initial_positions.begin(), arm.initial_positions.end());
  }
  both.urdf += "</robot>";
  return both;
}

/// The hand with closed fingers as payload at the flange.
inline franka_core::Payload handPayload(const std::string& kind = "panda") {
  return franka_core::endEffectorFromUrdf(urdfOf(kind), kind);
}

/// Holds or moves the arm by gravity compensation and joint springs.
class ArmHolder {
 public:
  explicit ArmHolder(ArmPlant* arm, const std::string& kind = "panda")
      : arm_(arm),
        model_(franka_core::ArmModel::fromUrdf(urdfOf(kind), kind)),
        payload_(handPayload(kind)) {}

  std::array<double, 7> torques(const std::array<double, 7>& q_d,
                                const std::array<double, 7>& dq_d = {}) const noexcept {
    constexpr std::array<double, 7> kStiffness{1500, 1500, 1500, 1500, 600, 600, 600};
    const ArmMeasurement m = arm_->measure();
    std::array<double, 7> tau = model_.gravity(m.q, payload_);
    const auto coriolis = model_.coriolis(m.q, m.dq, payload_);
    for (int i = 0; i < 7; ++i) {
      const double damping = 1.2 * std::sqrt(kStiffness[i]);
      tau[i] += coriolis[i] + kStiffness[i] * (q_d[i] - m.q[i]) + damping * (dq_d[i] - m.dq[i]);
    }
    return tau;
  }
  void hold(const std::array<double, 7>& q_d, const std::array<double, 7>& dq_d = {}) noexcept {
    arm_->applyTorques(torques(q_d, dq_d));
  }
  const franka_core::ArmModel& model() const noexcept { return model_; }
  const franka_core::Payload& payload() const noexcept { return payload_; }

 private:
  ArmPlant* arm_;
  franka_core::ArmModel model_;
  franka_core::Payload payload_;
};

/// Expects a std::runtime_error whose sentence contains all parts.
template <typename Function>
void expectSentence(Function function, std::initializer_list<const char*> parts) {
  try {
    function();
    ADD_FAILURE() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    const std::string text = error.what();
    for (const char* part : parts) {
      EXPECT_NE(std::string::npos, text.find(part)) << "'" << part << "' is not in: " << text;
    }
  }
}

}  // namespace franka_sim::test
