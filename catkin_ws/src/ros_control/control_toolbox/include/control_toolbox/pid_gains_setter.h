// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>

#include <string>
#include <vector>

#include "control_toolbox/SetPidGains.h"
#include "control_toolbox/pid.h"

namespace control_toolbox {

/// Offers the service `set_gains` (control_toolbox/SetPidGains), which sets the same gains in
/// several Pids and on the parameter server.
///
/// Threads: add() and advertise() are for set-up; the service's callback runs in the spinning
/// thread, also while a control loop uses the Pids. Not real-time safe.
class PidGainsSetter {
 public:
  /// Withdraws the service.
  ~PidGainsSetter();

  /// Adds a Pid. @param pid must outlive this object. @return this object.
  /// @throw std::invalid_argument if `pid` is null.
  PidGainsSetter& add(Pid* pid);

  /// Offers the service in a namespace, where the gains are also written as p, i, d, i_clamp and
  /// antiwindup.
  void advertise(const ros::NodeHandle& n);
  void advertise(const std::string& ns) { advertise(ros::NodeHandle(ns)); }

  /// The service: sets the integral term's limits to plus and minus |i_clamp|.
  /// @return false, with an error in the log and without changes, if a gain is not finite.
  bool setGains(SetPidGains::Request& req, SetPidGains::Response& resp);

 private:
  ros::NodeHandle node_;
  ros::ServiceServer serve_set_gains_;
  std::vector<Pid*> pids_;
};

}  // namespace control_toolbox
