// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The nine control modes: which claims are accepted, and which commands then reach the robot.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <set>

#include "support.h"

namespace franka_hw_test {
namespace {

using franka_core::ControllerMode;
using franka_core::MotionGeneratorMode;

const std::vector<std::string> kKinds{"JT", "JP", "JV", "CP", "CV"};
const std::set<std::string> kModes{"JT",    "JP",    "JV",    "CP",   "CV",
                                   "JT+JP", "JT+JV", "JT+CP", "JT+CV"};

/// All non-empty sets of kinds, as "JT+JP".
std::vector<std::string> subsets() {
  std::vector<std::string> all;
  for (unsigned bits = 1; bits < 1u << kKinds.size(); bits++) {
    std::string set;
    for (size_t i = 0; i < kKinds.size(); i++) {
      if ((bits >> i & 1u) != 0) {
        set += (set.empty() ? "" : "+") + kKinds[i];
      }
    }
    all.push_back(set);
  }
  return all;
}

class Modes : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(robot_.init(arm_.nh, arm_.robot_nh));
    loop_.emplace(robot_, arm_);
  }

  /// Runs a controller until the robot has received `count` of its commands, and stops it.
  std::vector<franka_test::FakeRobot::Exchange> run(const std::string& claims, size_t count = 20) {
    TestController& controller = loop_->controller(claims);
    EXPECT_TRUE(loop_->switchTo({claims}, {})) << claims;
    EXPECT_TRUE(eventually([&] {
      return controller.updates_since_start > 3 && arm_.robot.exchanges().size() >= count;
    })) << claims;
    auto exchanges = arm_.robot.exchanges();
    EXPECT_TRUE(loop_->switchTo({}, {claims})) << claims;
    for (const std::string& error : loop_->errors()) {
      ADD_FAILURE() << claims << ": " << error;
    }
    return exchanges;
  }

  franka_core::fci::MoveRequest lastMove() const {
    franka_core::fci::MoveRequest move;
    for (const auto& request : arm_.robot.requests()) {
      if (const auto* of = std::get_if<franka_core::fci::MoveRequest>(&request)) {
        move = *of;
      }
    }
    return move;
  }

  FakeArm arm_{"fr3"};
  franka_hw::FrankaHW robot_;
  std::optional<Loop> loop_;
};

TEST_F(Modes, NineOfAllSetsOfClaimsAreAcceptedAndTheOthersRefused) {
  for (const std::string& claims : subsets()) {
    const bool legal = kModes.count(claims) != 0;
    EXPECT_EQ(legal, loop_->switchTo({claims}, {})) << claims;
    EXPECT_EQ(legal, loop_->controller(claims).isRunning()) << claims;
    EXPECT_EQ(legal, robot_.controllerActive()) << claims;
    if (legal) {
      EXPECT_TRUE(loop_->switchTo({}, {claims})) << claims;
    }
    EXPECT_FALSE(robot_.controllerActive()) << claims;
  }
  EXPECT_TRUE(loop_->errors().empty());
}

TEST_F(Modes, RequestTheirMotionAndSendTheCommandsOfTheController) {
  const MotionGeneratorMode none = MotionGeneratorMode::kNone;
  const ControllerMode torque = ControllerMode::kExternalController;
  const ControllerMode inner = ControllerMode::kJointImpedance;
  const std::map<std::string, std::pair<MotionGeneratorMode, ControllerMode>> requests{
      {"JT", {none, torque}},
      {"JP", {MotionGeneratorMode::kJointPosition, inner}},
      {"JV", {MotionGeneratorMode::kJointVelocity, inner}},
      {"CP", {MotionGeneratorMode::kCartesianPosition, inner}},
      {"CV", {MotionGeneratorMode::kCartesianVelocity, inner}},
      {"JT+JP", {MotionGeneratorMode::kJointPosition, torque}},
      {"JT+JV", {MotionGeneratorMode::kJointVelocity, torque}},
      {"JT+CP", {MotionGeneratorMode::kCartesianPosition, torque}},
      {"JT+CV", {MotionGeneratorMode::kCartesianVelocity, torque}},
  };
  for (const std::string& claims : kModes) {
    TestController& controller = loop_->controller(claims);
    controller.torque = 1.5;
    controller.speed = 0.001;  // slow enough to end a motion without an interruption
    const auto exchanges = run(claims);
    EXPECT_EQ(requests.at(claims).first, lastMove().motion_generator_mode) << claims;
    EXPECT_EQ(requests.at(claims).second, lastMove().controller_mode) << claims;
    ASSERT_FALSE(exchanges.empty()) << claims;
    const auto& [state, command] = exchanges.back();
    if (claims.find("JT") != std::string::npos) {
      EXPECT_EQ(1.5, command.tau_J_d[0]) << claims;
      EXPECT_EQ(1.5, command.tau_J_d[6]) << claims;
    }
    if (claims.find("JP") != std::string::npos) {
      EXPECT_NEAR(state.q_d[3] + 1e-6, command.q_c[3], 1e-12) << claims;
    }
    if (claims.find("JV") != std::string::npos) {
      EXPECT_EQ(0.001, command.dq_c[6]) << claims;
    }
    if (claims.find("CP") != std::string::npos) {
      EXPECT_NEAR(state.O_T_EE_c[14] + 1e-6, command.O_T_EE_c[14], 1e-12) << claims;
      EXPECT_FALSE(command.valid_elbow) << claims;
    }
    if (claims.find("CV") != std::string::npos) {
      EXPECT_EQ(0.001, command.O_dP_EE_c[2]) << claims;
    }
  }
}

TEST_F(Modes, ControllersRunOnceAMillisecondAlsoBesideAGenerator) {
  for (const std::string claims : {"JT", "JT+JP"}) {
    TestController& controller = loop_->controller(claims);
    ASSERT_TRUE(loop_->switchTo({claims}, {}));
    ASSERT_TRUE(eventually([&] { return controller.updates_since_start > 200; }));
    const int before = controller.updates_since_start;
    const int exchanges = static_cast<int>(arm_.robot.exchanges().size());
    const int after = controller.updates_since_start;
    EXPECT_GE(exchanges, before - 60) << claims;  // and not half as many
    EXPECT_LE(exchanges, after + 60) << claims;
    ASSERT_TRUE(loop_->switchTo({}, {claims}));
  }
}

// --- parameters that are read again at a switch -------------------------------------------------

TEST_F(Modes, RateLimitingIsReadAgainAtASwitch) {
  for (const bool limited : {true, false, true}) {
    arm_.robot_nh.setParam("rate_limiting", limited);
    loop_->controller("JT").torque = 5.0;
    double largest = 0.0;
    // The parameter is cached: the node receives a change a little later.
    ASSERT_TRUE(eventually([&] {
      largest = 0.0;
      for (const auto& exchange : run("JT")) {
        largest = std::max(largest, exchange.command.tau_J_d[0] - exchange.state.tau_J_d[0]);
      }
      return limited == (largest < 4.0);
    }));
    // 1000 Nm/s over a millisecond, or the whole step in one cycle.
    EXPECT_NEAR(limited ? 1.0 : 5.0, largest, 1e-3);
  }
}

TEST_F(Modes, FilterIsReadAgainAtASwitch) {
  constexpr double kCutoff = 100.0;
  const double gain = 0.001 / (0.001 + 1.0 / (2.0 * M_PI * kCutoff));
  arm_.robot_nh.setParam("cutoff_frequency", kCutoff);
  loop_->controller("JT").torque = 5.0;
  std::vector<franka_test::FakeRobot::Exchange> exchanges;
  ASSERT_TRUE(eventually([&] {
    exchanges = run("JT");
    return exchanges.size() > 1 && exchanges[1].command.tau_J_d[0] < 4.9;
  }));
  for (size_t i = 1; i < exchanges.size(); i++) {
    // The client's filter uses the torque in the state, a float since version 10.
    const double last = static_cast<float>(exchanges[i].state.tau_J_d[0]);
    EXPECT_NEAR(last + gain * (5.0 - last), exchanges[i].command.tau_J_d[0], 1e-9) << i;
  }
}

TEST_F(Modes, InternalControllerIsReadAgainAtASwitch) {
  arm_.robot_nh.setParam("internal_controller", "cartesian_impedance");
  ASSERT_TRUE(eventually([&] {
    run("JV", 3);
    return lastMove().controller_mode == ControllerMode::kCartesianImpedance;
  }));
  const LogCatcher log;
  arm_.robot_nh.setParam("internal_controller", "telepathy");
  ASSERT_TRUE(eventually([&] {
    run("JV", 3);
    return lastMove().controller_mode == ControllerMode::kJointImpedance;
  }));
  EXPECT_NE(std::string::npos, log.text().find("'telepathy'"));
}

}  // namespace
}  // namespace franka_hw_test
