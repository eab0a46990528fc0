// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/typed_transform.h>
#include <franka_sim/robot/control_unit_parameters.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

#include "serve/commands/command_groups.h"
#include "serve/operator_switches.h"

namespace franka_sim {

namespace {

using namespace fci;  // NOLINT: the words of the table

constexpr double kMaxBusyDuration = 60.0;  // [s] of the brakes' motion and the self-test

void addStops(CommandTable& table, SimRobot& robot, Host& host) {
  SafetyController& safety = robot.whole().safety();
  table.add(line("user_stop", onOff()),
            "presses or releases the operator's stop; it aborts a motion as on a real robot: the "
            "motors brake, then the brakes close. It acts as a device at X3.1 of an fr3 and at X4 "
            "of a panda",
            kUrgentInput, [&](bool pressed) {
              setUserStop(robot.whole(), pressed);
              host.runFree(kReaction);
            });
  table.add(line("input", choice(kSafetyInputNames), onOff()),
            "presses or releases a stop of an fr3 (X3.1 to X3.3), the activation device of a panda "
            "or enabling device of an fr3 (X4), or the guiding button",
            kUrgentInput, [&](std::uint64_t input, bool pressed) {
              safety.press(static_cast<SafetyInput>(input), pressed);
              host.runFree(kReaction);
            });
  table.add(line("button", choice(kButtonNames), onOff()),
            "presses or releases a button of the Pilot", kUrgentInput,
            [&](std::uint64_t button, bool pressed) { safety.press(button, pressed); });
}

void addBrakes(CommandTable& table, SimRobot& robot, Host& host) {
  const auto lock = [&](bool closed) {
    setBrakes(robot.whole(), closed);
    host.runFree(kReaction);
  };
  table.add(line("brakes", either("open", "close")),
            "opens or closes the brakes of the joints; closed brakes are mode Other", kNotOnPage,
            [lock](bool open) { lock(!open); });
  const auto wait_for = [lock, &safety = robot.whole().safety()](bool closed) {
    lock(closed);
    return Reply::when([&safety] { return !safety.state().brakes_moving; });
  };
  table.add(line("joints lock"), "closes the brakes; the answer comes when they have closed",
            kUrgentInput, [wait_for] { return wait_for(true); });
  table.add(line("joints unlock"), "opens the brakes; the answer comes when all are open", kControl,
            [wait_for] { return wait_for(false); });
}

void addFci(CommandTable& table, SimRobot& robot) {
  SafetyController& safety = robot.whole().safety();
  table.add(line("fci on"), "clients may connect", kControl, [&] { setFci(robot, true); });
  table.add(line("fci off"),
            "a motion is aborted, the client disconnected, and new clients are refused (\"Please "
            "install FCI feature or enable FCI mode in Desk.\"). Grippers stay reachable, except "
            "with Desk's rules",
            kUrgentControl, [&] { setFci(robot, false); });
  table.add(line("operating_mode", either("execution", "programming")), "of an fr3", kControl,
            [&](bool execution) {
              if (!safety.isFr3()) {
                throw std::invalid_argument(
                    "A Panda has no operating mode: its activation device decides (input x4 "
                    "on|off).");
              }
              requireAllowed(safety.setOperatingMode(execution ? OperatingMode::kExecution
                                                               : OperatingMode::kProgramming));
            });
}

void addGuiding(CommandTable& table, SimRobot& robot, Host& host) {
  SafetyController& safety = robot.whole().safety();
  table.add(line("guiding", onOff()),
            "hand guiding; the arm is then not braked, and in lock-step it stands still between "
            "pushes",
            kControl, [&](bool active) {
              setGuiding(robot.whole(), active);
              host.runFree(kReaction);
            });
  table.add(line("guiding_mode", choice(kGuidingModeNames), optional(switches<7>())),
            "the directions in which the arm can be guided; `user` takes 7 switches: along and "
            "about the axes of K, and the elbow",
            kControl, [&](std::uint64_t index, const std::optional<std::array<bool, 7>>& axes) {
              const auto mode = static_cast<GuidingMode>(index);
              if (mode == GuidingMode::kUser && !axes) {
                throw std::invalid_argument("guiding_mode user takes 7 switches, on or off.");
              }
              requireAllowed(safety.setGuidingMode(
                  mode, mode == GuidingMode::kUser ? *axes : std::array<bool, 7>{}));
            });
  table.add(line("navigation", either("desk", "robot")), "target of the Pilot's arrow keys",
            kControl, [&](bool desk) { safety.setArrowsGuideDesk(desk); });
}

void addPower(CommandTable& table, SimRobot& robot, Host& host) {
  SafetyController& safety = robot.whole().safety();
  const auto set = [&](bool on) {
    setPower(robot, on);
    host.runFree(kReaction);
  };
  table.add(line("power on"), "the robot is as after power-up", kInput, [set] { set(true); });
  table.add(line("power off"), "the robot is not reachable", kControl, [set] { set(false); });
  table.add(
      line("timing", either("brakes", "self_test"), number("SECONDS", "s", 0.0, kMaxBusyDuration)),
      "how long all brakes and the self-test take (5 and 8)", kNotOnPage,
      [&](bool brakes, double seconds) {
        brakes ? safety.setBrakeTime(seconds) : safety.setSelfTestTime(seconds);
      });
}

std::string setEndEffector(ControlUnit& unit, const franka_core::Payload& payload,
                           const std::array<double, 16>& F_T_NE) {
  const franka_core::TypedTransform frame = franka_core::readTypedTransform(F_T_NE);
  const SetEndEffector request{payload, frame.matrix};
  const std::optional<Status> answer = unit.request(request);
  if (answer == Status::kInvalidArgumentRejected) {
    const std::string fault = frame.fault.empty() ? frameFault(frame.matrix) : frame.fault;
    throw std::invalid_argument(
        "The end effector was refused. " +
        (isPayload(request.payload)
             ? "F_T_NE is not a column-major 4x4 transform to a frame on the arm: " + fault + "."
             : payloadFault(request.payload)));
  }
  requireAllowed(answer == Status::kSuccess ? Refusal::kNone : Refusal::kMotionActive);
  return frame.warning.empty() ? "" : "F_T_NE: " + frame.warning + ".";
}

void addEndEffector(CommandTable& table, SimRobot& robot) {
  table.add(line("end_effector", number("MASS", "kg"), numbers<3>("X Y Z", "m"),
                 numbers<9>("INERTIA*9", "kg m^2"), numbers<16>("F_T_NE*16", "m")),
            "m_ee, F_x_Cee, I_ee and F_T_NE, both column by column; refused within a motion. The "
            "answer has a warning if F_T_NE was typed with few digits and its rotation is "
            "corrected",
            kControl,
            [&](double mass, const std::array<double, 3>& center,
                const std::array<double, 9>& inertia, const std::array<double, 16>& F_T_NE) {
              return setEndEffector(robot.unit(), {mass, center, inertia}, F_T_NE);
            });
  table.add(line("end_effector_power", onOff()), "off: the hand is not reachable", kControl,
            [&](bool on) { setEndEffectorPower(robot, on); });
}

}  // namespace

void addSafetyCommands(fci::CommandTable& table, const OperatorContext& context) {
  addStops(table, context.robot, context.host);
  addBrakes(table, context.robot, context.host);
  addFci(table, context.robot);
  addGuiding(table, context.robot, context.host);
  addPower(table, context.robot, context.host);
  addEndEffector(table, context.robot);
}

}  // namespace franka_sim
