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

/// Offers the service `set_gains` (control_toolbox/SetPidGains), which gives several Pids the same
/// gains and writes them to the parameter server.
///
/// Threads: add() and advertise() belong to set-up; the service's callback runs in the thread that
/// spins, and may run beside a control loop that uses the Pids. Not real-time safe.
class PidGainsSetter {
 public:
  /// Withdraws the service.
  ~PidGainsSetter();

  /// Adds one more. @param pid lives longer than this object. @return this object.
  /// @throw std::invalid_argument if `pid` is null.
  PidGainsSetter& add(Pid* pid);

  /// Offers the service in a namespace, into which the gains are also written as p, i, d, i_clamp
  /// and antiwindup.
  void advertise(const ros::NodeHandle& n);
  void advertise(const std::string& ns) { advertise(ros::NodeHandle(ns)); }

  /// The service: the integral term's limits become plus and minus i_clamp, whatever its sign.
  /// @return false, with an error in the log and nothing changed, if a gain is not finite.
  bool setGains(SetPidGains::Request& req, SetPidGains::Response& resp);

 private:
  ros::NodeHandle node_;
  ros::ServiceServer serve_set_gains_;
  std::vector<Pid*> pids_;
};

}  // namespace control_toolbox
