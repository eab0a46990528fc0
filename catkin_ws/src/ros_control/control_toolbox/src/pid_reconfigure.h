// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dynamic_reconfigure/server.h>

#include <boost/thread/recursive_mutex.hpp>

#include "control_toolbox/pid.h"

namespace control_toolbox {

/// The dynamic reconfigure server of one Pid. Not real-time safe.
class Pid::Reconfigure {
 public:
  /// Starts with `config`, then passes every change to `pid`, which must outlive it.
  Reconfigure(const ros::NodeHandle& node, const ParametersConfig& config, Pid* pid);

  /// Shows values that were not set through the server.
  void update(const ParametersConfig& config);

 private:
  // The server keeps a reference: the mutex is declared first and destroyed last.
  boost::recursive_mutex mutex_;
  dynamic_reconfigure::Server<ParametersConfig> server_;
};

}  // namespace control_toolbox
