// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/simulation/policy_actions.h>
#include <franka_sim/simulation/simulation.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace franka_sim {

/// Episodes in which a learned policy acts on the robots of a simulation: what a step of the policy
/// does, and what it observes. pyfranka.gym makes tasks of it. Called by one thread.
class PolicyEpisode {
 public:
  /// Fixed for all episodes.
  struct Setting {
    PolicyControl control{PolicyControl::kCartesianDelta};  ///< kind of the actions
    bool hands{false};                                      ///< whether the policy drives the hands
    std::string body;           ///< the object that is observed; empty: none
    PolicyWorkspace workspace;  ///< of the targets
  };

  /// @param simulation outlives the episode
  /// @throws std::runtime_error without such a body or hand
  PolicyEpisode(Simulation& simulation, const Setting& setting);

  /// Numbers of an action: of each arm, and of its hand.
  std::size_t actionSize() const noexcept;
  /// Numbers of an observation. For each robot: q, dq, position of the end effector in the world
  /// and its x and y axis, and with hands the width between the fingers. Of the body: position,
  /// quaternion w, x, y, z with w not negative, mean velocity of the last step, and whether each
  /// robot, and anything else, touches it (0 or 1).
  std::size_t observationSize() const noexcept;

  /// Call after the simulation was reset: begins an episode.
  void restart();
  /// Applies an action; then the simulation is stepped. @param action actionSize() numbers in [-1,
  /// 1]
  /// @param seconds for how long @throws RequestRefused if a robot cannot start a motion
  void apply(const double* action, double seconds);
  /// Starts the recovery of robots that a reflex has stopped. @param seconds since the last call
  void recover(double seconds);
  /// @param seconds since the last observation; 0 at the beginning of an episode
  /// @param observation observationSize() numbers
  void observe(double seconds, double* observation);

  /// Of this episode.
  std::uint64_t reflexes() const noexcept { return reflexes_; }
  /// Whether a reflex had stopped a robot at the last recover().
  bool stopped() const noexcept;
  /// Whether recovery fails, as for a joint beyond its limits, which people guide back by hand.
  bool stuck() const noexcept;

 private:
  struct Robot {
    SimulatedRobot* robot;
    Eigen::Isometry3d base;
    ArmPolicy arm;
    bool stopped;
  };

  void observeBody(double seconds, double* to);

  Simulation* simulation_;
  Setting setting_;
  std::vector<Robot> robots_;
  std::vector<HandPolicy> hands_;
  std::array<double, 3> before_{};  ///< the body's position at the last observation
  std::uint64_t reflexes_{0};
  double waited_{0.0};  ///< [s] in a reflex
};

}  // namespace franka_sim
