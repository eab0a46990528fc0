// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <controller_manager_msgs/SwitchController.h>
#include <franka_example_controllers/python_controller.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <ros_test/eventually.h>
#include <rosgraph_msgs/Log.h>
#include <rt_guard/rt_guard.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "whole_arm.h"

namespace franka_example_controllers {
namespace {

using ros_test::eventually;
using Names = std::vector<std::string>;
constexpr double kPeriod = 1e-3;  // [s]

/// The log's errors, and the controllers' requests to the controller manager, which the test
/// replaces.
class World {
 public:
  World() {
    log_ = node_.subscribe<rosgraph_msgs::Log>("/rosout", 100,
                                               [this](const rosgraph_msgs::LogConstPtr& message) {
                                                 const std::lock_guard<std::mutex> lock(mutex_);
                                                 if (message->level >= rosgraph_msgs::Log::ERROR) {
                                                   errors_ += message->msg + "\n";
                                                 }
                                               });
    manager_ = node_.advertiseService<controller_manager_msgs::SwitchController::Request,
                                      controller_manager_msgs::SwitchController::Response>(
        "controller_manager/switch_controller", [this](auto& request, auto& response) {
          const std::lock_guard<std::mutex> lock(mutex_);
          stopped_.insert(stopped_.end(), request.stop_controllers.begin(),
                          request.stop_controllers.end());
          started_.insert(started_.end(), request.start_controllers.begin(),
                          request.start_controllers.end());
          response.ok = true;
          return true;
        });
  }

  void forget() {
    const std::lock_guard<std::mutex> lock(mutex_);
    errors_.clear();
    stopped_.clear();
    started_.clear();
  }
  bool logged(const std::string& text) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return errors_.find(text) != std::string::npos;
  }
  std::string errors() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return errors_;
  }
  Names stopped() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return stopped_;
  }
  Names started() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return started_;
  }

 private:
  ros::NodeHandle node_;
  std::mutex mutex_;
  std::string errors_;
  Names stopped_, started_;
  ros::Subscriber log_;
  ros::ServiceServer manager_;
};

World& world() {
  static World instance;
  return instance;
}

/// On hardware, where loop and script sleep while they wait, and in simulated time (true).
class PythonControllerTest : public testing::TestWithParam<bool> {
 protected:
  PythonControllerTest() : node("python_" + std::to_string(++number())) {
    world().forget();
    ros::param::set("/use_sim_time", GetParam());
    node.setParam("class", "Law");
    node.setParam("arm_id", "panda");
    node.setParam("joint_names", arm.joint_names);
    // For a shared machine.
    node.setParam("max_update_time", 30.0);
    node.setParam("max_starting_time", 60.0);
    command({"joint_velocity"});
  }

  static int& number() {
    static int count = 0;
    return count;
  }

  void command(const Names& names) { node.setParam("command", names); }

  /// @param body of `update`, and of `starting`
  void law(const std::string& body, const std::string& start = "pass") {
    script(
        "import numpy as np, time, os\nclass Law:\n  def starting(self, state, model):\n    self.n "
        "= "
        "0\n    " +
        start + "\n  def update(self, state, model, period):\n    self.n += 1\n    " + body + "\n");
  }

  void script(const std::string& text) {
    const std::string path = testing::TempDir() + "law_" + std::to_string(getpid()) + ".py";
    std::ofstream(path) << text;
    node.setParam("script", path);
  }

  bool initialize(PythonController& controller) {
    ros::NodeHandle root;
    controller_interface::ControllerBase& base = controller;
    claims.clear();
    return base.initRequest(&arm, root, node, claims);
  }

  void run(PythonController& controller, int cycles) {
    for (int i = 0; i < cycles; ++i) {
      controller.update(ros::Time(1.0 + kPeriod * i), ros::Duration(kPeriod));
    }
  }

  /// Runs a law until the controller requests its stop; then the log must contain the text.
  void expectFailure(const std::string& text) {
    world().forget();
    PythonController controller;
    ASSERT_TRUE(initialize(controller)) << world().errors();
    controller.starting(ros::Time(1.0));
    const std::string name = node.getNamespace().substr(1);
    EXPECT_TRUE(eventually([&] {
      run(controller, 300);
      return !world().stopped().empty();
    })) << text;
    EXPECT_EQ(Names{name}, world().stopped());
    EXPECT_TRUE(eventually([&] { return world().logged(text); })) << text << "\n"
                                                                  << world().errors();
    EXPECT_TRUE(world().logged("PythonController '" + name + "' has failed"));
    controller.stopping(ros::Time(9.0));
  }

  void expectRefusal(const std::string& text) {
    PythonController controller;
    EXPECT_FALSE(initialize(controller));
    EXPECT_TRUE(eventually([&] { return world().logged(text); })) << text << "\n"
                                                                  << world().errors();
  }

  WholeArm arm;
  ros::NodeHandle node;
  controller_interface::ControllerBase::ClaimedResources claims;
};

TEST_P(PythonControllerTest, PassesEveryAllowedCombination) {
  const std::string seven = "np.arange(7.0) + 10.0";
  const std::string pose = "np.array(state.O_T_EE_d)";
  const std::string twist = "np.arange(6.0) + 20.0";
  for (const bool effort : {false, true}) {
    for (const std::string motion :
         {"", "joint_position", "joint_velocity", "cartesian_pose", "cartesian_velocity"}) {
      if (motion.empty() && !effort) {
        continue;
      }
      Names names{effort ? "effort" : motion};
      if (effort && !motion.empty()) {
        names.push_back(motion);
      }
      command(names);
      const std::string moves =
          motion == "cartesian_pose" ? pose : (motion == "cartesian_velocity" ? twist : seven);
      std::string dict = effort ? "'effort': np.arange(7.0) + 30.0, " : "";
      dict += motion.empty() ? "" : "'" + motion + "': " + moves;
      law("return {" + dict + "}");
      PythonController controller;
      ASSERT_TRUE(initialize(controller)) << motion << effort << world().errors();
      std::size_t claimed = 0;
      for (const auto& claim : claims) {
        claimed += claim.resources.size();
      }
      const std::size_t of_motion = motion.empty() ? 0 : (motion[0] == 'c' ? 1 : 7);
      EXPECT_EQ(of_motion + (effort ? 7 : 0), claimed) << motion;
      arm.effort = arm.position = arm.velocity = {};
      arm.pose = {};
      arm.twist = {};
      controller.starting(ros::Time(1.0));
      run(controller, 3);
      controller.stopping(ros::Time(2.0));
      EXPECT_EQ(effort ? 36.0 : 0.0, arm.effort[6]) << motion;
      EXPECT_EQ(motion == "joint_position" ? 16.0 : 0.0, arm.position[6]);
      EXPECT_EQ(motion == "joint_velocity" ? 16.0 : 0.0, arm.velocity[6]);
      EXPECT_EQ(motion == "cartesian_pose" ? 0.3 : 0.0, arm.pose[12]);
      EXPECT_EQ(motion == "cartesian_velocity" ? 25.0 : 0.0, arm.twist[5]);
    }
  }
  EXPECT_EQ("", world().errors());
}

TEST_P(PythonControllerTest, ElbowAccompaniesCartesianCommands) {
  command({"cartesian_velocity"});
  law("return {'cartesian_velocity': [0.0] * 6, 'elbow': [0.25, -1.0]}");
  PythonController controller;
  ASSERT_TRUE(initialize(controller));
  controller.starting(ros::Time(1.0));
  run(controller, 1);
  EXPECT_EQ((std::array<double, 2>{{0.25, -1.0}}), arm.elbow);
}

TEST_P(PythonControllerTest, ShowsStateModelPeriodAndParameters) {
  node.setParam("gains/k", 2.5);
  node.setParam("list", Names{"a", "b"});
  script(R"(
import numpy as np, pyfranka
class Law:
  def __init__(self, parameters):
    self.k = parameters['gains']['k']
    assert parameters['list'] == ['a', 'b'] and parameters['arm_id'] == 'panda'
  def starting(self, state, model):
    assert model.mass().shape == (7, 7) and model.mass()[1, 0] == 401.0
  def update(self, state, model, period):
    F = pyfranka.Frame
    eye = np.eye(4)
    assert model.coriolis()[0] == 500.0 and model.gravity()[0] == 600.0 - 9.81
    assert model.gravity([0.0, 0.0, 1.0])[0] == 601.0
    assert model.gravity([0.0] * 7, 1.0, [0.0] * 3)[0] == 600.0 - 9.81
    assert model.pose(F.Joint4)[0, 3] == 112.0 + 3000.0 + state.q[0]
    assert model.pose(F.Joint1, [5.0] + [0.0] * 6, eye, eye)[0, 0] == 105.0
    assert model.body_jacobian(F.EndEffector).shape == (6, 7)
    assert model.body_jacobian(F.EndEffector)[1, 2] == 213.0
    assert model.zero_jacobian(F.Flange, [0.0] * 7, eye, eye)[0, 0] == 300.0
    assert model.mass([0.0] * 7, np.eye(3), 1.0, [0.0] * 3)[0, 1] == 407.0
    assert model.coriolis([0.0] * 7, [0.0] * 7, np.eye(3), 1.0, [0.0] * 3)[6] == 506.0
    return [self.k, period, state.q_d[1], state.O_T_EE_d[2, 3], 0, 0, 0]
)");
  PythonController controller;
  ASSERT_TRUE(initialize(controller)) << world().errors();
  controller.starting(ros::Time(1.0));
  run(controller, 1);
  EXPECT_EQ("", world().errors());
  EXPECT_EQ((std::array<double, 7>{{2.5, kPeriod, -0.7, 0.5, 0.0, 0.0, 0.0}}), arm.velocity);
}

TEST_P(PythonControllerTest, StopsItselfWithASentenceForAnyScriptError) {
  const std::pair<const char*, const char*> cases[] = {
      {"return 1.0 / 0", "ZeroDivisionError: float division by zero"},
      {"return None", "update() returned None; it must return joint_velocity."},
      {"return [float('nan')] * 7",
       "The command joint_velocity holds a value that is not a finite number."},
      {"return [0.0] * 6", "joint_velocity needs 7 numbers, not 6."},
      {"return 'left'", "joint_velocity needs 7 numbers."},
      {"return {'effort': [0.0] * 7}", "The dict that update() returned must hold joint_velocity."},
      {"return {'joint_velocity': [0.0] * 7, 'effort': [0.0] * 7}",
       "update() returned 'effort', but this controller commands joint_velocity."},
      {"raise SystemExit(3)", "SystemExit: 3"},
  };
  for (const auto& [body, text] : cases) {
    law(std::string(body));
    expectFailure(text);
  }
  law("return [0.0] * 7", "raise ValueError('not here')");
  expectFailure("ValueError: not here");
  // The location is reported as well.
  EXPECT_TRUE(world().logged(", in starting"));
}

TEST_P(PythonControllerTest, RefusesInvalidPosesByTheRobotsRule) {
  command({"cartesian_pose"});
  const std::pair<const char*, const char*> cases[] = {
      {"return np.diag([1, 1.1, 1, 1])", "column 2 of its rotation has the length 1.1"},
      {"return np.diag([1, 1, -1, 1])", "it mirrors"},
      {"T = np.full((4, 4), 3.0**-0.5); T[3] = 0, 0, 0, 1; return T",
       "columns 1 and 2 of its rotation are not at right angles"},
      {"return np.ones(16)", "its bottom row (entries 4, 8, 12 and 16"},
      {"T = np.eye(4); T[1, 3] = np.nan; return T", "its entry in row 2 and column 4 is nan"}};
  for (const auto& [body, fault] : cases) {
    law(body);
    expectFailure("The command cartesian_pose is not a pose: " + std::string(fault));
  }
}

TEST_P(PythonControllerTest, AbandonsALateScriptAndContinuesWithOthers) {
  node.setParam("max_update_time", 0.9);
  node.setParam("fallback_controllers", Names{"other"});
  law("\n    while self.n == 3: pass\n    return [0.0] * 7");
  PythonController controller;
  ASSERT_TRUE(initialize(controller)) << world().errors();
  controller.starting(ros::Time(1.0));
  run(controller, 2);
  run(controller, 3000);
  EXPECT_TRUE(eventually([] { return world().logged("within the 900 ms that it is allowed"); }));
  EXPECT_TRUE(eventually([] { return world().logged("was interrupted here:"); }))
      << world().errors();
  EXPECT_TRUE(eventually([] { return !world().started().empty(); }));
  EXPECT_EQ(Names{"other"}, world().started());
  // After a restart it begins from the start.
  controller.stopping(ros::Time(5.0));
  controller.starting(ros::Time(6.0));
  run(controller, 2);
  EXPECT_EQ(0.0, arm.velocity[0]);
}

TEST_P(PythonControllerTest, RefusesTheModelBetweenCycles) {
  law("\n    self.model = model\n    import threading\n    return [0.0] * 7");
  script(R"(
import threading, time
class Law:
  def starting(self, state, model):
    self.message = ''
    self.gone = threading.Event()
    def later():
      self.gone.wait()
      while not self.message:
        try:
          model.mass()
        except RuntimeError as error:
          self.message = str(error)
    threading.Thread(target=later, daemon=True).start()
  def update(self, state, model, period):
    self.gone.set()
    if self.message:
      raise RuntimeError(self.message)
    return [0.0] * 7
)");
  expectFailure("The model may be used only within starting() and update()");
}

TEST_P(PythonControllerTest, RefusesScriptsThatCannotBeLoaded) {
  script("class Law:\n  def starting(self\n");
  expectRefusal("SyntaxError");
  script("class Other: pass\n");
  expectRefusal("has no class 'Law'; check the parameter class.");
  script("class Law:\n  def starting(self, state, model): pass\n");
  expectRefusal("has no function 'update'");
  script("import no_such_thing\n");
  expectRefusal("ModuleNotFoundError: No module named 'no_such_thing'");
  script(
      "class Law:\n  starting = update = lambda *a: 0\n  def __init__(self, p): self.k = p['k']\n");
  expectRefusal("KeyError: 'k'");
  node.setParam("load_timeout", 0.3);
  script("import time\nwhile True: time.sleep(0.01)\n");  // the fault itself
  expectRefusal("It did not load within 0.3");
  node.setParam("script", "nowhere.py");
  expectRefusal("No such file or directory");
  node.setParam("module", "no_such_module");
  expectRefusal("set one of the parameters");
  node.deleteParam("script");
  expectRefusal("No module named 'no_such_module'");
  command({"joint_position", "cartesian_pose"});
  expectRefusal("An arm follows one motion at a time");
  command({"torque"});
  expectRefusal("There is no command interface 'torque'");
  node.deleteParam("command");
  expectRefusal("No command interface is named");
  command({"effort"});
  for (const double time : {-1.0, 1e20}) {
    node.setParam("max_update_time", time);
    expectRefusal("must be a time above zero");
  }
}

TEST_P(PythonControllerTest, ReloadsAScriptTwentyTimes) {
  for (int i = 0; i < 20; ++i) {
    law("return [" + std::to_string(i) + ".0] * 7");
    PythonController controller;
    ASSERT_TRUE(initialize(controller)) << world().errors();
    controller.starting(ros::Time(1.0));
    run(controller, 1);
    EXPECT_EQ(static_cast<double>(i), arm.velocity[0]);
    controller.stopping(ros::Time(2.0));
  }
}

TEST_P(PythonControllerTest, CallsStopping) {
  node.setParam("mark", "python_stopping_mark");
  script(R"(
class Law:
  def __init__(self, parameters): self.ended = False
  def starting(self, state, model):
    assert not self.ended or self.ended == 1
    self.begins = 7.0 if self.ended else 3.0
  def update(self, state, model, period): return [self.begins] * 7
  def stopping(self): self.ended = 1
)");
  PythonController controller;
  ASSERT_TRUE(initialize(controller)) << world().errors();
  for (const double expected : {3.0, 7.0}) {
    controller.starting(ros::Time(1.0));
    run(controller, 1);
    EXPECT_EQ(expected, arm.velocity[0]);
    controller.stopping(ros::Time(2.0));
  }
}

TEST_P(PythonControllerTest, LoopNeitherAllocatesNorLocks) {
  law("return [0.0] * 7");
  PythonController controller;
  ASSERT_TRUE(initialize(controller));
  controller.starting(ros::Time(1.0));
  run(controller, 10);
  rt_guard::Scope scope;
  run(controller, 100);
  EXPECT_EQ(0U, scope.allocations());
  EXPECT_EQ(0U, scope.locks());
}

/// Runs a motion that raises after a second, and returns the commands from then on.
TEST_P(PythonControllerTest, BringsJointsToRestWithoutAJump) {
  command({"joint_position"});
  law("\n    t = self.n * 1e-3\n    if self.n > 1000: raise RuntimeError('enough')\n"
      "    return self.q + 0.25 * (1 - np.cos(2.0 * t))",
      "self.q = np.array(state.q_d)");
  PythonController controller;
  ASSERT_TRUE(initialize(controller)) << world().errors();
  controller.starting(ros::Time(1.0));
  std::vector<double> q;
  for (int i = 0; i < 2000; ++i) {
    run(controller, 1);
    q.push_back(arm.position[0]);
  }
  double acceleration_before = 0.0;
  for (std::size_t i = 1; i + 1 < q.size(); ++i) {
    const double acceleration = (q[i + 1] - 2.0 * q[i] + q[i - 1]) / (kPeriod * kPeriod);
    EXPECT_LT(std::abs(acceleration), 5.5)
        << i;  // the stop's 5 rad/s^2, and the fading acceleration
    if (i > 1) {
      // 2000 rad/s^3: a quarter of the Panda's limit.
      EXPECT_LT(std::abs(acceleration - acceleration_before), 2.0) << i;
    }
    acceleration_before = acceleration;
  }
  EXPECT_NEAR(q[q.size() - 1], q[q.size() - 2], 1e-12);
  // v = 0.5 sin 2 = 0.455 rad/s and a = cos 2 = -0.416 rad/s^2 at the end, so T = 1.5 v / 5 s and
  // the distance is the integral of the cubic: v T / 2 + a T^2 / 12.
  const double v = 0.5 * std::sin(2.0);
  const double a = std::cos(2.0);
  const double stop = 1.5 * v / 5.0;
  EXPECT_NEAR(v * stop / 2.0 + a * stop * stop / 12.0, q.back() - q[999], 1e-3);
}

TEST_P(PythonControllerTest, BringsPosesToRestAsPoses) {
  command({"cartesian_pose"});
  law("\n    if self.n > 500: raise RuntimeError('enough')\n"
      "    a = 0.1 * (1 - np.cos(3e-3 * self.n)); c, s = np.cos(a), np.sin(a)\n"
      "    T = np.array(self.T); T[:3, :3] = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]]) @ "
      "T[:3, :3]\n"
      "    T[0, 3] += a\n    return T",
      "self.T = np.array(state.O_T_EE_d)");
  PythonController controller;
  ASSERT_TRUE(initialize(controller)) << world().errors();
  controller.starting(ros::Time(1.0));
  run(controller, 500);
  const double x = arm.pose[12];
  std::vector<double> positions{x};
  for (int i = 0; i < 1000; ++i) {
    run(controller, 1);
    positions.push_back(arm.pose[12]);
    double length = 0.0;
    for (int k = 0; k < 3; ++k) {
      length += arm.pose[k] * arm.pose[k];
    }
    ASSERT_NEAR(1.0, length, 1e-12);
  }
  EXPECT_GT(positions.back(), x);
  EXPECT_NEAR(positions.back(), positions[positions.size() - 2], 1e-12);
  // It turned one rad per meter, like the law.
  const double angle = std::atan2(arm.pose[1], arm.pose[0]);
  EXPECT_NEAR(positions.back() - 0.3, angle, 1e-4);
}

TEST_P(PythonControllerTest, DampsWithTorquesAtALimitedRate) {
  command({"effort"});
  law("return [20.0] * 7 if self.n < 3 else None");
  arm.state.dq.fill(0.1);
  PythonController controller;
  ASSERT_TRUE(initialize(controller));
  controller.starting(ros::Time(1.0));
  run(controller, 2);
  for (int i = 1; i <= 15; ++i) {
    run(controller, 1);
    EXPECT_NEAR(20.0 - i, arm.effort[0], 1e-12);
  }
  run(controller, 30);
  EXPECT_NEAR(-5.0, arm.effort[0], 1e-12) << "50 Nm s/rad at 0.1 rad/s";
}

INSTANTIATE_TEST_SUITE_P(BothTimes, PythonControllerTest, testing::Bool(),
                         [](const auto& info) { return info.param ? "Simulated" : "Hardware"; });

}  // namespace
}  // namespace franka_example_controllers

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "python_controller_test");
  ros::NodeHandle keeps_ros_running;
  ros::AsyncSpinner spinner(2);
  spinner.start();
  return RUN_ALL_TESTS();
}
