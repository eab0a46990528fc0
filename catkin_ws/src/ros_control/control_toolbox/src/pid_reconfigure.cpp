// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "pid_reconfigure.h"

namespace control_toolbox {

namespace {

ParametersConfig configOf(const Pid::Gains& gains) {
  ParametersConfig config;
  config.p = gains.p_gain_;
  config.i = gains.i_gain_;
  config.d = gains.d_gain_;
  config.i_clamp_max = gains.i_max_;
  config.i_clamp_min = gains.i_min_;
  config.antiwindup = gains.antiwindup_;
  return config;
}

}  // namespace

Pid::Reconfigure::Reconfigure(const ros::NodeHandle& node, const ParametersConfig& config, Pid* pid)
    : server_(mutex_, node) {
  server_.updateConfig(config);
  server_.setCallback([pid](ParametersConfig& changed, std::uint32_t level) {
    pid->dynamicReconfigCallback(changed, level);
  });
}

void Pid::Reconfigure::update(const ParametersConfig& config) { server_.updateConfig(config); }

void Pid::initDynamicReconfig(ros::NodeHandle& node) {
  // The old server must withdraw its service before the new one offers it.
  reconfigure_.reset();
  reconfigure_ = std::make_unique<Reconfigure>(node, configOf(getGains()), this);
}

void Pid::updateDynamicReconfig() { updateDynamicReconfig(getGains()); }

void Pid::updateDynamicReconfig(Gains gains_config) {
  if (reconfigure_) {
    reconfigure_->update(configOf(gains_config));
  }
}

void Pid::updateDynamicReconfig(ParametersConfig config) {
  if (reconfigure_) {
    reconfigure_->update(config);
  }
}

void Pid::dynamicReconfigCallback(ParametersConfig& config, std::uint32_t /* level */) {
  // Only the gains: the server itself publishes the configuration that it passed here.
  gains_.set(Gains(config.p, config.i, config.d, config.i_clamp_max, config.i_clamp_min,
                   config.antiwindup));
}

}  // namespace control_toolbox
