// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_core/robot_state.h>
#include <franka_sim/robot/fixed_pointer.h>
#include <franka_sim/robot/plant.h>

#include <array>
#include <cmath>
#include <cstddef>

#include "robot/configuration.h"
#include "robot/transforms.h"

namespace franka_sim {

/// First-order low-pass filters for N signals sampled once a tick (protocol 5.6). Called by one
/// thread. Real-time safe.
template <std::size_t N>
class LowPass {
 public:
  /// @param cutoff [Hz], positive
  explicit LowPass(double cutoff = kSignalCutoff) noexcept { gains_.fill(gainFor(cutoff)); }
  /// @param cutoffs of each signal [Hz], positive
  explicit LowPass(const std::array<double, N>& cutoffs) noexcept {
    for (std::size_t i = 0; i < N; i++) {
      gains_[i] = gainFor(cutoffs[i]);
    }
  }

  const std::array<double, N>& update(const std::array<double, N>& input) noexcept {
    for (std::size_t i = 0; i < N; i++) {
      output_[i] = gains_[i] * input[i] + (1.0 - gains_[i]) * output_[i];
    }
    return output_;
  }

  const std::array<double, N>& output() const noexcept { return output_; }
  void restart() noexcept { output_.fill(0.0); }

 private:
  static double gainFor(double cutoff) noexcept {
    return kTick / (kTick + 1.0 / (2.0 * 3.14159265358979323846 * cutoff));
  }

  std::array<double, N> gains_{};
  std::array<double, N> output_{};
};

/// Contact and collision of N signals (decision 15). Contact is 1 while lower < |x| <= upper;
/// collision becomes 1 when |x| > upper, and stays until it is cleared. Flags are 0 or 1, as in
/// RobotState. Called by one thread. Real-time safe.
template <std::size_t N>
class ContactMonitor {
 public:
  void update(const std::array<double, N>& values, const std::array<double, N>& lower,
              const std::array<double, N>& upper) noexcept {
    for (std::size_t i = 0; i < N; i++) {
      const double magnitude = std::abs(values[i]);
      contact_[i] = magnitude > lower[i] && magnitude <= upper[i] ? 1.0 : 0.0;
      if (magnitude > upper[i]) {
        collision_[i] = 1.0;
      }
    }
  }

  void clear() noexcept {
    contact_.fill(0.0);
    collision_.fill(0.0);
  }

  const std::array<double, N>& contact() const noexcept { return contact_; }
  const std::array<double, N>& collision() const noexcept { return collision_; }

 private:
  std::array<double, N> contact_{};
  std::array<double, N> collision_{};
};

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

/// Wrench at the stiffness frame K from joint torques (decision 5): the undamped pseudo-inverse of
/// J^T, F = (J J^T)^-1 J tau. Where the arm is singular (smallest singular value of J below 0.02)
/// the wrench is not observable and zero is shown. Forces first [N], then moments about the origin
/// of K [Nm]. Called by one thread. Real-time safe.
class ExternalWrench {
 public:
  /// Computes the map for the present pose.
  /// @param O_T_EE pose of the end effector @param J_EE its zero Jacobian in O, 6x7 column-major
  void update(const Transform& O_T_EE, const std::array<double, 42>& J_EE,
              const Transform& EE_T_K) noexcept;

  /// The wrench in the axes of O.
  std::array<double, 6> inBase(const std::array<double, 7>& tau) const noexcept;
  /// The same wrench in the axes of K.
  std::array<double, 6> inStiffness(const std::array<double, 6>& O_F) const noexcept;

  bool singular() const noexcept { return singular_; }

 private:
  bool singular_{true};
  std::array<double, 42> jacobian_{};  // of K in O, 6x7 column-major
  std::array<double, 36> factor_{};    // Cholesky's, of J J^T; the lower triangle, column-major
  std::array<double, 9> O_R_K_{};      // column-major
};

/// Readings of accelerometers on both sides of joints 1 to 6 [m/s^2].
struct LinkAccelerations {
  std::array<std::array<double, 3>, 6> top{}, bottom{};
};

/// Readings of accelerometers at the joints' origins: acceleration minus gravity, so that a sensor
/// at rest reads 9.81 upwards. The real positions and axes are not published; here the lower sensor
/// of joint i sits on link i - 1 and the upper one on link i, both at the joint's origin and in the
/// axes of their link's frame. Real-time safe.
/// @param q, dq, ddq [rad, rad/s, rad/s^2] @param gravity_earth in O [m/s^2]
LinkAccelerations linkAccelerations(const franka_core::ArmModel& model,
                                    const std::array<double, 7>& q, const std::array<double, 7>& dq,
                                    const std::array<double, 7>& ddq,
                                    const std::array<double, 3>& gravity_earth) noexcept;

/// Estimates from the measurements that are not part of the state.
struct Estimate {
  bool first{true};            ///< the first sample since the start or a restart
  bool measured{false};        ///< this sample continues a finite one: rates and torques are valid
  std::array<double, 7> dq{};  ///< without the noise of the reported one [rad/s]
  std::array<double, 7> tau_J{};        ///< likewise [Nm]
  franka_core::ArmDynamics dynamics{};  ///< of frame EE
  std::array<double, 7> tau_ext{};      ///< unfiltered [Nm]
  std::array<double, 6> wrench{};       ///< unfiltered, in the axes of the thresholds [N, Nm]
  std::array<double, 6> O_dP_EE{};      ///< measured twist of EE in O [m/s, rad/s]
};

/// From measurement to state: poses, torques, external torques and wrenches, contacts,
/// accelerations. Writes the measured fields of the robot's state.
///
/// Called by one thread. Real-time safe. Exception: the constructor.
class StateEstimator {
 public:
  /// @param configuration, state outlive the estimator.
  StateEstimator(const Configuration& configuration, franka_core::RobotState& state) noexcept;

  /// One tick. The first sample after the start or a restart has no motor torques of a previous
  /// tick: tau_J is then gravity, as the sensor of a resting arm measures, and the external torque
  /// is 0. A sample that is not finite is replaced by the last finite pose at rest.
  /// @param thresholds of this tick
  void update(const ArmMeasurement& measurement, const CollisionThresholds& thresholds) noexcept;

  const Estimate& estimate() const noexcept { return estimate_; }
  /// Whether there was a measurement since the start or a restart.
  bool started() const noexcept { return started_; }

  /// Clears latched collisions.
  void clearContacts() noexcept;
  /// The arm was moved to another pose: clears velocities, filters and collisions.
  void restart() noexcept;

 private:
  void updateTorques(const ArmMeasurement& measurement) noexcept;
  void updateContacts(const CollisionThresholds& thresholds) noexcept;
  void updateAccelerometers(const std::array<double, 7>& dq_before) noexcept;

  FixedPointer<const Configuration> configuration_;
  FixedPointer<franka_core::RobotState> state_;
  Estimate estimate_;
  bool started_{false};
  bool continuous_{false};  // the last sample was finite and of the same motion
  SensorNoise noise_;
  ExternalTorque external_torque_;
  ExternalWrench external_wrench_;
  LowPass<7> tau_ext_filter_, dtau_J_filter_;
  /// Of the torques that become the wrench, all at the joints' mean bandwidth: the wrench of
  /// torques with different delays would be later than each of them.
  LowPass<7> wrench_filter_;
  ContactMonitor<7> joint_contacts_;
  ContactMonitor<6> cartesian_contacts_;
};

}  // namespace franka_sim
