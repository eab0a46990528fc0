// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
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

}  // namespace franka_sim
