// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_example_controllers/command_claims.h>
#include <franka_example_controllers/gentle_stop.h>
#include <franka_hw/resource_helpers.h>
#include <gtest/gtest.h>
#include <source_file.h>

#include <cmath>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace franka_example_controllers {
namespace {

using Names = std::vector<std::string>;

const Names kNames{"joint_position", "joint_velocity", "cartesian_pose", "cartesian_velocity",
                   "effort"};

Names subset(unsigned bits) {
  Names names;
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if ((bits >> i & 1U) != 0) {
      names.push_back(kNames[i]);
    }
  }
  return names;
}

/// Whether the robot allows a controller with these claims: franka_hw's checks of a switch.
bool robotAllows(const Names& names) {
  const char* const interfaces[] = {
      "hardware_interface::PositionJointInterface", "hardware_interface::VelocityJointInterface",
      "franka_hw::FrankaPoseCartesianInterface", "franka_hw::FrankaVelocityCartesianInterface",
      "hardware_interface::EffortJointInterface"};
  hardware_interface::ControllerInfo info;
  info.name = "mine";
  for (const std::string& name : names) {
    const std::size_t index = std::find(kNames.begin(), kNames.end(), name) - kNames.begin();
    hardware_interface::InterfaceResources claim;
    claim.hardware_interface = interfaces[index];
    for (int joint = 1; joint <= 7; ++joint) {
      claim.resources.insert(name[0] == 'c' ? "panda_robot"
                                            : "panda_joint" + std::to_string(joint));
    }
    info.claimed_resources.push_back(claim);
  }
  franka_hw::ResourceWithClaimsMap resources = franka_hw::getResourceMap({info});
  franka_hw::ArmClaimedMap arms;
  return !franka_hw::hasConflictingMultiClaim(resources) &&
         franka_hw::getArmClaimedMap(resources, arms) &&
         !franka_hw::hasConflictingJointAndCartesianClaim(arms, "panda") &&
         !franka_hw::partiallyClaimsArmJoints(arms, "panda") &&
         franka_hw::getControlMode("panda", arms) != franka_hw::ControlMode::None;
}

/// The allowed rows of the documentation's table, as bits.
std::set<unsigned> documented() {
  std::istringstream page(franka_test::readSource("../../docs/write_your_own.md"));
  std::set<unsigned> rows;
  for (std::string line; std::getline(page, line);) {
    if (line.rfind('|', 0) != 0 || line.find("| allowed |") == std::string::npos) {
      continue;
    }
    std::istringstream cells(line.substr(1));
    unsigned bits = 0;
    std::string cell;
    for (std::size_t i = 0; i < kNames.size() && std::getline(cells, cell, '|'); ++i) {
      bits |= cell.find('x') != std::string::npos ? 1U << i : 0U;
    }
    rows.insert(bits);
  }
  return rows;
}

TEST(CommandClaims, MatchTheRobotAndTheDocumentation) {
  const std::set<unsigned> rows = documented();
  EXPECT_EQ(9U, rows.size());
  for (unsigned bits = 1; bits < 32; ++bits) {
    const CommandClaims claims = checkCommandClaims(subset(bits));
    EXPECT_EQ(robotAllows(subset(bits)), claims.refusal.empty()) << bits;
    EXPECT_EQ(claims.refusal.empty(), claims.mode != franka_hw::ControlMode::None) << bits;
    EXPECT_EQ(claims.refusal.empty(), rows.count(bits) == 1) << bits;
  }
}

TEST(CommandClaims, ReportErrorsWithTheirCause) {
  EXPECT_NE(std::string::npos, checkCommandClaims({}).refusal.find("No command interface"));
  EXPECT_NE(std::string::npos, checkCommandClaims({"tau"}).refusal.find("'tau'"));
  EXPECT_NE(std::string::npos,
            checkCommandClaims({"effort", "effort"}).refusal.find("named twice"));
}

TEST(GentleStop, StartsAtTheGivenMotionAndEndsAtRest) {
  for (const double velocity : {-2.0, 0.0, 0.5}) {
    for (const double acceleration : {-3.0, 0.0, 7.0}) {
      const GentleStop<1> stop({{velocity}}, {{acceleration}}, 5.0);
      const auto at = [&](double time) { return stop.velocity(time)[0]; };
      const double end = stop.duration();
      constexpr double kStep = 1e-6;
      EXPECT_EQ(velocity, at(0.0));
      EXPECT_NEAR(acceleration, (at(kStep) - at(0.0)) / kStep, 1e-2);
      EXPECT_NEAR(0.0, at(end), 1e-12);
      EXPECT_NEAR(0.0, at(end - kStep) / kStep, 1e-3);
      EXPECT_EQ(0.0, at(end + 1.0));
      if (acceleration == 0.0) {
        double steepest = 0.0;
        for (double time = 0.0; time < end; time += end / 1000.0) {
          steepest = std::max(steepest, std::abs(at(time + kStep) - at(time)) / kStep);
        }
        EXPECT_LE(steepest, 5.0 * (1.0 + 1e-4));
      }
    }
  }
}

}  // namespace
}  // namespace franka_example_controllers
