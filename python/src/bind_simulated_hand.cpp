// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The hand of a robot of a simulation.
#include <franka/gripper_state.h>
#include <franka_core/numbers.h>

#include <cstdint>
#include <stdexcept>
#include <string>

#include "arguments.h"
#include "bindings.h"
#include "simulated_robot_handle.h"

namespace pyfranka {

namespace {

using franka_sim::GripperUnit;

/// A command that the hand has accepted. @throws franka_sim::RequestRefused for the ticket 0
GripperUnit::Ticket accepted(GripperUnit::Ticket ticket, const GripperUnit& hand, const char* what,
                             double width, double speed, double force = 0.0) {
  if (ticket != 0) {
    return ticket;
  }
  using franka_core::numberText;
  std::string why = "it needs homing first";
  if (width < 0.0 || width > hand.maxWidth()) {
    why = "width must be 0 to " + numberText(hand.maxWidth()) + " m, not " + numberText(width);
  } else if (speed < 0.0) {
    why = "speed must not be negative, not " + numberText(speed) + " m/s";
  } else if (force < 0.0) {
    why = "force must not be negative, not " + numberText(force) + " N";
  }
  throw franka_sim::RequestRefused(std::string("The hand has refused the ") + what + ": " + why +
                                   ".");
}

/// Larger ones are other units: fingers move at 0.1 m/s and hold with 140 N at most (chosen here).
constexpr double kMaxFingerSpeed = 1.0;     // [m/s]
constexpr double kMaxFingerForce = 1000.0;  // [N]

double numberUpTo(double limit, const py::object& value, const char* name, const char* unit) {
  const double given = number(value, name);
  if (given > limit) {
    throw std::invalid_argument(std::string(name) + " must be 0 to " +
                                franka_core::numberText(limit) + " " + unit + ", not " +
                                franka_core::numberText(given) + " " + unit + ".");
  }
  return given;
}

}  // namespace

void bindSimulatedHand(py::module_& module, py::class_<SimulatedRobotHandle>& robot) {
  using franka_sim::GripperOutcome;
  py::enum_<GripperOutcome>(module, "GripperOutcome", py::module_local(),
                            "Outcome of a hand command.")
      .value("Running", GripperOutcome::kRunning)
      .value("Succeeded", GripperOutcome::kSucceeded)
      .value("Failed", GripperOutcome::kFailed)
      .value("Interrupted", GripperOutcome::kInterrupted);
  robot.def("hand_homing", [](SimulatedRobotHandle& self) {
    return self.useHand([](GripperUnit& hand) { return hand.homing(); });
  });
  robot.def(
      "hand_move",
      [](SimulatedRobotHandle& self, const py::object& width, const py::object& speed) {
        const double w = number(width, "width");
        const double v = numberUpTo(kMaxFingerSpeed, speed, "speed", "m/s");
        return self.useHand(
            [&](GripperUnit& hand) { return accepted(hand.move(w, v), hand, "motion", w, v); });
      },
      py::arg("width"), py::arg("speed"));
  robot.def(
      "hand_grasp",
      [](SimulatedRobotHandle& self, const py::object& width, const py::object& speed,
         const py::object& force, const py::object& inner, const py::object& outer) {
        const double w = number(width, "width");
        const double v = numberUpTo(kMaxFingerSpeed, speed, "speed", "m/s");
        const double f = numberUpTo(kMaxFingerForce, force, "force", "N");
        const double in = number(inner, "epsilon_inner");
        const double out = number(outer, "epsilon_outer");
        return self.useHand([&](GripperUnit& hand) {
          return accepted(hand.grasp(w, in, out, v, f), hand, "grasp", w, v, f);
        });
      },
      py::arg("width"), py::arg("speed"), py::arg("force"), py::arg("epsilon_inner"),
      py::arg("epsilon_outer"));
  robot.def("hand_stop", [](SimulatedRobotHandle& self) {
    return self.useHand([](GripperUnit& hand) { return hand.stop(); });
  });
  robot.def("hand_outcome", [](SimulatedRobotHandle& self, GripperUnit::Ticket ticket) {
    return self.useHand([&](GripperUnit& hand) { return hand.outcome(ticket); });
  });
  robot.def("hand_state", [](SimulatedRobotHandle& self) {
    franka::GripperState state = self.useHand([](GripperUnit& hand) {
      return franka::GripperState{hand.width(),
                                  hand.maxWidth(),
                                  hand.isGrasped(),
                                  static_cast<std::uint16_t>(hand.temperature()),
                                  {}};
    });
    state.time = self.state().time;
    return state;
  });
}

}  // namespace pyfranka
