// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "control_toolbox/pid.h"

#include <ros/console.h>
#include <ros/time.h>

#include <algorithm>
#include <cmath>

#include "pid_reconfigure.h"

namespace control_toolbox {

Pid::Pid(double p, double i, double d, double i_max, double i_min, bool antiwindup)
    : gains_(Gains(p, i, d, i_max, i_min, antiwindup)) {}

Pid::Pid(const Pid& source) noexcept : gains_(source.gains_.get()) {}

Pid& Pid::operator=(const Pid& source) {
  if (this != &source) {
    setGains(source.gains_.get());
    reset();
  }
  return *this;
}

Pid::~Pid() = default;

void Pid::initPid(double p, double i, double d, double i_max, double i_min, bool antiwindup) {
  setGains(p, i, d, i_max, i_min, antiwindup);
  reset();
}

void Pid::reset() noexcept {
  reset(0.0, 0.0);
  error_last_valid_ = true;
}

void Pid::reset(double d_error, double i_error) noexcept {
  p_error_last_ = 0.0;
  p_error_ = 0.0;
  i_error_ = i_error;
  d_error_ = d_error;
  cmd_ = 0.0;
  error_last_valid_ = false;
}

void Pid::getGains(double& p, double& i, double& d, double& i_max, double& i_min) {
  bool antiwindup;
  getGains(p, i, d, i_max, i_min, antiwindup);
}

void Pid::getGains(double& p, double& i, double& d, double& i_max, double& i_min,
                   bool& antiwindup) {
  const Gains gains = getGains();
  p = gains.p_gain_;
  i = gains.i_gain_;
  d = gains.d_gain_;
  i_max = gains.i_max_;
  i_min = gains.i_min_;
  antiwindup = gains.antiwindup_;
}

Pid::Gains Pid::getGains() { return gains_.get(); }

void Pid::setGains(double p, double i, double d, double i_max, double i_min, bool antiwindup) {
  setGains(Gains(p, i, d, i_max, i_min, antiwindup));
}

void Pid::setGains(const Gains& gains) {
  gains_.set(gains);
  updateDynamicReconfig(gains);
}

double Pid::computeCommand(double error, ros::Duration dt) {
  if (dt.isZero() || !std::isfinite(error)) {
    return 0.0;
  }
  return computeCommand(error, derivative(error, dt), dt);
}

double Pid::computeCommand(double error, double error_dot, ros::Duration dt) {
  p_error_ = error;
  d_error_ = error_dot;
  if (dt.isZero() || !std::isfinite(error) || !std::isfinite(error_dot)) {
    return 0.0;
  }
  const Gains gains = gains_.get();
  const double i_term = integralTerm(gains, error, dt);
  cmd_ = gains.p_gain_ * p_error_ + i_term + gains.d_gain_ * d_error_;
  publishState(gains, i_term, dt);
  return cmd_;
}

double Pid::updatePid(double p_error, ros::Duration dt) { return -computeCommand(p_error, dt); }

double Pid::updatePid(double error, double error_dot, ros::Duration dt) {
  return -computeCommand(error, error_dot, dt);
}

void Pid::setCurrentCmd(double cmd) { cmd_ = cmd; }

double Pid::getCurrentCmd() { return cmd_; }

void Pid::getCurrentPIDErrors(double* pe, double* ie, double* de) {
  *pe = p_error_;
  *ie = i_error_;
  *de = d_error_;
}

void Pid::printValues() {
  const Gains gains = getGains();
  ROS_INFO_STREAM("PID gains: p " << gains.p_gain_ << ", i " << gains.i_gain_ << ", d "
                                  << gains.d_gain_ << ", integral term within [" << gains.i_min_
                                  << ", " << gains.i_max_ << "]"
                                  << (gains.antiwindup_ ? ", antiwindup" : "") << "; error "
                                  << p_error_ << ", integral " << i_error_ << ", derivative "
                                  << d_error_ << "; command " << cmd_);
}

double Pid::derivative(double error, ros::Duration dt) {
  if (dt.toSec() < 0.0) {
    return d_error_;
  }
  const double result = error_last_valid_ ? (error - p_error_last_) / dt.toSec() : d_error_;
  p_error_last_ = error;
  error_last_valid_ = true;
  return result;
}

double Pid::integralTerm(const Gains& gains, double error, ros::Duration dt) {
  i_error_ += dt.toSec() * error;
  if (gains.antiwindup_ && gains.i_gain_ != 0.0) {
    // A negative gain swaps the limits.
    const double one = gains.i_min_ / gains.i_gain_;
    const double other = gains.i_max_ / gains.i_gain_;
    i_error_ = std::max(std::min(one, other), std::min(i_error_, std::max(one, other)));
  }
  const double i_term = gains.i_gain_ * i_error_;
  if (gains.antiwindup_) {
    return i_term;
  }
  return std::max(gains.i_min_, std::min(i_term, gains.i_max_));
}

void Pid::publishState(const Gains& gains, double i_term, ros::Duration dt) {
  if (!state_publisher_ || !state_publisher_->trylock()) {
    return;
  }
  control_msgs::PidState& state = state_publisher_->msg_;
  state.header.stamp = ros::Time::now();
  state.timestep = dt;
  state.error = p_error_;
  state.error_dot = d_error_;
  state.p_error = p_error_;
  state.i_error = i_error_;
  state.d_error = d_error_;
  state.p_term = gains.p_gain_ * p_error_;
  state.i_term = i_term;
  state.d_term = gains.d_gain_ * d_error_;
  state.i_max = gains.i_max_;
  state.i_min = gains.i_min_;
  state.output = cmd_;
  state_publisher_->unlockAndPublish();
}

}  // namespace control_toolbox
