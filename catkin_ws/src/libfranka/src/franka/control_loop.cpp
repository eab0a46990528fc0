// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "franka/control_loop.h"

#include <franka/lowpass_filter.h>
#include <franka_core/to_franka.h>

#include <cmath>
#include <stdexcept>
#include <type_traits>

#include "franka/command_shaping.h"
#include "franka/realtime_setup.h"
#include "franka/running_motion.h"

namespace franka {

namespace {

namespace fci = franka_core::fci;

/// What a cycle works on.
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

// Positions and poses have a value to start from; for velocities and torques rest is the start.
template <typename Value>
constexpr bool kHasStartValue =
    std::is_same_v<Value, JointPositions> || std::is_same_v<Value, CartesianPose>;

/// Calls back, shapes the value into the command. @returns whether it is the last one.
template <typename Value>
bool call(const Callback<Value>& callback, Cycle& cycle) {
  const Value value = callback(cycle.state, cycle.period);
  Shaping shaping = cycle.shaping;
  shaping.start_at_command = shaping.start_at_command && kHasStartValue<Value>;
  shape(shaping, value, cycle.wire_state, cycle.command);
  return value.motion_finished;
}

/// Calls `step` once a state until it says that the motion ends.
template <typename Step>
void run(Robot::Impl& robot, const fci::MoveRequest& request, const LoopSettings& settings,
         Step step) {
  requireSettings(settings);
  const Robot::Impl::Operation operation(robot);
  prepareControlThread(robot.realtimeConfig());
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
    // Also after the robot itself has ended the motion: it then has nothing left to stop.
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

}  // namespace

void runTorqueLoop(Robot::Impl& robot, const Callback<Torques>& control_callback,
                   const LoopSettings& settings) {
  requireCallback(control_callback, kNoControlCallback);
  fci::MoveRequest request;
  request.controller_mode = franka_core::ControllerMode::kExternalController;
  request.motion_generator_mode = torqueGeneratorOf(robot.version());
  run(robot, request, settings,
      [&control_callback](Cycle& cycle) { return call(control_callback, cycle); });
}

template <typename Value>
void runMotionLoop(Robot::Impl& robot, franka_core::ControllerMode controller,
                   const Callback<Value>& motion_callback,
                   const Callback<Torques>* control_callback, const LoopSettings& settings) {
  requireCallback(motion_callback, kNoMotionCallback);
  if (control_callback != nullptr) {
    requireCallback(*control_callback, kNoControlCallback);
  }
  fci::MoveRequest request;
  request.controller_mode = controller;
  request.motion_generator_mode = kGeneratorOf<Value>;
  if (control_callback == nullptr) {
    run(robot, request, settings, [&](Cycle& cycle) { return call(motion_callback, cycle); });
  } else if (robot.options().load().callback_order == CallbackOrder::kMotionFirst) {
    // The callback that comes second is not asked once the first has ended the motion: its last
    // value stays.
    run(robot, request, settings, [&](Cycle& cycle) {
      return call(motion_callback, cycle) || call(*control_callback, cycle);
    });
  } else {
    run(robot, request, settings, [&](Cycle& cycle) {
      return call(*control_callback, cycle) || call(motion_callback, cycle);
    });
  }
}

template void runMotionLoop(Robot::Impl&, franka_core::ControllerMode,
                            const Callback<JointPositions>&, const Callback<Torques>*,
                            const LoopSettings&);
template void runMotionLoop(Robot::Impl&, franka_core::ControllerMode,
                            const Callback<JointVelocities>&, const Callback<Torques>*,
                            const LoopSettings&);
template void runMotionLoop(Robot::Impl&, franka_core::ControllerMode,
                            const Callback<CartesianPose>&, const Callback<Torques>*,
                            const LoopSettings&);
template void runMotionLoop(Robot::Impl&, franka_core::ControllerMode,
                            const Callback<CartesianVelocities>&, const Callback<Torques>*,
                            const LoopSettings&);

}  // namespace franka
