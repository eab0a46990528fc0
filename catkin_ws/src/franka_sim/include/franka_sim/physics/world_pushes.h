// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>

/// @file
/// Forces and torques that push bodies and joints for a time. The thread that uses the world calls
/// them, between ticks. All throw std::runtime_error with a sentence for an unknown name; those
/// that change something also while the world has stopped (World::stopped), and for numbers beyond
/// the limits of input_limits.h. Not real-time safe.

namespace franka_sim {

/// A force and torque on a body at its origin or at `point` (world), for `ticks` ticks from now.
void pushBody(World& world, const std::string& body, const std::array<double, 3>& force,
              const std::array<double, 3>& torque, std::uint64_t ticks,
              const std::optional<std::array<double, 3>>& point = {});
/// Ends all pushes of a body.
void endPushes(World& world, const std::string& body);
/// A torque [Nm] or force [N] on a joint of an object, for `ticks` ticks from now. @throws
/// std::runtime_error also for a joint of a robot
void pushJoint(World& world, const std::string& joint, double effort, std::uint64_t ticks);
/// Ends all pushes of a joint.
void endJointPushes(World& world, const std::string& joint);

}  // namespace franka_sim
