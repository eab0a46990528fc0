// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// Parts of the package that need no master: queue, pace, world names, physics file, robot types,
/// mailbox, claims.

#include <franka_sim/physics/physics_config.h>
#include <franka_sim/physics/world.h>
#include <franka_sim/robot/motion/joint_motion.h>
#include <franka_sim_mujoco/command_shaper.h>
#include <franka_sim_mujoco/controller_check.h>
#include <franka_sim_mujoco/gripper_mailbox.h>
#include <franka_sim_mujoco/pace.h>
#include <franka_sim_mujoco/request_queue.h>
#include <franka_sim_mujoco/resources.h>
#include <franka_sim_mujoco/robot_type.h>
#include <franka_sim_mujoco/sim_arm.h>
#include <franka_sim_mujoco/world_file.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>

#include "robot/arm_fixture.h"
#include "robot/transform_sweep.h"

namespace franka_sim_mujoco {
namespace {

using std::chrono::milliseconds;

/// The sentence that an action throws; empty if it throws nothing.
template <typename Action>
std::string sentence(Action action) {
  try {
    action();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(RequestQueue, RunsWorkInTheServingThreadInOrder) {
  RequestQueue queue;
  std::atomic<bool> stop{false};
  std::thread::id server;
  std::thread serving([&] {
    queue.adopt();
    server = std::this_thread::get_id();
    while (!stop) {
      queue.waitForWork(milliseconds(5));
      queue.serve();
    }
  });
  std::string order;
  std::thread::id worker;
  queue.run([&] {
    worker = std::this_thread::get_id();
    order += "a";
    queue.run([&] { order += "b"; });  // from the serving thread itself: at once
  });
  queue.run([&] { order += "c"; });
  EXPECT_EQ("abc", order);
  EXPECT_EQ("no", sentence([&] { queue.run([] { throw std::runtime_error("no"); }); }));
  stop = true;
  serving.join();
  EXPECT_EQ(server, worker);
}

TEST(RequestQueue, TimesOutWithoutRunningTheWork) {
  RequestQueue queue;
  bool done = false;
  const std::string text = sentence([&] { queue.run([&] { done = true; }, milliseconds(20)); });
  EXPECT_TRUE(contains(text, "20 ms")) << text;
  queue.serve();
  EXPECT_FALSE(done) << "abandoned work must not run later: its data may be invalid";
  queue.close();
  EXPECT_TRUE(contains(sentence([&] { queue.run([] {}); }), "shutting down"));
}

TEST(RequestQueue, CloseEndsAllWaits) {
  RequestQueue queue;
  std::string text;
  std::thread waiting([&] { text = sentence([&] { queue.run([] {}); }); });
  std::this_thread::yield();
  queue.close();
  waiting.join();
  EXPECT_TRUE(contains(text, "shutting down")) << text;
}

TEST(Pace, RefusesInvalidFactors) {
  for (const double factor : {-1.0, 0.001, std::numeric_limits<double>::quiet_NaN(),
                              std::numeric_limits<double>::infinity()}) {
    EXPECT_TRUE(contains(sentence([&] { paceOf(factor); }), "is wrong: it must be 0")) << factor;
  }
  EXPECT_EQ(franka_sim::fci::PaceMode::kFreeRunning, paceOf(0.0).mode);
  EXPECT_EQ(franka_sim::fci::PaceMode::kPatient, paceOf(kSlowestPace).mode);
}

TEST(Pace, PublishesTheClockLessOftenBeyondRealTime) {
  EXPECT_EQ(1000.0, clockRateOf(kSlowestPace));
  EXPECT_EQ(1000.0, clockRateOf(1.0));
  for (const double factor : {0.0, 1.01, 30.0}) {
    EXPECT_GE(clockRateOf(factor), 100.0) << factor;
    EXPECT_LE(clockRateOf(factor), 250.0) << factor;
  }
}

std::int64_t sleepsOfThisThread() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nvcsw;
}

TEST(ShortSleeps, InterruptAThreadThatNeverWaits) {
  ShortSleeps short_sleeps;
  const std::int64_t before = sleepsOfThisThread();
  const std::int64_t end = monotonicNanoseconds() + 20000000000;
  while (sleepsOfThisThread() < before + 3 && monotonicNanoseconds() < end) {
    short_sleeps.sleepIfDue();
  }
  EXPECT_EQ(before + 3, sleepsOfThisThread());
}

double secondsFor(double factor, int ticks) {
  int done = 0;
  franka_sim::fci::Host host([&] { ++done; }, paceOf(factor));
  const std::int64_t start = monotonicNanoseconds();
  for (int i = 0; i < ticks; ++i) {
    host.tick();
  }
  EXPECT_EQ(ticks, done);
  return 1e-9 * static_cast<double>(monotonicNanoseconds() - start);
}

TEST(Pace, KeepsThePaceWithoutDrift) {
  // Never faster than requested; how much slower depends on the machine's load.
  EXPECT_GE(secondsFor(1.0, 200), 0.199);
  EXPECT_GE(secondsFor(2.0, 200), 0.099);
  // A host that follows the clock takes a hundred seconds; one that does not, half a second of a
  // processor, which may be shared.
  EXPECT_LT(secondsFor(0.0, 100000), 25.0);
}

TEST(WorldFile, FindsWorldsByTheirNames) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(testing::TempDir()) / "franka_world_file_test";
  fs::create_directories(folder / "elsewhere");
  for (const char* name : {"stone.xml", "elsewhere/beside.xml", "elsewhere/beside.sdf"}) {
    std::ofstream(folder / name) << "<mujoco/>";
  }
  const std::vector<std::string> folders{folder.string()};
  const std::string stone = (folder / "stone.xml").string();
  EXPECT_EQ("", findWorldFile("", folders));
  EXPECT_EQ(stone, findWorldFile(stone, {}));
  EXPECT_EQ(stone, findWorldFile("stone", folders));
  EXPECT_EQ(stone, findWorldFile("worlds/stone.world", folders));
  EXPECT_EQ(stone, findWorldFile("/nowhere/world/stone.sdf", folders));
  const std::string sdf = (folder / "elsewhere/beside.sdf").string();
  EXPECT_EQ(sdf, findWorldFile(sdf, folders));
  EXPECT_EQ(sdf, findWorldFile("elsewhere/beside.sdf", folders));
  EXPECT_EQ((folder / "elsewhere/beside.xml").string(),
            findWorldFile((folder / "elsewhere/beside.world").string(), folders));
  const std::string text = sentence([&] { findWorldFile("/nowhere/moon.sdf", folders); });
  EXPECT_TRUE(contains(text, "/nowhere/moon.sdf") && contains(text, folder.string())) << text;
  fs::remove_all(folder);
}

/// The only test in this program that searches packages: they are searched once.
TEST(Resources, AreFoundInFoldersThatPackagesExport) {
  namespace fs = std::filesystem;
  const fs::path package = fs::path(testing::TempDir()) / "franka_resources_test" / "pebbles";
  fs::create_directories(package / "my_models" / "pebble");
  fs::create_directories(package / "my_worlds");
  std::ofstream(package / "package.xml")
      << "<package "
         "format='2'><name>pebbles</name><version>1.0.0</version><description>d</description>"
         "<maintainer email='a@b.org'>a</maintainer><license>none</license>"
         "<exec_depend>gazebo_ros</exec_depend><export>"
         "<gazebo_ros gazebo_model_path='${prefix}/my_models'/>"
         "<gazebo_ros gazebo_media_path='${prefix}/my_worlds'/>"
         "<gazebo_ros plugin_path='${prefix}/lib'/></export></package>";
  const fs::path model = package / "my_models" / "pebble" / "model.sdf";
  std::ofstream(model)
      << "<sdf version='1.6'><model name='pebble'><link name='link'><collision name='c'><geometry>"
         "<sphere><radius>0.02</radius></sphere></geometry></collision></link></model></sdf>";
  std::ofstream(package / "my_models" / "pebble" / "model.config")
      << "<model><name>pebble</name><version>1.0</version><sdf "
         "version='1.6'>model.sdf</sdf></model>";
  const fs::path world = package / "my_worlds" / "beach.sdf";
  std::ofstream(world) << "<sdf version='1.6'><world name='beach'>"
                          "<include><uri>model://pebble</uri><pose>0 0 1 0 0 0</pose></include>"
                          "<include><uri>model://stone</uri><pose>1 0 1 0 0 0</pose></include>"
                          "</world></sdf>";
  const char* before = std::getenv("ROS_PACKAGE_PATH");
  ASSERT_NE(before, nullptr);
  setenv("ROS_PACKAGE_PATH", (package.string() + ":" + before).c_str(), 1);

  EXPECT_EQ(resolveUri("model://pebble/model.sdf"), model.string());
  EXPECT_TRUE(fs::is_regular_file(resolveUri("model://stone/model.sdf")));
  EXPECT_EQ(resolveUri("model://no_such_thing/model.sdf"), "");
  EXPECT_EQ(resolveUri("package://pebbles/package.xml"), (package / "package.xml").string());
  const auto plugins = gazeboPluginFolders();
  EXPECT_EQ(std::count(plugins.begin(), plugins.end(), (package / "lib").string()), 1);
  EXPECT_EQ(findWorldFile("beach.sdf", gazeboResourceFolders()), world.string());

  franka_sim::World beach(world.string(), resolveUri);
  EXPECT_EQ(beach.bodyPose("pebble").position[2], 1.0);
  EXPECT_EQ(beach.bodyPose("stone").position[0], 1.0);
  fs::remove_all(package.parent_path());
}

class PhysicsFile : public testing::Test {
 protected:
  void TearDown() override { std::remove(path_.c_str()); }
  franka_sim::RobotPhysics read(const std::string& text, const std::string& realism = "ideal") {
    std::ofstream(path_) << text;
    return franka_sim::readRobotPhysics(path_, "panda", franka_sim::readRealism(realism, "ideal"));
  }
  std::string path_{testing::TempDir() + "franka_physics_file_test.yaml"};
};

TEST_F(PhysicsFile, TakesTheRobotsSectionAndItsParts) {
  const std::string text =
      "panda: {rotor_inertia: [1, 2, 3, 4, 5, 6, 7], joint_stops: {lower: [-1, -1, -1, -1, -1, -1, "
      "-1], upper: [1, 1, 1, 1, 1, 1, 2]}, motors: {inertia: [.1, .2, .3, .4, .5, .6, .7]}, "
      "friction: {viscous: [1, 2, 3, 4, 5, 6, 7]}}\n";
  const franka_sim::RobotPhysics ideal = read(text);
  EXPECT_EQ(7.0, ideal.joints.rotor_inertia[6]);
  EXPECT_FALSE(ideal.joints.friction[6].acts());
  ASSERT_TRUE(ideal.joints.stops);
  EXPECT_EQ(2.0, ideal.joints.stops->upper[6]);
  EXPECT_EQ(0.7, read(text, "motors=on").joints.rotor_inertia[6]);
  EXPECT_EQ(7.0, read(text, "friction=on").joints.friction[6].viscous);
}

TEST_F(PhysicsFile, ReportsErrorsWithTheirCause) {
  const auto complaint = [this](const std::string& text, const std::string& realism = "ideal") {
    return sentence([&] { read(text, realism); });
  };
  EXPECT_TRUE(contains(complaint("fr3: {}"), "no section 'panda'"));
  EXPECT_TRUE(contains(complaint("panda: {rotor_inertia: [1, 2]}"),
                       "panda/rotor_inertia must be a list of 7"));
  EXPECT_TRUE(
      contains(complaint("panda: {rotor_inertia: [1, 2, 3, 4, 5, 6, x]}"), "finite numbers"));
  EXPECT_TRUE(
      contains(complaint("panda: {rotor_inertia: [1, 2, 3, 4, 5, 6, .nan]}"), "finite numbers"));
  EXPECT_TRUE(contains(complaint("panda: {}", "motors=on"), "no section 'motors'"));
  EXPECT_TRUE(contains(complaint("panda: {friction: {vicous: 1}}", "friction=on"), "'vicous'"));
  EXPECT_TRUE(contains(complaint("panda: {gripper: {start: -1}}", "gripper=on"), "from 0 to 10"));
  EXPECT_TRUE(
      contains(complaint("panda: {bandwidth: {tau_ext_hat_filtered: [0, 1, 1, 1, 1, 1, 1]}}",
                         "bandwidth=on"),
               "must be positive"));
  EXPECT_TRUE(contains(complaint("panda: ["), path_));
  EXPECT_TRUE(contains(sentence([] { franka_sim::readRobotPhysics("/nowhere.yaml", "panda", {}); }),
                       "/nowhere.yaml"));
}

/// Limits of joints 1 to 7 in the manufacturer's descriptions: lower, upper [rad], velocity
/// [rad/s].
struct Limits {
  std::array<double, 7> lower, upper, velocity;
};
constexpr Limits kPandaUrdf{{{-2.8973, -1.7628, -2.8973, -3.0718, -2.8973, -0.0175, -2.8973}},
                            {{2.8973, 1.7628, 2.8973, -0.0698, 2.8973, 3.7525, 2.8973}},
                            {{2.175, 2.175, 2.175, 2.175, 2.61, 2.61, 2.61}}};
constexpr Limits kFr3Urdf{{{-2.3093, -1.5133, -2.4937, -2.7478, -2.48, 0.8521, -2.6895}},
                          {{2.3093, 1.5133, 2.4937, -0.4461, 2.48, 4.2094, 2.6895}},
                          {{2.0, 1.0, 1.5, 1.25, 3.0, 1.5, 3.0}}};
constexpr Limits kFr3Ros2Urdf{{{-2.9007, -1.8361, -2.9007, -3.077, -2.8763, 0.4398, -3.0508}},
                              {{2.9007, 1.8361, 2.9007, -0.1169, 2.8763, 4.6216, 3.0508}},
                              {{2.62, 2.62, 2.62, 2.62, 5.26, 4.18, 5.26}}};

/// Ranges that both robots can reach; velocities are kept.
Limits narrowed(Limits limits) {
  limits.lower = {{-1.0, -1.0, -1.0, -2.5, -1.0, 1.0, -1.0}};
  limits.upper = {{1.0, 1.0, 1.0, -0.5, 1.0, 3.0, 1.0}};
  return limits;
}

Limits slowed(Limits limits) {
  limits.velocity.fill(0.5);
  return limits;
}

std::string joints(const std::string& arm_id, const Limits& limits) {
  std::ostringstream text;
  text << "<link name='" << arm_id << "_link0'/>";
  for (std::size_t i = 0; i < 7; ++i) {
    text << "<link name='" << arm_id << "_link" << i + 1 << "'/><joint name='" << arm_id << "_joint"
         << i + 1 << "' type='revolute'><parent link='" << arm_id << "_link" << i
         << "'/><child link='" << arm_id << "_link" << i + 1
         << "'/><axis xyz='0 0 1'/><limit lower='" << limits.lower[i] << "' upper='"
         << limits.upper[i] << "' velocity='" << limits.velocity[i] << "' effort='87'/></joint>";
  }
  return text.str();
}

std::string carried(const std::string& arm_id) {
  return "<joint name='" + arm_id + "_mount' type='fixed'><parent link='base'/><child link='" +
         arm_id + "_link0'/></joint>";
}

RobotType tell(const std::string& name, const std::string& parts,
               const std::optional<std::string>& asked = {}, const std::string& arm_id = "arm") {
  urdf::Model urdf;
  EXPECT_TRUE(urdf.initString("<robot name='" + name + "'>" + parts + "</robot>"));
  return tellRobotType(asked, urdf, arm_id);
}

TEST(RobotType, IsDetectedByTheJointsNotByTheName) {
  for (const Limits& fr3 :
       {kFr3Urdf, kFr3Ros2Urdf, slowed(kFr3Urdf), narrowed(kFr3Urdf), narrowed(kFr3Ros2Urdf)}) {
    EXPECT_EQ("fr3", tell("my_machine", joints("arm", fr3)).name);
    EXPECT_EQ("fr3", tell("panda", joints("arm", fr3)).name);
  }
  for (const Limits& panda : {kPandaUrdf, slowed(kPandaUrdf), narrowed(kPandaUrdf)}) {
    EXPECT_EQ("panda", tell("my_machine", joints("arm", panda)).name);
    EXPECT_EQ("panda", tell("fr3", joints("arm", panda)).name);
  }
  EXPECT_TRUE(
      contains(tell("a", joints("arm", kFr3Urdf)).why, "positions that the URDF allows arm"));
  EXPECT_TRUE(contains(tell("a", joints("arm", narrowed(kFr3Urdf))).why, "velocities"));
}

TEST(RobotType, IsDetectedForEachOfSeveralArms) {
  const std::string both = "<link name='base'/>" + joints("left", kFr3Urdf) + carried("left") +
                           joints("right", kPandaUrdf) + carried("right");
  EXPECT_EQ("fr3", tell("two_arms", both, {}, "left").name);
  EXPECT_EQ("panda", tell("two_arms", both, {}, "right").name);
}

TEST(RobotType, FollowsTheNameIfTheJointsAreAmbiguous) {
  for (const std::string& parts :
       {joints("arm", slowed(narrowed(kFr3Urdf))), joints("other", kFr3Urdf)}) {
    EXPECT_EQ("fr3", tell("fr3", parts).name);
    EXPECT_EQ("panda", tell("my_machine", parts).name);
    EXPECT_TRUE(contains(tell("my_machine", parts).why, "'my_machine'"));
    EXPECT_EQ("", tell("my_machine", parts, "fr3").warning);
  }
}

TEST(RobotType, ParameterOverridesTheJointsAndWarns) {
  const RobotType agreed = tell("my_machine", joints("arm", kFr3Urdf), "fr3");
  EXPECT_EQ("fr3", agreed.name);
  EXPECT_EQ("", agreed.warning);
  const RobotType contradicted = tell("fr3", joints("arm", kFr3Urdf), "panda");
  EXPECT_EQ("panda", contradicted.name);
  EXPECT_TRUE(contains(contradicted.warning, "looks like fr3: the positions"));
  EXPECT_TRUE(isRobotType("panda") && isRobotType("fr3"));
  EXPECT_FALSE(isRobotType("") || isRobotType("FR3") || isRobotType("ur5"));
}

class Mailbox : public testing::Test {
 protected:
  std::shared_ptr<GripperCommand> post(GripperCommand::Kind kind, double width = 0.04,
                                       double speed = 0.1) {
    auto command = std::make_shared<GripperCommand>();
    command->kind = kind;
    command->width = width;
    command->speed = speed;
    mailbox_.post(command);
    return command;
  }
  void tick() {
    mailbox_.serve(unit_);
    const auto force = unit_.step(fingers_, 1e-3);
    for (std::size_t i = 0; i < 2; ++i) {  // fingers of 0.1 kg
      fingers_.dq[i] += force[i] / 0.1 * 1e-3;
      fingers_.q[i] += fingers_.dq[i] * 1e-3;
    }
    mailbox_.settle(unit_);
  }
  GripperMailbox mailbox_;
  franka_sim::GripperUnit unit_{franka_sim::GripperParameters{}};
  franka_sim::HandMeasurement fingers_{{0.01, 0.01}, {0, 0}};
};

using Fate = GripperCommand::Fate;

TEST_F(Mailbox, ReportsTheOutcomeOfACommand) {
  const auto move = post(GripperCommand::Kind::kMove);
  EXPECT_EQ(Fate::kWaiting, move->fate);
  tick();
  EXPECT_EQ(Fate::kRunning, move->fate);
  for (int i = 0; i < 2000 && !move->isSettled(); ++i) {
    tick();
  }
  EXPECT_EQ(Fate::kSucceeded, move->fate);
  EXPECT_NEAR(0.04, unit_.width(), 5e-3);
}

TEST_F(Mailbox, NewCommandInterruptsWaitingAndRunningOnes) {
  const auto running = post(GripperCommand::Kind::kMove);
  tick();
  const auto waiting = post(GripperCommand::Kind::kHoming);
  const auto stop = post(GripperCommand::Kind::kStop);
  EXPECT_EQ(Fate::kInterrupted, waiting->fate) << "although the loop does not run";
  EXPECT_EQ(Fate::kRunning, running->fate);
  tick();
  EXPECT_EQ(Fate::kInterrupted, running->fate);
  EXPECT_EQ(Fate::kSucceeded, stop->fate);
}

TEST_F(Mailbox, RefusedCommandDoesNotInterrupt) {
  const auto running = post(GripperCommand::Kind::kMove);
  tick();
  const auto wrong = post(GripperCommand::Kind::kMove, std::nan(""));
  tick();
  EXPECT_EQ(Fate::kRefused, wrong->fate);
  EXPECT_EQ(Fate::kRunning, running->fate);
  mailbox_.interruptAll();
  EXPECT_EQ(Fate::kInterrupted, running->fate);
}

hardware_interface::ControllerInfo controller(const std::string& interface,
                                              const std::set<std::string>& resources) {
  hardware_interface::ControllerInfo info;
  info.name = "c";
  info.claimed_resources.emplace_back("hardware_interface::" + interface, resources);
  return info;
}

const std::set<std::string> kArm{"a_joint1", "a_joint2", "a_joint3", "a_joint4",
                                 "a_joint5", "a_joint6", "a_joint7"};
const std::set<std::string> kHand{"a_finger_joint1", "a_finger_joint2"};

TEST(ControllerCheck, AcceptsWholeArmsAndWholeHands) {
  std::set<std::string> six = kArm, both = kArm, with_wheel = kArm;
  six.erase("a_joint4");
  both.insert(kHand.begin(), kHand.end());
  with_wheel.insert("wheel");
  for (const char* interface :
       {"EffortJointInterface", "PositionJointInterface", "VelocityJointInterface"}) {
    EXPECT_EQ("", whyRefused(controller(interface, kArm), "a"));
    EXPECT_EQ("", whyRefused(controller(interface, {}), "a"));
    EXPECT_NE("", whyRefused(controller(interface, six), "a"));
    EXPECT_NE("", whyRefused(controller(interface, both), "a"));
    EXPECT_NE("", whyRefused(controller(interface, kArm), "b"));
    EXPECT_NE("", whyRefused(controller(interface, {"a_finger_joint1"}), "a"));
    EXPECT_NE("", whyRefused(controller(interface, with_wheel), "a"));
    EXPECT_EQ("", whyRefused(controller(interface, with_wheel), "a", {"wheel"}));
    EXPECT_EQ("", whyRefused(controller(interface, {"wheel"}), "a", {"wheel"}));
  }
  EXPECT_EQ("", whyRefused(controller("EffortJointInterface", kHand), "a"));
  EXPECT_TRUE(contains(whyRefused(controller("PositionJointInterface", kHand), "a"),
                       "PositionJointInterface"));
  EXPECT_TRUE(contains(whyRefused(controller("OtherInterface", kArm), "a"), "OtherInterface"));
  hardware_interface::ControllerInfo pose = controller("", {"a_robot"});
  pose.claimed_resources.front().hardware_interface = "franka_hw::FrankaPoseCartesianInterface";
  EXPECT_EQ("", whyRefused(pose, "a"));
  EXPECT_TRUE(contains(whyRefused(pose, "b"), "b_robot"));
}

TEST(ControllerCheck, DeterminesTheClaimedMode) {
  using franka_hw::ControlMode;
  hardware_interface::ControllerInfo pose = controller("EffortJointInterface", kArm);
  pose.claimed_resources.emplace_back("franka_hw::FrankaPoseCartesianInterface",
                                      std::set<std::string>{"a_robot"});
  EXPECT_EQ(ControlMode::JointTorque | ControlMode::CartesianPose, claimedMode({pose}, "a"));
  EXPECT_EQ(ControlMode::None, claimedMode({pose}, "panda"));
  EXPECT_EQ(ControlMode::None, claimedMode({controller("EffortJointInterface", kHand)}, "a"));
  EXPECT_EQ(ControlMode::JointVelocity,
            claimedMode({controller("VelocityJointInterface", kArm)}, "a"));
  EXPECT_TRUE(commandsArm(pose, "a"));
  EXPECT_FALSE(commandsArm(controller("EffortJointInterface", kHand), "a"));
}

TEST(ControllerCheck, ConflictsMatchTheRobot) {
  const auto effort = controller("EffortJointInterface", kArm);
  const auto position = controller("PositionJointInterface", kArm);
  const auto velocity = controller("VelocityJointInterface", kArm);
  const auto wheel = controller("VelocityJointInterface", {"wheel"});
  hardware_interface::ControllerInfo pose = controller("", {"a_robot"});
  pose.claimed_resources.front().hardware_interface = "franka_hw::FrankaPoseCartesianInterface";
  const auto hand = controller("EffortJointInterface", kHand);
  EXPECT_FALSE(conflict({effort, position, hand, wheel}, "a"));
  EXPECT_FALSE(conflict({effort, pose}, "a"));
  EXPECT_TRUE(conflict({effort, effort}, "a"));
  EXPECT_TRUE(conflict({position, velocity}, "a"));
  EXPECT_TRUE(conflict({position, pose}, "a"));
  EXPECT_TRUE(conflict({pose, pose}, "a"));
  EXPECT_TRUE(conflict({hand, hand}, "a"));
  EXPECT_TRUE(conflict({wheel, wheel}, "a"));
}

franka_sim::MotionLimits limitsOf(unsigned protocol) {
  return franka_sim::motionLimitsOfProtocol(protocol);
}

TEST(CommandShaper, PassesCommandsWithinTheLimits) {
  ShapingOptions options;
  options.cutoff_frequency = 1000.0;
  franka_core::RobotState state{};
  state.message_id = 7;
  ArmCommands desired;
  desired.torque.fill(3.0);
  desired.velocity.fill(1e-6);
  const auto mode = franka_hw::ControlMode::JointTorque | franka_hw::ControlMode::JointVelocity;
  const franka_core::RobotCommand command =
      shapeCommand(options, mode, desired, state, limitsOf(5));
  EXPECT_EQ(7u, command.message_id);
  EXPECT_EQ(desired.torque, command.tau_J_d) << "torques are limited only where reflexes act";
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_NEAR(1e-6, command.dq_c[i], 1e-15);
  }
  options.torques = true;
  EXPECT_NEAR(1.0, shapeCommand(options, mode, desired, state, limitsOf(5)).tau_J_d[3], 1e-5);
}

TEST(CommandShaper, PassesNonFiniteCommandsToTheRobot) {
  ArmCommands desired;
  desired.position[2] = std::nan("");
  desired.pose[0] = 2.0;
  const franka_core::RobotState state{};
  const auto position =
      shapeCommand({}, franka_hw::ControlMode::JointPosition, desired, state, limitsOf(5));
  EXPECT_TRUE(std::isnan(position.q_c[2]));
  ShapingOptions limited;
  limited.cutoff_frequency = 1000.0;
  const auto pose =
      shapeCommand(limited, franka_hw::ControlMode::CartesianPose, desired, state, limitsOf(5));
  EXPECT_EQ(2.0, pose.O_T_EE_c[0]);
}

/// An arm under ros_control whose Cartesian pose controller has just started.
struct PoseControlledArm {
  PoseControlledArm(const franka_sim::ControlUnitParameters& parameters,
                    const ShapingOptions& shaping)
      : plant(parameters.model, franka_sim::test::kReady),
        arm(parameters, plant, options(shaping)) {
    plant.payload = parameters.end_effector;
    arm.read(ros::Time(1));
    arm.control(franka_hw::ControlMode::CartesianPose, franka_hw::ControlMode::None);
  }
  static SimArmOptions options(const ShapingOptions& shaping) {
    SimArmOptions options;
    options.shaping = shaping;
    return options;
  }
  void tick() {
    arm.write();
    plant.step();
    arm.read(ros::Time(1));
  }

  franka_sim::test::FakeArm plant;
  SimArm arm;
};

TEST(CommandShaper, PoseHandlesAcceptTheSamePosesAsTheRobot) {
  franka_sim::ControlUnitParameters parameters = franka_sim::test::pandaWithHand();
  for (const bool reflexes : {false, true}) {
    for (const bool limited : {false, true}) {
      for (const double cutoff : {100.0, 1000.0}) {
        parameters.rules = reflexes ? franka_sim::InterfaceRules::kRosControlWithReflexes
                                    : franka_sim::InterfaceRules::kRosControl;
        ShapingOptions shaping;
        shaping.rate_limiting = limited;
        shaping.cutoff_frequency = cutoff;
        const std::array<double, 16> pose =
            PoseControlledArm(parameters, shaping).arm.commands().pose;
        for (const franka_sim::test::PerturbedMatrix& perturbed :
             franka_sim::test::perturbations(pose)) {
          PoseControlledArm controlled(parameters, shaping);
          ASSERT_EQ(SimArm::Switch::kDone, controlled.arm.switchResult());
          controlled.arm.commands().pose = perturbed.matrix;
          controlled.tick();
          controlled.tick();
          const bool runs = controlled.arm.state().robot_mode == franka::RobotMode::kMove;
          EXPECT_EQ(perturbed.accepted, runs) << perturbed << ", reflexes " << reflexes
                                              << ", limited " << limited << ", cutoff " << cutoff;
          EXPECT_EQ(perturbed.accepted ? 0u : 1u, controlled.arm.lastAbort().count) << perturbed;
          EXPECT_EQ(
              !perturbed.accepted,
              controlled.arm.lastAbort().errors[franka_core::indexOf(
                  franka_core::RobotError::kCartesianPositionMotionGeneratorInvalidFrameFlag)]);
        }
      }
    }
  }
}

TEST(SimArm, FlagsFollowTheManualsFormulasForFilteredValues) {
  franka_sim::ControlUnitParameters parameters = franka_sim::test::pandaWithHand();
  franka_sim::test::FakeArm plant(parameters.model, franka_sim::test::kReady);
  plant.payload = parameters.end_effector;
  SimArmOptions options;
  options.filter_alpha = 0.02;
  SimArm arm(parameters, plant, options);
  int contacts = 0;
  for (int i = 0; i < 1000; ++i) {
    plant.push = {{0, 0, i < 500 ? 40.0 : 0.0, 0, 0, 0}};
    arm.read(ros::Time(1));
    arm.write();
    plant.step();
    const franka::RobotState& state = arm.state();
    for (std::size_t j = 0; j < 7; ++j) {
      const double shown = std::abs(state.tau_ext_hat_filtered[j]);
      ASSERT_EQ(shown > parameters.nominal.lower_torque[j] ? 1.0 : 0.0, state.joint_contact[j]);
      ASSERT_EQ(shown > parameters.nominal.upper_torque[j] ? 1.0 : 0.0, state.joint_collision[j]);
    }
    for (std::size_t j = 0; j < 6; ++j) {
      const double shown = std::abs(state.K_F_ext_hat_K[j]);
      ASSERT_EQ(shown > parameters.nominal.lower_force[j] ? 1.0 : 0.0, state.cartesian_contact[j]);
      ASSERT_EQ(shown > parameters.nominal.upper_force[j] ? 1.0 : 0.0,
                state.cartesian_collision[j]);
      contacts += state.cartesian_contact[j] > 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(contacts, 100);
  EXPECT_LT(contacts, 700);
}

/// The robot itself checks the shaped commands of a controller that jumps.
class ShapedMotion : public testing::TestWithParam<unsigned> {};

TEST_P(ShapedMotion, IsNeverRefused) {
  const franka_sim::MotionLimits limits = limitsOf(GetParam());
  for (const double cutoff : {100.0, 1000.0}) {
    ShapingOptions options;
    options.cutoff_frequency = cutoff;
    franka_sim::JointMotion motion;
    franka_core::RobotState state{};
    state.q_d = {{0.0, -0.8, 0.0, -2.0, 0.0, 1.6, 0.0}};
    motion.start(state.q_d);
    ArmCommands desired;
    for (int tick = 0; tick < 4000; ++tick) {
      desired.velocity.fill(tick / 250 % 2 == 0 ? 0.7 : -0.7);  // jumps every quarter of a second
      const auto command =
          shapeCommand(options, franka_hw::ControlMode::JointVelocity, desired, state, limits);
      ASSERT_FALSE(motion.takeVelocities(command.dq_c, limits)) << tick;
      state.q_d = motion.last().q;
      state.dq_d = motion.last().dq;
      state.ddq_d = motion.last().ddq;
    }
    EXPECT_NEAR(-0.7, state.dq_d[0], 1e-2);
  }
}

INSTANTIATE_TEST_SUITE_P(PandaAndFr3, ShapedMotion, testing::Values(5u, 10u));

/// An FR3's velocity limits fall towards the joints' ends faster than joints 5 and 7 can brake.
class ShapedMotionToTheEnds : public testing::TestWithParam<unsigned> {};

TEST_P(ShapedMotionToTheEnds, ComesToRestWithoutRefusal) {
  const franka_sim::MotionLimits limits = limitsOf(GetParam());
  for (const double towards : {-20.0, 20.0}) {
    ShapingOptions options;
    options.cutoff_frequency = 1000.0;
    franka_sim::JointMotion motion;
    franka_core::RobotState state{};
    state.q_d = {{0.0, -0.8, 0.0, -2.0, 0.0, 1.6, 0.0}};
    motion.start(state.q_d);
    ArmCommands desired;
    desired.velocity.fill(towards);
    std::array<double, 7> fastest{};
    for (int tick = 0; tick < 10000; ++tick) {
      const auto command =
          shapeCommand(options, franka_hw::ControlMode::JointVelocity, desired, state, limits);
      ASSERT_FALSE(motion.takeVelocities(command.dq_c, limits)) << tick << " " << towards;
      state.q_d = motion.last().q;
      state.dq_d = motion.last().dq;
      state.ddq_d = motion.last().ddq;
      for (std::size_t i = 0; i < 7; ++i) {
        fastest[i] = std::max(fastest[i], std::abs(state.dq_d[i]));
      }
    }
    for (std::size_t i = 0; i < 7; ++i) {
      EXPECT_GT(fastest[i], 1.0) << i;
      EXPECT_NEAR(0.0, state.dq_d[i], 1e-2) << i;
      EXPECT_LT(
          towards > 0 ? limits.arm.q_max[i] - state.q_d[i] : state.q_d[i] - limits.arm.q_min[i],
          0.25)
          << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Fr3, ShapedMotionToTheEnds, testing::Values(6u, 9u, 10u));

}  // namespace
}  // namespace franka_sim_mujoco
