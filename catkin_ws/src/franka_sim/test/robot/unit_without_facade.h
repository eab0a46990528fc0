// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/configuration.h>
#include <franka_sim/robot/state_estimator.h>

#include <array>

#include "fci_fixture.h"

namespace franka_sim::test {

/// Configuration, state and estimator of a control unit, without the unit around them.
class UnitWithoutFacade : public ::testing::Test {
 protected:
  static ControlUnitParameters overFci() {
    ControlUnitParameters parameters = pandaWithHand();
    parameters.rules = InterfaceRules::kFci;
    return parameters;
  }

  void measure(const std::array<double, 7>& q) {
    ArmMeasurement measurement;
    measurement.q = q;
    measurement.tau_J = estimator.estimate().dynamics.gravity;
    estimator.update(measurement, configuration.parameters().nominal);
  }

  Configuration configuration{overFci()};
  franka_core::RobotState state;
  StateEstimator estimator{configuration, state};
};

}  // namespace franka_sim::test
