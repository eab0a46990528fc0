// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world_bodies.h>
#include <franka_sim/physics/world_contacts.h>

#include <array>
#include <memory>
#include <string>

#include "test_support.h"

namespace franka_sim::test {

/// An arm whose fingers are as far apart as the stone is wide, and the stone on its table. The
/// parameter is the robot.
class StoneInHandTest : public ::testing::TestWithParam<const char*> {
 protected:
  StoneInHandTest() : world_(test::world("stone")) {
    RobotDescription description = robot(id());
    description.base.position = {-0.5, 0, 0.3};
    description.initial_positions[id() + "_finger_joint1"] = 0.0165;
    world_.addRobot(description);
    arm_ = &world_.arm(id(), id());
    hand_ = &world_.hand(id(), id());
    holder_ = std::make_unique<ArmHolder>(arm_, id());
  }

  std::string id() const { return GetParam(); }

  /// Puts the stone between the open fingers, its 32 mm along their direction of motion.
  void placeStone() { setBodyPose(world_, "stone", bodyPose(world_, id() + "_hand_tcp")); }

  /// One tick. @param force with which each finger closes [N] @param q_d, dq_d that the arm holds
  void tick(double force = 0.0, const std::array<double, 7>& q_d = kHome,
            const std::array<double, 7>& dq_d = {}) {
    const int before = world_.substeps();
    holder_->hold(q_d, dq_d);
    hand_->applyForces({-force, -force});
    world_.step();
    refinements_ += world_.substeps() > before ? 1 : 0;
  }

  /// The same for some ticks in the home pose.
  void run(int ticks, double force = 0.0) {
    for (int k = 0; k < ticks; ++k) {
      tick(force);
    }
  }

  Eigen::Vector3d stoneInHand() {
    return (toEigen(bodyPose(world_, id() + "_hand")).inverse() *
            toEigen(bodyPose(world_, "stone")))
        .translation();
  }

  /// Sum of the contact forces on a body, of those of one other body if it is named [N].
  Eigen::Vector3d forceOn(const std::string& body, const std::string& other = "") {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Contact& c : contacts(world_)) {
      if (c.body2 == body && (other.empty() || c.body1 == other)) {
        sum += Eigen::Vector3d(c.force.data());
      } else if (c.body1 == body && (other.empty() || c.body2 == other)) {
        sum -= Eigen::Vector3d(c.force.data());
      }
    }
    return sum;
  }

  int refinements_{0};  ///< ticks from which on the steps are smaller
  World world_;
  ArmPlant* arm_;
  HandPlant* hand_;
  std::unique_ptr<ArmHolder> holder_;
};

}  // namespace franka_sim::test
