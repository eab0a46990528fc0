// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// A joint impedance controller of the user that follows a Cartesian pose: two callbacks and the
// model, while another thread prints the state.
#include <franka/duration.h>
#include <franka/exception.h>
#include <franka/model.h>
#include <franka/rate_limiting.h>
#include <franka/robot.h>

#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <iostream>
#include <mutex>
#include <thread>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "Usage: " << argv[0] << " <robot-hostname>" << std::endl;
    return -1;
  }
  std::atomic_bool running{true};
  std::mutex mutex;
  franka::RobotState shared_state;
  std::thread printer([&] {
    while (running) {
      if (mutex.try_lock()) {
        const double torque = shared_state.tau_J_d[0];
        mutex.unlock();
        if (std::isnan(torque)) {
          std::cout << torque;
        }
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));  // between two looks
    }
  });
  int result = 0;
  try {
    franka::Robot robot(argv[1], franka::RealtimeConfig::kIgnore);
    franka::Model model = robot.loadModel();
    const std::array<double, 7> k_gains = {{600.0, 600.0, 600.0, 600.0, 250.0, 150.0, 50.0}};
    const std::array<double, 7> d_gains = {{50.0, 50.0, 50.0, 50.0, 30.0, 25.0, 15.0}};
    double time = 0.0;
    std::array<double, 16> initial_pose;
    auto cartesian_pose_callback = [&](const franka::RobotState& state,
                                       franka::Duration period) -> franka::CartesianPose {
      time += period.toSec();
      if (time == 0.0) {
        initial_pose = state.O_T_EE_c;
      }
      franka::CartesianPose pose_desired = initial_pose;
      pose_desired.O_T_EE[12] += 0.01 * (1.0 - std::cos(2.0 * M_PI * time));
      return time < 1.0 ? pose_desired : franka::MotionFinished(pose_desired);
    };
    std::function<franka::Torques(const franka::RobotState&, franka::Duration)>
        impedance_control_callback =
            [&](const franka::RobotState& state, franka::Duration) -> franka::Torques {
      const std::array<double, 7> coriolis = model.coriolis(state);
      std::array<double, 7> tau_d_calculated;
      for (size_t i = 0; i < 7; i++) {
        tau_d_calculated[i] =
            k_gains[i] * (state.q_d[i] - state.q[i]) - d_gains[i] * state.dq[i] + coriolis[i];
      }
      const std::array<double, 7> tau_d_rate_limited =
          franka::limitRate(franka::kMaxTorqueRate, tau_d_calculated, state.tau_J_d);
      if (mutex.try_lock()) {
        shared_state = state;
        mutex.unlock();
      }
      return tau_d_rate_limited;
    };
    robot.control(impedance_control_callback, cartesian_pose_callback);
  } catch (const franka::Exception& ex) {
    std::cerr << ex.what() << std::endl;
    result = -1;
  }
  running = false;
  printer.join();
  return result;
}
