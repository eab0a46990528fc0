// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/to_franka.h>
#include <franka_sim_mujoco/ros/sim_arm.h>

#include <algorithm>
#include <cmath>

namespace franka_sim_mujoco {

namespace {

template <std::size_t N>
void smooth(double alpha, std::array<double, N>& filtered, std::array<double, N>& signal) noexcept {
  for (std::size_t i = 0; i < N; ++i) {
    filtered[i] += alpha * (signal[i] - filtered[i]);
    signal[i] = filtered[i];
  }
}

bool allFinite(const std::array<double, 7>& values) noexcept {
  return std::all_of(values.begin(), values.end(),
                     [](double value) { return std::isfinite(value); });
}

}  // namespace

SimArm::SimArm(const ControlUnitParameters& parameters, ArmPlant& plant, double filter_alpha)
    : unit_(parameters), plant_(plant), filter_alpha_(filter_alpha) {
  unit_.setUserStop(false);
}

void SimArm::read(const ros::Time& time) noexcept {
  franka_core::toFranka(unit_.observe(plant_.measure()), state_);
  state_.time = franka::Duration(time.toNSec() / 1000000);
  if (filter_alpha_ < 1.0) {
    filter();
  }
}

void SimArm::filter() noexcept {
  if (filter_is_fresh_) {
    tau_ext_filtered_ = state_.tau_ext_hat_filtered;
    O_F_ext_filtered_ = state_.O_F_ext_hat_K;
    K_F_ext_filtered_ = state_.K_F_ext_hat_K;
    filter_is_fresh_ = false;
  }
  smooth(filter_alpha_, tau_ext_filtered_, state_.tau_ext_hat_filtered);
  smooth(filter_alpha_, O_F_ext_filtered_, state_.O_F_ext_hat_K);
  smooth(filter_alpha_, K_F_ext_filtered_, state_.K_F_ext_hat_K);
}

void SimArm::write(const std::array<double, 7>& torque) noexcept {
  const franka_core::RobotCommand* command = nullptr;
  if (unit_.state().robot_mode == franka_core::RobotMode::kMove) {
    if (allFinite(torque)) {
      command_.message_id = unit_.state().message_id;
      command_.tau_J_d = torque;
      command = &command_;
    } else {
      refused_commands_.fetch_add(1, std::memory_order_relaxed);
    }
  }
  const std::array<double, 7>& motor_torque = unit_.actuate(command);
  plant_.setBrakes(unit_.brakesClosed());
  plant_.applyTorques(motor_torque);
}

void SimArm::connect() noexcept {
  if (!userStopped()) {
    unit_.startTorqueControl();
  }
}

void SimArm::controlStarts() noexcept {
  claimed_ = true;
  needs_recovery_ = needs_recovery_ && userStopped();
  connect();
}

void SimArm::controlStops() noexcept {
  claimed_ = false;
  unit_.stopMotion();
}

void SimArm::controlRestarts() noexcept {
  if (claimed_ && !needs_recovery_) {
    connect();
  }
}

void SimArm::setUserStop(bool pressed) noexcept {
  if (pressed == userStopped()) {
    return;
  }
  unit_.setUserStop(pressed);
  user_stopped_.store(pressed, std::memory_order_relaxed);
  needs_recovery_ = true;
}

RequestStatus SimArm::recover() noexcept {
  if (userStopped()) {
    return RequestStatus::kNotPossible;
  }
  const RequestStatus status = unit_.automaticErrorRecovery();
  if (status == RequestStatus::kSuccess) {
    needs_recovery_ = false;
  }
  return status;
}

void SimArm::worldWasReset() noexcept {
  unit_.restart();
  filter_is_fresh_ = true;
}

}  // namespace franka_sim_mujoco
