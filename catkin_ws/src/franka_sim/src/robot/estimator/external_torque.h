// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_sim/robot/plant.h>

#include <array>

namespace franka_sim {

/// External joint torque: the measured torque minus that of the motion's model (decision 3),
///   tau_ext = tau_J - [M(q) a + c(q, dq) + g(q)],  a = (dq_k - dq_{k-1}) / T.
///
/// tau_J is a mean over the tick. With n physics substeps the plant evaluates its dynamics at the
/// start of each; their mean lies at alpha = (n - 1) / (2 n) of the tick, so the model is evaluated
/// there. With one step that is the start of the tick, whose model was computed in the tick before.
/// The robot's own force counts positive: an outside force F on the arm reads -J^T F
/// (decision 4). Called by one thread. Real-time safe.
class ExternalTorque {
 public:
  /// @param payload the configured one @param gravity_earth in O [m/s^2]
  /// @param now sensors at the end of the tick @param dynamics of the model there, with this
  /// payload and gravity @returns tau_ext over the last tick [Nm], zero without a previous sample
  std::array<double, 7> update(const franka_core::ArmModel& model,
                               const franka_core::Payload& payload,
                               const std::array<double, 3>& gravity_earth,
                               const ArmMeasurement& now,
                               const franka_core::ArmDynamics& dynamics) noexcept;

  /// Restarts from this sample: motor torques do not explain the motion before it.
  void restart(const franka_core::Payload& payload, const ArmMeasurement& now,
               const franka_core::ArmDynamics& dynamics) noexcept;

 private:
  std::array<double, 7> atStart(const std::array<double, 7>& ddq) const noexcept;

  bool has_previous_{false};
  std::array<double, 7> q_{}, dq_{};
  franka_core::Payload payload_;
  std::array<double, 49> mass_{};     ///< at the last sample [kg m^2]
  std::array<double, 7> constant_{};  ///< torques without acceleration there [Nm]
};

}  // namespace franka_sim
