// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <transmission_interface/transmission_loader.h>

#include <string>
#include <vector>

namespace transmission_interface {
namespace internal {

/// Reads the descriptions of transmissions with two actuators and two joints. Actuators have the
/// `<role>` actuator1 or actuator2 and a `<mechanicalReduction>`; joints have the `<role>` joint1
/// or joint2 and optionally a `<mechanicalReduction>` (default 1) and an `<offset>`.
class PairTransmissionLoader : public TransmissionLoader {
 protected:
  /// Values in the order of the roles, independent of the description's order.
  struct Config {
    std::vector<double> actuator_reduction{0.0, 0.0};
    std::vector<double> joint_reduction{1.0, 1.0};
    std::vector<double> joint_offset{0.0, 0.0};
    bool ignores_absolute_encoders{false};  ///< requested by both joints
  };

  /// @returns false, with a sentence in the log, if the description is invalid.
  static bool readConfig(const TransmissionInfo& info, Config& config);

 private:
  static bool readActuators(const TransmissionInfo& info, Config& config);
  static bool readJoints(const TransmissionInfo& info, Config& config);
};

}  // namespace internal
}  // namespace transmission_interface
