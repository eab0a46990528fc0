// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <control_toolbox/dither.h>
#include <control_toolbox/filters.h>
#include <control_toolbox/pid.h>
#include <control_toolbox/pid_gains_setter.h>
#include <control_toolbox/sine_sweep.h>
#include <control_toolbox/sinusoid.h>

#include <string>

#include "signature.h"

using control_toolbox::Pid;
using control_toolbox::PidGainsSetter;

EXPECT_TYPE(Pid::Gains, Pid::Gains());
EXPECT_TYPE(Pid::Gains, Pid::Gains(1.0, 2.0, 3.0, 4.0, -4.0));
EXPECT_TYPE(Pid::Gains, Pid::Gains(1.0, 2.0, 3.0, 4.0, -4.0, true));
EXPECT_TYPE(double&, (of<Pid::Gains>().p_gain_));
EXPECT_TYPE(double&, (of<Pid::Gains>().i_gain_));
EXPECT_TYPE(double&, (of<Pid::Gains>().d_gain_));
EXPECT_TYPE(double&, (of<Pid::Gains>().i_max_));
EXPECT_TYPE(double&, (of<Pid::Gains>().i_min_));
EXPECT_TYPE(bool&, (of<Pid::Gains>().antiwindup_));

static_assert(std::is_default_constructible<Pid>::value, "");
static_assert(std::is_copy_constructible<Pid>::value, "");
static_assert(std::is_copy_assignable<Pid>::value, "");
EXPECT_TYPE(Pid, Pid(1.0, 2.0, 3.0, 4.0, -4.0, true));
EXPECT_TYPE(void, of<Pid>().initPid(1.0, 2.0, 3.0, 4.0, -4.0));
EXPECT_TYPE(void, of<Pid>().initPid(1.0, 2.0, 3.0, 4.0, -4.0, true));
EXPECT_TYPE(void, of<Pid>().initPid(1.0, 2.0, 3.0, 4.0, -4.0, of<const ros::NodeHandle>()));
EXPECT_TYPE(void, of<Pid>().initPid(1.0, 2.0, 3.0, 4.0, -4.0, true, of<const ros::NodeHandle>()));
EXPECT_TYPE(bool, of<Pid>().initParam(std::string()));
EXPECT_TYPE(bool, of<Pid>().initParam(std::string(), true));
EXPECT_TYPE(bool, of<Pid>().init(of<const ros::NodeHandle>()));
EXPECT_TYPE(bool, of<Pid>().init(of<const ros::NodeHandle>(), true));
EXPECT_TYPE(bool, of<Pid>().initXml(of<TiXmlElement*>()));
EXPECT_TYPE(void, of<Pid>().initDynamicReconfig(of<ros::NodeHandle>()));
EXPECT_TYPE(void, of<Pid>().reset());
EXPECT_TYPE(void, of<Pid>().reset(1.0, 2.0));
EXPECT_TYPE(void, of<Pid>().getGains(of<double>(), of<double>(), of<double>(), of<double>(),
                                     of<double>()));
EXPECT_TYPE(void, of<Pid>().getGains(of<double>(), of<double>(), of<double>(), of<double>(),
                                     of<double>(), of<bool>()));
EXPECT_TYPE(Pid::Gains, of<Pid>().getGains());
EXPECT_TYPE(void, of<Pid>().setGains(1.0, 2.0, 3.0, 4.0, -4.0));
EXPECT_TYPE(void, of<Pid>().setGains(1.0, 2.0, 3.0, 4.0, -4.0, true));
EXPECT_TYPE(void, of<Pid>().setGains(Pid::Gains()));
EXPECT_TYPE(void, of<Pid>().updateDynamicReconfig());
EXPECT_TYPE(void, of<Pid>().updateDynamicReconfig(Pid::Gains()));
EXPECT_TYPE(void, of<Pid>().updateDynamicReconfig(of<control_toolbox::ParametersConfig>()));
EXPECT_TYPE(void, of<Pid>().dynamicReconfigCallback(of<control_toolbox::ParametersConfig>(), 0u));
EXPECT_TYPE(double, of<Pid>().computeCommand(1.0, ros::Duration()));
EXPECT_TYPE(double, of<Pid>().computeCommand(1.0, 2.0, ros::Duration()));
EXPECT_TYPE(void, of<Pid>().setCurrentCmd(1.0));
EXPECT_TYPE(double, of<Pid>().getCurrentCmd());
EXPECT_TYPE(void, of<Pid>().getCurrentPIDErrors(of<double*>(), of<double*>(), of<double*>()));
EXPECT_TYPE(void, of<Pid>().printValues());

EXPECT_TYPE(PidGainsSetter&, PidGainsSetter().add(of<Pid*>()));
EXPECT_TYPE(void, of<PidGainsSetter>().advertise(of<const ros::NodeHandle>()));
EXPECT_TYPE(void, of<PidGainsSetter>().advertise(std::string()));
EXPECT_TYPE(bool, of<PidGainsSetter>().setGains(of<control_toolbox::SetPidGains::Request>(),
                                                of<control_toolbox::SetPidGains::Response>()));

EXPECT_TYPE(bool, control_toolbox::Dither().init(1.0, 2.0));
EXPECT_TYPE(double, control_toolbox::Dither().update());
EXPECT_TYPE(bool, control_toolbox::SineSweep().init(1.0, 2.0, 3.0, 4.0));
EXPECT_TYPE(double, control_toolbox::SineSweep().update(1.0));
EXPECT_TYPE(double, control_toolbox::Sinusoid().update(1.0, of<double>(), of<double>()));
EXPECT_TYPE(control_toolbox::Sinusoid, control_toolbox::Sinusoid(1.0, 2.0, 3.0, 4.0));
EXPECT_TYPE(double, filters::clamp(1.0, 2.0, 3.0));
EXPECT_TYPE(double, filters::exponentialSmoothing(1.0, 2.0, 0.5));
