// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/plant.h>

#include <array>
#include <cstdint>
#include <random>
#include <string>

namespace franka_sim {

/// Which properties of a real robot a simulated one has (docs/fidelity.md). Their figures are in
/// franka_description's physics.yaml.
struct Realism {
  bool motors{false};       ///< the published apparent inertias instead of 0.1 kg m^2
  bool friction{false};     ///< of the joints
  bool bandwidth{false};    ///< tau_ext_hat_filtered and the wrenches at about 3 Hz, not 100 Hz
  bool gripper{false};      ///< latency of the hand
  bool noise{false};        ///< noise and resolution of tau_J and dq
  bool model_error{false};  ///< links and torque sensors differ from the robot's own model
  unsigned delay{0};        ///< of commands [ms]
  std::uint64_t seed{1};    ///< of noise and model error: the same seed, the same robot
  std::string file;         ///< figures of one's own robot, which replace those of physics.yaml
};

/// Whether robots of both behave in the same way: seeds count only where something is drawn.
bool haveSameBehavior(const Realism& one, const Realism& other);

/// Longest delay of commands [ms].
constexpr unsigned kMaxCommandDelay = 20;

/// Default profiles: of robots on the network, and of robots that are driven by the process that
/// simulates them.
constexpr const char* kServedProfile = "real";
constexpr const char* kInProcessProfile = "ideal";  ///< robots under ros_control

/// Reads `[PROFILE][,NAME=VALUE]...`: a profile (ideal, real or recorded), then changes of it:
/// motors, friction, bandwidth, gripper, noise and model_error =on or =off, delay=0 to 20 [ms],
/// seed=NUMBER, file=NAME.
/// @param profile if the text names none @throws std::invalid_argument with a sentence
Realism readRealism(const std::string& text, const char* profile);

/// Errors of the robot's sensors, joints 1 to 7 (docs/fidelity.md).
struct SensorPhysics {
  /// Of the first-order filter of tau_ext_hat_filtered [Hz].
  std::array<double, 7> tau_ext_cutoff{{kSignalCutoff, kSignalCutoff, kSignalCutoff, kSignalCutoff,
                                        kSignalCutoff, kSignalCutoff, kSignalCutoff}};
  std::array<double, 7> tau_J_resolution{};  ///< [Nm]; 0: continuous
  std::array<double, 7> tau_J_noise{};       ///< standard deviation before rounding [Nm]
  std::array<double, 7> dq_noise{};          ///< standard deviation [rad/s]
  std::array<double, 7> tau_J_ripple{};      ///< of the elastic gears in motion, RMS [Nm]
  std::array<double, 7> ripple_frequency{};  ///< [Hz]
  std::uint64_t seed{1};                     ///< of the noise
};

/// White noise and resolution of the readings of torque and velocity that the robot reports, and
/// the ripple of tau_J in motion: a sine, whose amplitude grows with the speed up to 0.05 rad/s.
/// The robot's own loops use the signals without them: how it filters those is not published.
/// Called by one thread. Real-time safe.
class SensorNoise {
 public:
  explicit SensorNoise(const SensorPhysics& physics) noexcept;

  /// Measured torques with noise, ripple and resolution [Nm]. @param dq measured [rad/s]
  std::array<double, 7> torques(const std::array<double, 7>& tau_J,
                                const std::array<double, 7>& dq) noexcept;
  /// Measured velocities with noise [rad/s].
  std::array<double, 7> velocities(const std::array<double, 7>& dq) noexcept;
  /// Repeats the same noise from the start.
  void restart() noexcept;

 private:
  std::array<double, 7> noisy(std::array<double, 7> values,
                              const std::array<double, 7>& deviation) noexcept;

  SensorPhysics physics_;
  bool noisy_torque_, noisy_velocity_;
  std::uint64_t ticks_{0};
  std::mt19937_64 engine_;
  std::normal_distribution<double> normal_;
};

}  // namespace franka_sim
