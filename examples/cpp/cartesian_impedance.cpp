// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/model.h>

#include "cartesian.h"
#include "common.h"

namespace {
constexpr char kDescription[] =
    "A torque controller: a spring and a damper hold the end effector, which yields when it "
    "is pushed.";
}  // namespace

int main(int argc, char** argv) {
  return example::run(argc, argv, kDescription, [](const std::string& address) {
    franka::Robot robot = example::ready(address);
    const franka::Model model = robot.loadModel();
    const example::Vector6 stiffness =
        (example::Vector6() << 200, 200, 200, 20, 20, 20).finished();  // [N/m, Nm/rad]
    const example::Vector6 damping =
        (example::Vector6() << 50, 50, 50, 9, 9, 9).finished();  // [Ns/m, Nms/rad]
    const Eigen::Isometry3d goal = example::toPose(robot.readOnce().O_T_EE_d);
    double time = 0, farthest = 0;
    std::printf("push the hand within ten seconds\n");
    std::fflush(stdout);
    robot.control([&](const franka::RobotState& state, franka::Duration period) {
      time += period.toSec();
      const std::array<double, 42> columns = model.zeroJacobian(franka::Frame::kEndEffector, state);
      const Eigen::Map<const Eigen::Matrix<double, 6, 7>> jacobian(columns.data());
      const std::array<double, 7> coriolis = model.coriolis(state);
      const example::Vector6 error = example::difference(goal, example::toPose(state.O_T_EE));
      const example::Vector6 velocity = jacobian * example::Vector7::Map(state.dq.data());
      const example::Vector6 wrench =
          stiffness.cwiseProduct(error) - damping.cwiseProduct(velocity);
      franka::Torques command({0, 0, 0, 0, 0, 0, 0});
      example::Vector7::Map(command.tau_J.data()) =
          jacobian.transpose() * wrench + example::Vector7::Map(coriolis.data());
      farthest = std::max(farthest, error.head<3>().norm());
      return time < 10 ? command : franka::MotionFinished(command);
    });
    std::printf("yielded %.4f\n", farthest);
  });
}
