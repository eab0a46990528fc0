// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "franka/control_loop.h"

#include <franka/lowpass_filter.h>
#include <franka_core/to_franka.h>

#include <cmath>
#include <stdexcept>
#include <type_traits>

#include "franka/command_shaping.h"
#include "franka/running_motion.h"

namespace franka {

namespace {

namespace fci = franka_core::fci;

/// Data of one cycle.
struct Cycle {
  const franka_core::RobotState& wire_state;
  const RobotState& state;
  Duration period;
  Shaping shaping;
  franka_core::RobotCommand& command;
};

void requireSettings(const LoopSettings& settings) {
  if (!std::isfinite(settings.cutoff_frequency) || settings.cutoff_frequency <= 0.0) {
    throw std::invalid_argument(
        "libfranka: The cutoff frequency must be greater than 0 Hz; franka::kMaxCutoffFrequency "
        "switches the filter off.");
  }
}

// Positions and poses start at a value; velocities and torques start at rest.
template <typename Value>
constexpr bool kHasStartValue =
    std::is_same_v<Value, JointPositions> || std::is_same_v<Value, CartesianPose>;

/// Calls back and shapes the value into the command. @returns whether it is the last one.
template <typename Value>
bool call(const Callback<Value>& callback, Cycle& cycle) {
  const Value value = callback(cycle.state, cycle.period);
  Shaping shaping = cycle.shaping;
  shaping.start_at_command = shaping.start_at_command && kHasStartValue<Value>;
  shape(shaping, value, cycle.wire_state, cycle.command);
  return value.motion_finished;
}

/// Calls `step` once per state until it returns that the motion ends.
/// @param checked_request checks the arguments and returns the request that starts the motion.
template <typename CheckedRequest, typename Step>
void run(Robot::Impl& robot, CheckedRequest checked_request, const LoopSettings& settings,
         Step step) {
  const Robot::Impl::Operation operation(robot);
  const fci::MoveRequest request = checked_request();
  requireSettings(settings);
  robot.prepareThreadForMotion();
  const bool starts_at_command =
      robot.options().load().first_cycle_reference == FirstCycleReference::kCommand;
  RunningMotion motion(robot, request);
  try {
    const franka_core::RobotState* wire_state = &motion.receive();
    std::uint64_t previous_time = wire_state->message_id;
    RobotState state;
    franka_core::RobotCommand command;
    Shaping shaping{settings.limit_rate ? &robot.limits() : nullptr, settings.cutoff_frequency,
                    starts_at_command};
    while (true) {
      franka_core::toFranka(*wire_state, state);
      Cycle cycle{*wire_state, state, Duration(wire_state->message_id - previous_time), shaping,
                  command};
      if (step(cycle)) {
        break;
      }
      previous_time = wire_state->message_id;
      shaping.start_at_command = false;
      motion.send(command);
      wire_state = &motion.receive();
    }
    motion.finish(command);
  } catch (...) {
    // Also after the robot itself has ended the motion: there is then nothing to stop.
    motion.cancel();
    throw;
  }
}

template <typename Value>
void requireCallback(const Callback<Value>& callback, const char* sentence) {
  if (!callback) {
    throw std::invalid_argument(sentence);
  }
}

constexpr const char* kNoControlCallback = "libfranka: The control callback is empty.";
constexpr const char* kNoMotionCallback = "libfranka: The motion generator callback is empty.";

franka_core::ControllerMode toWire(ControllerMode mode) {
  switch (mode) {
    case ControllerMode::kJointImpedance:
      return franka_core::ControllerMode::kJointImpedance;
    case ControllerMode::kCartesianImpedance:
      return franka_core::ControllerMode::kCartesianImpedance;
  }
  throw std::invalid_argument("libfranka: Invalid controller mode given.");
}

fci::MoveRequest moveRequest(franka_core::ControllerMode controller,
                             franka_core::MotionGeneratorMode generator) {
  fci::MoveRequest request;
  request.controller_mode = controller;
  request.motion_generator_mode = generator;
  return request;
}

constexpr auto kExternal = franka_core::ControllerMode::kExternalController;

}  // namespace

void runTorqueLoop(Robot::Impl& robot, const Callback<Torques>& control_callback,
                   const LoopSettings& settings) {
  const auto checked_request = [&] {
    requireCallback(control_callback, kNoControlCallback);
    return moveRequest(kExternal, torqueGeneratorOf(robot.version()));
  };
  run(robot, checked_request, settings,
      [&](Cycle& cycle) { return call(control_callback, cycle); });
}

template <typename Value>
void runMotionLoop(Robot::Impl& robot, const Callback<Value>& motion_callback,
                   ControllerMode controller, const LoopSettings& settings) {
  const auto checked_request = [&] {
    requireCallback(motion_callback, kNoMotionCallback);
    return moveRequest(toWire(controller), kGeneratorOf<Value>);
  };
  run(robot, checked_request, settings, [&](Cycle& cycle) { return call(motion_callback, cycle); });
}

template <typename Value>
void runMotionLoop(Robot::Impl& robot, const Callback<Torques>& control_callback,
                   const Callback<Value>& motion_callback, const LoopSettings& settings) {
  const auto checked_request = [&] {
    requireCallback(motion_callback, kNoMotionCallback);
    requireCallback(control_callback, kNoControlCallback);
    return moveRequest(kExternal, kGeneratorOf<Value>);
  };
  if (robot.options().load().callback_order == CallbackOrder::kMotionFirst) {
    // The second callback is not called once the first has ended the motion: its last value stays.
    run(robot, checked_request, settings, [&](Cycle& cycle) {
      return call(motion_callback, cycle) || call(control_callback, cycle);
    });
  } else {
    run(robot, checked_request, settings, [&](Cycle& cycle) {
      return call(control_callback, cycle) || call(motion_callback, cycle);
    });
  }
}

template void runMotionLoop(Robot::Impl&, const Callback<JointPositions>&, ControllerMode,
                            const LoopSettings&);
template void runMotionLoop(Robot::Impl&, const Callback<Torques>&, const Callback<JointPositions>&,
                            const LoopSettings&);
template void runMotionLoop(Robot::Impl&, const Callback<JointVelocities>&, ControllerMode,
                            const LoopSettings&);
template void runMotionLoop(Robot::Impl&, const Callback<Torques>&,
                            const Callback<JointVelocities>&, const LoopSettings&);
template void runMotionLoop(Robot::Impl&, const Callback<CartesianPose>&, ControllerMode,
                            const LoopSettings&);
template void runMotionLoop(Robot::Impl&, const Callback<Torques>&, const Callback<CartesianPose>&,
                            const LoopSettings&);
template void runMotionLoop(Robot::Impl&, const Callback<CartesianVelocities>&, ControllerMode,
                            const LoopSettings&);
template void runMotionLoop(Robot::Impl&, const Callback<Torques>&,
                            const Callback<CartesianVelocities>&, const LoopSettings&);

}  // namespace franka
