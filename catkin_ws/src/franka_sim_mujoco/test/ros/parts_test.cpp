// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// The parts of the ROS room that need no master: queue, pace, world names, physics file, mailbox,
/// claims.

#include <franka_sim_mujoco/ros/controller_check.h>
#include <franka_sim_mujoco/ros/gripper_mailbox.h>
#include <franka_sim_mujoco/ros/pacer.h>
#include <franka_sim_mujoco/ros/physics_config.h>
#include <franka_sim_mujoco/ros/request_queue.h>
#include <franka_sim_mujoco/ros/world_file.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>

namespace franka_sim_mujoco {
namespace {

using std::chrono::milliseconds;

/// The sentence an action throws; empty when it throws none.
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

TEST(RequestQueue, DoesWorkInTheServingThreadInOrder) {
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

TEST(RequestQueue, GivesUpWorkWhoseTurnDoesNotCome) {
  RequestQueue queue;
  bool done = false;
  const std::string text = sentence([&] { queue.run([&] { done = true; }, milliseconds(20)); });
  EXPECT_TRUE(contains(text, "20 ms")) << text;
  queue.serve();
  EXPECT_FALSE(done) << "abandoned work must not be done later: its data may be gone";
  queue.close();
  EXPECT_TRUE(contains(sentence([&] { queue.run([] {}); }), "shutting down"));
}

TEST(RequestQueue, CloseReleasesThoseWhoWait) {
  RequestQueue queue;
  std::string text;
  std::thread waiting([&] { text = sentence([&] { queue.run([] {}); }); });
  std::this_thread::yield();
  queue.close();
  waiting.join();
  EXPECT_TRUE(contains(text, "shutting down")) << text;
}

TEST(Pacer, RefusesWhatIsNoPace) {
  Pacer pacer;
  for (const double factor : {-1.0, 0.001, std::numeric_limits<double>::quiet_NaN(),
                              std::numeric_limits<double>::infinity()}) {
    EXPECT_FALSE(pacer.setFactor(factor)) << factor;
    EXPECT_EQ(1.0, pacer.factor());
  }
  EXPECT_TRUE(pacer.setFactor(0.0));
  EXPECT_TRUE(pacer.setFactor(Pacer::kSlowest));
}

double secondsFor(double factor, int ticks) {
  Pacer pacer;
  pacer.setFactor(factor);
  const std::int64_t start = monotonicNanoseconds();
  for (int i = 0; i < ticks; ++i) {
    pacer.waitForNextTick();
  }
  return 1e-9 * static_cast<double>(monotonicNanoseconds() - start);
}

TEST(Pacer, KeepsThePaceWithoutAddingUpErrors) {
  // Never faster than asked; how much slower depends on the machine's load.
  EXPECT_GE(secondsFor(1.0, 200), 0.199);
  EXPECT_GE(secondsFor(2.0, 200), 0.099);
  EXPECT_LT(secondsFor(0.0, 100000), 0.5);
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
  EXPECT_EQ((folder / "elsewhere/beside.xml").string(),
            findWorldFile((folder / "elsewhere/beside.sdf").string(), folders));
  const std::string text = sentence([&] { findWorldFile("/nowhere/moon.sdf", folders); });
  EXPECT_TRUE(contains(text, "/nowhere/moon.sdf") && contains(text, folder.string())) << text;
  fs::remove_all(folder);
}

class PhysicsFile : public testing::Test {
 protected:
  void TearDown() override { std::remove(path_.c_str()); }
  JointPhysics read(const std::string& text, const std::string& friction = "none") {
    std::ofstream(path_) << text;
    return readJointPhysics(path_, "panda", friction);
  }
  std::string path_{testing::TempDir() + "franka_physics_file_test.yaml"};
};

TEST_F(PhysicsFile, TakesTheRobotsSectionAndTheFrictionSet) {
  const std::string text =
      "panda: {rotor_inertia: [1, 2, 3, 4, 5, 6, 7], joint_stops: {lower: [-1, -1, -1, -1, -1, -1, "
      "-1], "
      "upper: [1, 1, 1, 1, 1, 1, 2]}}\n"
      "friction_sets: {none: {}, fr3: {damping: [.1, .2, .3, .4, .5, .6, .7]}}\n";
  const JointPhysics plain = read(text);
  EXPECT_EQ(7.0, plain.rotor_inertia[6]);
  EXPECT_EQ(0.0, plain.damping[6]);
  ASSERT_TRUE(plain.stops);
  EXPECT_EQ(2.0, plain.stops->upper[6]);
  EXPECT_EQ(0.7, read(text, "fr3").damping[6]);
}

TEST_F(PhysicsFile, SaysWhatIsWrong) {
  const auto complaint = [this](const std::string& text, const std::string& friction = "none") {
    return sentence([&] { read(text, friction); });
  };
  EXPECT_TRUE(contains(complaint("fr3: {}"), "no section 'panda'"));
  EXPECT_TRUE(contains(complaint("panda: {damping: [1, 2]}"), "panda/damping must be a list of 7"));
  EXPECT_TRUE(contains(complaint("panda: {damping: [1, 2, 3, 4, 5, 6, x]}"), "finite numbers"));
  EXPECT_TRUE(contains(complaint("panda: {damping: [1, 2, 3, 4, 5, 6, .nan]}"), "finite numbers"));
  EXPECT_TRUE(
      contains(complaint("panda: {}\nfriction_sets: {none: {}}", "ice"), "no section 'ice'"));
  EXPECT_TRUE(contains(complaint("panda: ["), path_));
  EXPECT_TRUE(contains(sentence([] { readJointPhysics("/nowhere.yaml", "panda", "none"); }),
                       "/nowhere.yaml"));
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
  GripperUnit unit_{GripperParameters{}};
  HandMeasurement fingers_{{0.01, 0.01}, {0, 0}};
};

using Fate = GripperCommand::Fate;

TEST_F(Mailbox, CarriesACommandToItsOutcome) {
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

TEST_F(Mailbox, ANewCommandInterruptsWhatWaitsAndWhatRuns) {
  const auto running = post(GripperCommand::Kind::kMove);
  tick();
  const auto waiting = post(GripperCommand::Kind::kHoming);
  const auto stop = post(GripperCommand::Kind::kStop);
  EXPECT_EQ(Fate::kInterrupted, waiting->fate) << "although the loop stands still";
  EXPECT_EQ(Fate::kRunning, running->fate);
  tick();
  EXPECT_EQ(Fate::kInterrupted, running->fate);
  EXPECT_EQ(Fate::kSucceeded, stop->fate);
}

TEST_F(Mailbox, ARefusedCommandLeavesWhatRuns) {
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

TEST(ControllerCheck, TakesWholeArmsAndWholeHandsByEffort) {
  const std::set<std::string> arm{"a_joint1", "a_joint2", "a_joint3", "a_joint4",
                                  "a_joint5", "a_joint6", "a_joint7"};
  const std::set<std::string> hand{"a_finger_joint1", "a_finger_joint2"};
  std::set<std::string> six = arm, both = arm;
  six.erase("a_joint4");
  both.insert(hand.begin(), hand.end());
  EXPECT_EQ("", whyRefused(controller("EffortJointInterface", arm), "a"));
  EXPECT_EQ("", whyRefused(controller("EffortJointInterface", hand), "a"));
  EXPECT_EQ("", whyRefused(controller("EffortJointInterface", {}), "a"));
  EXPECT_TRUE(contains(whyRefused(controller("PositionJointInterface", arm), "a"),
                       "PositionJointInterface"));
  EXPECT_NE("", whyRefused(controller("EffortJointInterface", six), "a"));
  EXPECT_NE("", whyRefused(controller("EffortJointInterface", both), "a"));
  EXPECT_NE("", whyRefused(controller("EffortJointInterface", arm), "b"));
  EXPECT_NE("", whyRefused(controller("EffortJointInterface", {"a_finger_joint1"}), "a"));
  EXPECT_TRUE(commandsArm(controller("EffortJointInterface", arm), "a"));
  EXPECT_FALSE(commandsArm(controller("EffortJointInterface", hand), "a"));
  EXPECT_FALSE(commandsArm(controller("EffortJointInterface", arm), "panda"));
}

}  // namespace
}  // namespace franka_sim_mujoco
