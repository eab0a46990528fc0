// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// FrankaHW's messages about parameters that are missing or wrong.
#include <gtest/gtest.h>

#include "support.h"

namespace franka_hw_test {
namespace {

using franka_hw::FrankaHW;

struct Case {
  std::string name;
  std::function<void(FakeArm&)> spoil;
  std::vector<std::string> words;  ///< of the message
};

/// Deletes a parameter of the robot.
std::function<void(FakeArm&)> without(const std::string& name) {
  return [name](FakeArm& arm) { arm.robot_nh.deleteParam(name); };
}

template <typename T>
std::function<void(FakeArm&)> with(const std::string& name, const T& value) {
  return [name, value](FakeArm& arm) { arm.robot_nh.setParam(name, value); };
}

std::vector<Case> refusals() {
  const std::vector<std::string> six(6, "fr3_joint1");
  return {
      {"no joint_names", without("joint_names"), {"joint_names' is missing", "seven names"}},
      {"joint_names a string", with("joint_names", std::string("j")), {"joint_names", "is not"}},
      {"joint_names numbers", with("joint_names", std::vector<int>(7, 1)), {"joint_names"}},
      {"six joint_names", with("joint_names", six), {"joint_names", "6 names instead of seven"}},
      {"no rate_limiting", without("rate_limiting"), {"rate_limiting' is missing"}},
      {"rate_limiting a string", with("rate_limiting", std::string("x")), {"true or false"}},
      {"no cutoff", without("cutoff_frequency"), {"cutoff_frequency' is missing"}},
      {"cutoff a string", with("cutoff_frequency", std::string("x")), {"is not a number [Hz]"}},
      {"no internal_controller", without("internal_controller"), {"internal_controller' is miss"}},
      {"internal_controller a number", with("internal_controller", 3), {"internal_controller"}},
      {"no arm_id", without("arm_id"), {"arm_id' is missing"}},
      {"arm_id a number", with("arm_id", 3), {"arm_id", "is not a string"}},
      {"no robot_ip", without("robot_ip"), {"robot_ip' is missing", "address"}},
      {"robot_ip a number", with("robot_ip", 1.5), {"robot_ip", "is not a string"}},
      {"realtime_config", with("realtime_config", std::string("often")), {"'often'", "enforce"}},
      {"ignore_robot_mismatch", with("ignore_robot_mismatch", 1), {"mismatch' is not true or"}},
      {"five thresholds",
       with("collision_config/lower_torque_thresholds_nominal", std::vector<double>(5, 9.0)),
       {"lower_torque_thresholds_nominal", "list of 7 numbers"}},
      {"thresholds a string",
       with("collision_config/upper_force_thresholds_acceleration", std::string("much")),
       {"upper_force_thresholds_acceleration", "list of 6 numbers"}},
      {"no description",
       [](FakeArm& arm) { arm.nh.deleteParam("robot_description"); },
       {"robot_description", "launch file"}},
      {"description no XML",
       [](FakeArm& arm) { arm.nh.setParam("robot_description", "<robot"); },
       {"robot_description"}},
      {"no robot at the address",
       with("robot_ip", std::string("127.0.0.1:9")),
       {"127.0.0.1:9", "could not be initialized", "franka_sim --robot", "sim:=true"}},
  };
}

TEST(Parameters, EveryMistakeEndsInASentenceThatNamesIt) {
  for (const Case& mistake : refusals()) {
    SCOPED_TRACE(mistake.name);
    FakeArm arm;
    mistake.spoil(arm);
    FrankaHW robot;
    const LogCatcher log;
    EXPECT_FALSE(robot.init(arm.nh, arm.robot_nh));
    const std::string log_text = log.text(ros::console::levels::Error);
    for (const std::string& word : mistake.words) {
      EXPECT_NE(std::string::npos, log_text.find(word)) << "'" << word << "' is not in:\n"
                                                        << log_text;
    }
    EXPECT_FALSE(robot.connected());
    EXPECT_THROW(robot.robot(), std::logic_error);
  }
}

TEST(Parameters, SecondInitIsRefused) {
  FakeArm arm;
  FrankaHW robot;
  ASSERT_TRUE(robot.init(arm.nh, arm.robot_nh));
  const LogCatcher log;
  EXPECT_FALSE(robot.init(arm.nh, arm.robot_nh));
  EXPECT_NE(std::string::npos, log.text().find("a second time"));
}

TEST(Parameters, AnArmMissingInTheDescriptionIsReportedJointByJoint) {
  FakeArm arm;
  arm.robot_nh.setParam("arm_id", "left");
  arm.robot_nh.setParam("joint_names", FakeArm::joints("left"));
  FrankaHW robot;
  const LogCatcher log;
  ASSERT_TRUE(robot.init(arm.nh, arm.robot_nh)) << "as the original: only the soft limits are lost";
  for (const std::string& joint : FakeArm::joints("left")) {
    EXPECT_NE(std::string::npos, log.text(ros::console::levels::Warn).find("'" + joint + "'"));
  }
}

/// The thresholds that a robot has received.
std::vector<franka_core::fci::SetCollisionBehaviorRequest> thresholdsOf(FakeArm& arm) {
  std::vector<franka_core::fci::SetCollisionBehaviorRequest> received;
  for (const auto& request : arm.robot.requests()) {
    if (const auto* of = std::get_if<franka_core::fci::SetCollisionBehaviorRequest>(&request)) {
      received.push_back(*of);
    }
  }
  return received;
}

TEST(Parameters, CollisionThresholdsGoToTheRobot) {
  FakeArm arm;
  const std::vector<double> torques{1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0};
  const std::vector<double> forces{11.0, 12.0, 13.0, 14.0, 15.0, 16.0};
  arm.robot_nh.setParam("collision_config/lower_torque_thresholds_nominal", torques);
  arm.robot_nh.setParam("collision_config/upper_force_thresholds_acceleration", forces);
  for (const char* name : {"upper_torque_thresholds_nominal", "lower_force_thresholds_nominal"}) {
    arm.robot_nh.deleteParam(std::string("collision_config/") + name);  // the defaults are used
  }
  FrankaHW robot;
  const LogCatcher log;
  ASSERT_TRUE(robot.init(arm.nh, arm.robot_nh));

  const auto received = thresholdsOf(arm);
  ASSERT_EQ(1U, received.size());
  const auto& sent = received[0];
  const std::array<double, 7> default_torques{20, 20, 18, 18, 16, 14, 12};
  const std::array<double, 6> default_forces{20, 20, 20, 25, 25, 25};
  EXPECT_TRUE(std::equal(torques.begin(), torques.end(), sent.lower_torques_nominal.begin()));
  EXPECT_TRUE(std::equal(forces.begin(), forces.end(), sent.upper_forces_acceleration.begin()));
  EXPECT_EQ(default_torques, sent.upper_torques_nominal);
  EXPECT_EQ(default_torques, sent.lower_torques_acceleration);
  EXPECT_EQ(default_torques, sent.upper_torques_acceleration);
  EXPECT_EQ(default_forces, sent.lower_forces_nominal);
  EXPECT_EQ(default_forces, sent.lower_forces_acceleration);
  EXPECT_EQ(default_forces, sent.upper_forces_nominal);
  for (const char* name : {"upper_torque_thresholds_nominal", "lower_force_thresholds_nominal"}) {
    EXPECT_NE(std::string::npos, log.text().find(name)) << name;
  }
}

TEST(Parameters, LowerThresholdsAboveTheUpperOnesGoToTheRobotToo) {
  FakeArm arm;
  const std::vector<double> torques(7, 80.0);
  arm.robot_nh.setParam("collision_config/lower_torque_thresholds_nominal", torques);
  FrankaHW robot;
  ASSERT_TRUE(robot.init(arm.nh, arm.robot_nh));
  const auto received = thresholdsOf(arm);
  ASSERT_EQ(1U, received.size());
  const auto& sent = received[0];
  EXPECT_TRUE(std::equal(torques.begin(), torques.end(), sent.lower_torques_nominal.begin()));
  EXPECT_GT(sent.lower_torques_nominal[0], sent.upper_torques_nominal[0]);
}

TEST(Parameters, ARobotThatRefusesItsThresholdsIsNotConnected) {
  FakeArm arm;
  arm.robot.script([](auto& script) {
    script.replies[Command::kSetCollisionBehavior] =
        franka_core::fci::Status::kInvalidArgumentRejected;
  });
  FrankaHW robot;
  const LogCatcher log;
  EXPECT_FALSE(robot.init(arm.nh, arm.robot_nh));
  EXPECT_FALSE(robot.connected());
  EXPECT_NE(std::string::npos, log.text().find("could not be initialized"));
}

TEST(Parameters, ARobotThatIsStillStartingIsWaitedFor) {
  FakeArm arm;
  arm.robot.script([](auto& script) { script.fatal = {Command::kConnect}; });
  arm.robot_nh.setParam("connect_timeout", 0.5);
  EXPECT_FALSE(FrankaHW().init(arm.nh, arm.robot_nh)) << "for a limited time";
  arm.robot_nh.setParam("connect_timeout", 60.0);
  const int before = arm.robot.connections();
  std::thread start([&] {
    EXPECT_TRUE(eventually([&] { return arm.robot.connections() > before; }));
    arm.robot.script([](auto& script) { script.fatal.clear(); });
  });
  EXPECT_TRUE(FrankaHW().init(arm.nh, arm.robot_nh));
  start.join();
  arm.robot_nh.setParam("connect_timeout", 1e20);  // longer than any clock
  EXPECT_TRUE(FrankaHW().init(arm.nh, arm.robot_nh));
}

}  // namespace
}  // namespace franka_hw_test
