// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "control_toolbox/pid_gains_setter.h"

#include <ros/console.h>

#include <cmath>
#include <stdexcept>

namespace control_toolbox {

PidGainsSetter::~PidGainsSetter() { serve_set_gains_.shutdown(); }

PidGainsSetter& PidGainsSetter::add(Pid* pid) {
  if (pid == nullptr) {
    throw std::invalid_argument("PidGainsSetter::add() was given no Pid (a null pointer).");
  }
  pids_.push_back(pid);
  return *this;
}

void PidGainsSetter::advertise(const ros::NodeHandle& n) {
  node_ = n;
  serve_set_gains_ = node_.advertiseService("set_gains", &PidGainsSetter::setGains, this);
}

bool PidGainsSetter::setGains(SetPidGains::Request& req, SetPidGains::Response& /*resp*/) {
  for (const double gain : {req.p, req.i, req.d, req.i_clamp}) {
    if (!std::isfinite(gain)) {
      ROS_ERROR_STREAM("The gains given to " << serve_set_gains_.getService() << " are refused: "
                                             << gain << " is not a finite number.");
      return false;
    }
  }
  const double clamp = std::abs(req.i_clamp);
  for (Pid* pid : pids_) {
    pid->setGains(req.p, req.i, req.d, clamp, -clamp, req.antiwindup != 0);
  }
  node_.setParam("p", req.p);
  node_.setParam("i", req.i);
  node_.setParam("d", req.d);
  node_.setParam("i_clamp", req.i_clamp);
  node_.setParam("antiwindup", req.antiwindup != 0);
  return true;
}

}  // namespace control_toolbox
