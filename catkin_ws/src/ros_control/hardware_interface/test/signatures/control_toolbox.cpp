// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <control_toolbox/pid.h>
#include <control_toolbox/pid_gains_setter.h>

#include "signature.h"

using control_toolbox::Pid;
using control_toolbox::PidGainsSetter;

EXPECT_TYPE(Pid::Gains, Pid::Gains(1.0, 2.0, 3.0, 4.0, -4.0, true));
EXPECT_TYPE(Pid, Pid(1.0, 2.0, 3.0, 4.0, -4.0, true));
EXPECT_TYPE(void, of<Pid>().initPid(1.0, 2.0, 3.0, 4.0, -4.0, true));
EXPECT_TYPE(void, of<Pid>().initPid(1.0, 2.0, 3.0, 4.0, -4.0, of<const ros::NodeHandle>()));
EXPECT_TYPE(bool, of<Pid>().init(of<const ros::NodeHandle>(), true));
EXPECT_TYPE(void, of<Pid>().initDynamicReconfig(of<ros::NodeHandle>()));
EXPECT_TYPE(void, of<Pid>().getGains(of<double>(), of<double>(), of<double>(), of<double>(),
                                     of<double>()));
EXPECT_TYPE(void, of<Pid>().setGains(Pid::Gains()));
EXPECT_TYPE(void, of<Pid>().updateDynamicReconfig());
EXPECT_TYPE(void, of<Pid>().updateDynamicReconfig(Pid::Gains()));
EXPECT_TYPE(void, of<Pid>().updateDynamicReconfig(of<control_toolbox::ParametersConfig>()));
EXPECT_TYPE(void, of<Pid>().dynamicReconfigCallback(of<control_toolbox::ParametersConfig>(), 0u));
EXPECT_TYPE(void, of<Pid>().setCurrentCmd(1.0));
EXPECT_TYPE(void, of<Pid>().printValues());
EXPECT_TYPE(void, of<PidGainsSetter>().advertise(of<const ros::NodeHandle>()));
