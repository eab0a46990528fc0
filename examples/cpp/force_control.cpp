// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/model.h>

#include "cartesian.h"
#include "common.h"

namespace {

constexpr char kDescription[] =
    "Goes down until the hand touches something firm, then presses on it with a force: a "
    "controller of the measured external force with an integrator. Springs hold the hand in "
    "all other directions.";

using example::Vector6;
using example::Vector7;
using Matrix6x7 = Eigen::Matrix<double, 6, 7>;

// The vertical force between the hand and what it touches [N].
double contactForce(const franka::RobotState& state) { return std::abs(state.O_F_ext_hat_K[2]); }

void goDownUntilContact(franka::Robot& robot) {
  constexpr double kSpeed = 0.02, kRamp = 0.3, kContact = 4;  // [m/s] [s] [N]
  double time = 0, end = 20;                                  // [s]
  robot.control([&](const franka::RobotState& state, franka::Duration period) {
    time += period.toSec();
    if (contactForce(state) > kContact && time > kRamp) {
      end = std::min(end, time);
    }
    const double speed =
        kSpeed * example::smooth(time, kRamp) * (1 - example::smooth(time - end, kRamp));
    const franka::CartesianVelocities command({0, 0, -speed, 0, 0, 0});
    return time < end + kRamp ? command : franka::MotionFinished(command);
  });
}

}  // namespace

int main(int argc, char** argv) {
  return example::run(argc, argv, kDescription, [](const std::string& address) {
    franka::Robot robot = example::ready(address);
    const franka::Model model = robot.loadModel();
    goDownUntilContact(robot);

    constexpr double kForce = 10, kDuration = 6;    // [N] [s]
    constexpr double kGain = 0.3, kIntegral = 1.5;  // [-] [1/s]
    const Vector6 stiffness = (Vector6() << 600, 600, 0, 40, 40, 40).finished();
    const Vector6 damping = (Vector6() << 50, 50, 80, 12, 12, 12).finished();
    const Eigen::Isometry3d goal = example::toPose(robot.readOnce().O_T_EE);
    double time = 0, integral = 0, pressed = 0;
    robot.control([&](const franka::RobotState& state, franka::Duration period) {
      time += period.toSec();
      const double desired = kForce * example::smooth(time, 1);
      pressed = contactForce(state);
      integral += kIntegral * (desired - pressed) * period.toSec();
      integral = std::clamp(integral, -kForce, kForce);

      const std::array<double, 42> columns = model.zeroJacobian(franka::Frame::kEndEffector, state);
      const Matrix6x7 jacobian = Matrix6x7::Map(columns.data());
      const Vector6 velocity = jacobian * Vector7::Map(state.dq.data());
      const Vector6 error = example::difference(goal, example::toPose(state.O_T_EE));
      Vector6 wrench = stiffness.cwiseProduct(error) - damping.cwiseProduct(velocity);
      wrench[2] -= desired + kGain * (desired - pressed) + integral;
      const std::array<double, 7> coriolis = model.coriolis(state);
      franka::Torques command({0, 0, 0, 0, 0, 0, 0});
      Vector7::Map(command.tau_J.data()) =
          jacobian.transpose() * wrench + Vector7::Map(coriolis.data());
      return time < kDuration ? command : franka::MotionFinished(command);
    });
    std::printf("pressed %.3f\n", pressed);
  });
}
