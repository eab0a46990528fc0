// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Robots of simulations; pyfranka/sim gives them their Python interface.
#include <franka/gripper_state.h>
#include <franka_core/limits.h>
#include <franka_core/motion_limits.h>
#include <franka_core/numbers.h>
#include <franka_core/to_franka.h>
#include <franka_core/typed_transform.h>
#include <franka_sim/robot/control_unit_parameters.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "arguments.h"
#include "bindings.h"
#include "shared_simulation.h"
#include "sim_model.h"

namespace pyfranka {

namespace {

using namespace franka_core::fci;
using franka_core::ControllerMode;
using franka_core::MotionGeneratorMode;
using franka_core::RobotCommand;
using franka_sim::GripperUnit;
using franka_sim::SimulatedRobot;
using franka_sim::UnitRequest;

double durationOf(const py::object& duration) {
  const double seconds = number(duration, "duration");
  if (!(seconds >= 0.0 && seconds <= 1e6)) {
    throw std::invalid_argument("duration must be 0 to 1e6 seconds, not " +
                                franka_core::numberText(seconds) + ".");
  }
  return seconds;
}

/// A robot of a simulation, which it keeps alive.
class Robot {
 public:
  Robot(std::shared_ptr<Shared> shared, SimulatedRobot& robot)
      : shared_(std::move(shared)), robot_(&robot) {}

  /// Changes with each step. @throws std::runtime_error once the simulation is closed, as all
  /// others
  const franka_core::RobotState& liveState() const { return simulated().state(); }
  const SimulatedRobot& simulated() const {
    shared_->requireOpen();
    return *robot_;
  }

  template <typename Function>
  auto use(Function function) {
    return shared_->use([&](franka_sim::Simulation&) { return function(*robot_); });
  }
  /// @throws std::runtime_error if the robot has no hand
  template <typename Function>
  auto useHand(Function function) {
    return use([&](SimulatedRobot& robot) {
      GripperUnit* hand = robot.units().hand();
      if (hand == nullptr) {
        throw std::runtime_error("The robot '" + robot.setup().arm_id + "' has no hand.");
      }
      return function(*hand);
    });
  }
  franka::RobotState state() {
    return use([](const SimulatedRobot& robot) {
      franka::RobotState state;
      franka_core::toFranka(robot.state(), state);
      return state;
    });
  }
  void place(const std::array<double, 7>& q) {
    shared_->use([&](franka_sim::Simulation& simulation) { simulation.place(*robot_, q); });
  }
  void request(const UnitRequest& what, const char* name) {
    use([&](SimulatedRobot& robot) { robot.request(what, name); });
  }

 private:
  std::shared_ptr<Shared> shared_;
  SimulatedRobot* robot_;
};

MoveRequest motionOf(MotionGeneratorMode generator, const py::object& name) {
  const std::string controller = text(name, "controller");
  MoveRequest motion;
  motion.motion_generator_mode = generator;
  if (controller == "cartesian_impedance") {
    motion.controller_mode = ControllerMode::kCartesianImpedance;
  } else if (controller != "joint_impedance") {
    throw std::invalid_argument("controller is joint_impedance or cartesian_impedance, not " +
                                controller + ".");
  }
  return motion;
}

/// Targets that are farther from the base are wrong units, or in another frame: the flange of both
/// robots reaches 0.86 m from joint 2, which is 0.33 m above the base; the rest is for tools
/// (chosen here).
constexpr double kMaxTargetDistance = 2.0;  // [m]

void checkReach(const std::array<double, 16>& pose) {
  const double distance = std::hypot(pose[12], pose[13], pose[14]);
  if (distance > kMaxTargetDistance) {
    throw std::invalid_argument(
        "target lies " + franka_core::numberText(distance, 4) +
        " m from the robot's base, which no arm reaches: it is a pose in the "
        "frame of the base, in meters, at most " +
        franka_core::numberText(kMaxTargetDistance, 4) + " m away.");
  }
}

franka_sim::TargetMotion motionOf(const py::object& linear) {
  return yesOrNo(linear, "linear") ? franka_sim::TargetMotion::kLinear
                                   : franka_sim::TargetMotion::kSmooth;
}

std::array<double, 7> dampingOf(const py::object& values) {
  const auto damping = finite<7>(values, "damping");
  if (*std::min_element(damping.begin(), damping.end()) < 0.0) {
    throw std::invalid_argument("damping must not be negative.");
  }
  return damping;
}

void commandTorques(Robot& self, const py::object& values, const py::object& limit_rate,
                    const py::object& damping) {
  const auto tau = finite<7>(values, "torque");
  franka_sim::TorqueShaping shaping{yesOrNo(limit_rate, "limit_rate"), {}};
  if (!damping.is_none()) {
    shaping.damping = dampingOf(damping);
  }
  self.use([&](SimulatedRobot& robot) { robot.commandTorques(tau, shaping); });
}

void commandJoints(Robot& self, const py::object& values, const py::object& controller,
                   MotionGeneratorMode generator) {
  RobotCommand command;
  const bool positions = generator == MotionGeneratorMode::kJointPosition;
  (positions ? command.q_c : command.dq_c) =
      finite<7>(values, positions ? "joint_positions" : "joint_velocities");
  const MoveRequest motion = motionOf(generator, controller);
  self.use([&](SimulatedRobot& robot) { robot.command(motion, command); });
}

void commandCartesian(Robot& self, RobotCommand command, const py::object& elbow,
                      const py::object& controller, MotionGeneratorMode generator) {
  if (!elbow.is_none()) {
    command.elbow_c = finite<2>(elbow, "elbow");
    command.valid_elbow = true;
  }
  const MoveRequest motion = motionOf(generator, controller);
  self.use([&](SimulatedRobot& robot) { robot.command(motion, command); });
}

std::array<double, 16> frameOf(const py::object& values, const char* name) {
  const std::array<double, 16> frame = arrayOf<16>(values, name);
  const std::string fault = franka_sim::frameFault(frame);
  if (!fault.empty()) {
    throw std::invalid_argument(std::string(name) + " cannot be used: " + fault + ".");
  }
  return frame;
}

/// The frame of a matrix that a user typed; warns of its correction.
std::array<double, 16> typedFrameOf(const py::object& values, const char* name) {
  constexpr int kCallerOfSetter = 2;
  const franka_core::TypedTransform typed =
      franka_core::readTypedTransform(arrayOf<16>(values, name));
  const std::string fault =
      typed.fault.empty() ? franka_sim::frameFault(typed.matrix) : typed.fault;
  if (!fault.empty()) {
    throw std::invalid_argument(std::string(name) + " cannot be used: " + fault + ".");
  }
  if (!typed.warning.empty()) {
    const std::string warning = std::string(name) + ": " + typed.warning + ".";
    if (PyErr_WarnEx(PyExc_RuntimeWarning, warning.c_str(), kCallerOfSetter) != 0) {
      throw py::error_already_set();
    }
  }
  return typed.matrix;
}

void bindCommands(py::class_<Robot>& robot) {
  robot
      .def("command_torques", &commandTorques, py::arg("torques"), py::arg("limit_rate"),
           py::arg("damping"), "7 [Nm], without gravity.")
      .def(
          "command_joint_positions",
          [](Robot& self, const py::object& values, const py::object& controller) {
            commandJoints(self, values, controller, MotionGeneratorMode::kJointPosition);
          },
          py::arg("joint_positions"), py::arg("controller"), "7 [rad].")
      .def(
          "command_joint_velocities",
          [](Robot& self, const py::object& values, const py::object& controller) {
            commandJoints(self, values, controller, MotionGeneratorMode::kJointVelocity);
          },
          py::arg("joint_velocities"), py::arg("controller"), "7 [rad/s].")
      .def(
          "command_cartesian_pose",
          [](Robot& self, const py::object& values, const py::object& elbow,
             const py::object& controller) {
            RobotCommand command;
            command.O_T_EE_c = finite<16>(values, "cartesian_pose");
            commandCartesian(self, command, elbow, controller,
                             MotionGeneratorMode::kCartesianPosition);
          },
          py::arg("cartesian_pose"), py::arg("elbow"), py::arg("controller"), "4x4.")
      .def(
          "command_cartesian_velocities",
          [](Robot& self, const py::object& values, const py::object& elbow,
             const py::object& controller) {
            RobotCommand command;
            command.O_dP_EE_c = finite<6>(values, "cartesian_velocities");
            commandCartesian(self, command, elbow, controller,
                             MotionGeneratorMode::kCartesianVelocity);
          },
          py::arg("cartesian_velocities"), py::arg("elbow"), py::arg("controller"),
          "6 [m/s, rad/s].")
      .def(
          "joint_impedance",
          [](Robot& self, const py::object& target, const py::object& duration,
             const py::object& stiffness, const py::object& linear) {
            const auto q = finite<7>(target, "target");
            const double seconds = durationOf(duration);
            const franka_sim::TargetMotion motion = motionOf(linear);
            const auto K = stiffness.is_none() ? std::optional<std::array<double, 7>>()
                                               : std::optional(finite<7>(stiffness, "stiffness"));
            if (K && !franka_sim::isJointStiffness(*K)) {
              throw std::invalid_argument("stiffness must lie between 0 and 14250 Nm/rad.");
            }
            self.use([&](SimulatedRobot& robot) {
              franka_sim::Simulation::checkPositions(robot, q);
              franka_sim::JointLaw& law = robot.jointLaw();
              if (K) {
                law.setStiffness(*K);
              }
              law.setTarget(q, seconds, motion);
            });
          },
          py::arg("target"), py::arg("duration"), py::arg("stiffness"), py::arg("linear"), "")
      .def(
          "cartesian_impedance",
          [](Robot& self, const py::object& target, const py::object& duration,
             const py::object& stiffness, const py::object& nullspace_stiffness,
             const py::object& linear, const py::object& damping) {
            const auto pose = frameOf(target, "target");
            checkReach(pose);
            const double seconds = durationOf(duration);
            const franka_sim::TargetMotion motion = motionOf(linear);
            const auto K = stiffness.is_none() ? std::optional<std::array<double, 6>>()
                                               : std::optional(finite<6>(stiffness, "stiffness"));
            const auto D = damping.is_none() ? std::optional<std::array<double, 7>>()
                                             : std::optional(dampingOf(damping));
            const auto N = nullspace_stiffness.is_none()
                               ? std::optional<double>()
                               : std::optional(number(nullspace_stiffness, "nullspace_stiffness"));
            if (K && *std::min_element(K->begin(), K->end()) < 0.0) {
              throw std::invalid_argument("stiffness must not be negative.");
            }
            if (N && *N < 0.0) {
              throw std::invalid_argument("nullspace_stiffness must not be negative.");
            }
            self.use([&](SimulatedRobot& robot) {
              franka_sim::CartesianLaw& law = robot.cartesianLaw();
              if (K) {
                law.setStiffness(*K);
              }
              if (N) {
                law.setNullspaceStiffness(*N);
              }
              law.setTarget(pose, seconds, motion);
              if (D) {
                robot.setDamping(*D);
              }
            });
          },
          py::arg("target"), py::arg("duration"), py::arg("stiffness"),
          py::arg("nullspace_stiffness"), py::arg("linear"), py::arg("damping"), "")
      .def(
          "finish", [](Robot& self) { self.use([](SimulatedRobot& robot) { robot.finish(); }); },
          "Ends the motion: the arm brakes, and is then idle.")
      .def_property_readonly(
          "moving",
          [](Robot& self) {
            return self.use([](SimulatedRobot& robot) { return robot.moving(); });
          },
          "Whether a motion runs.");
}

void bindRequests(py::class_<Robot>& robot) {
  robot
      .def(
          "recover", [](Robot& self) { self.use([](SimulatedRobot& robot) { robot.recover(); }); },
          "Starts the recovery from errors, which takes some ticks.")
      .def(
          "set_user_stop",
          [](Robot& self, const py::object& pressed) {
            self.request(franka_sim::UserStop{yesOrNo(pressed, "pressed")}, "The user stop");
          },
          py::arg("pressed"), "Presses or releases the user stop.")
      .def(
          "set_brakes",
          [](Robot& self, const py::object& closed) {
            self.request(franka_sim::Brakes{yesOrNo(closed, "closed")}, "The brakes");
          },
          py::arg("closed"), "Closes or opens the brakes.")
      .def(
          "set_guiding",
          [](Robot& self, const py::object& active) {
            self.request(franka_sim::Guiding{yesOrNo(active, "active")}, "Guiding");
          },
          py::arg("active"), "Whether the user guides the arm by hand.")
      .def(
          "set_joint_impedance",
          [](Robot& self, const py::object& K_theta) {
            self.request(SetJointImpedanceRequest{finite<7>(K_theta, "K_theta")},
                         "The joint stiffness");
          },
          py::arg("K_theta"), "Stiffness of the robot's joint controller, 7 [Nm/rad].")
      .def(
          "set_cartesian_impedance",
          [](Robot& self, const py::object& K_x) {
            self.request(SetCartesianImpedanceRequest{finite<6>(K_x, "K_x")},
                         "The Cartesian stiffness");
          },
          py::arg("K_x"), "Stiffness of the robot's Cartesian controller, 6 [N/m, Nm/rad].")
      .def(
          "set_collision_behavior",
          [](Robot& self, const py::object& lower_torque, const py::object& upper_torque,
             const py::object& lower_force, const py::object& upper_force) {
            const auto a = finite<7>(lower_torque, "lower_torque");
            const auto b = finite<7>(upper_torque, "upper_torque");
            const auto c = finite<6>(lower_force, "lower_force");
            const auto d = finite<6>(upper_force, "upper_force");
            self.request(SetCollisionBehaviorRequest{a, b, a, b, c, d, c, d},
                         "The collision behavior");
          },
          py::arg("lower_torque"), py::arg("upper_torque"), py::arg("lower_force"),
          py::arg("upper_force"),
          "Thresholds of contact (lower) and collision (upper): 7 [Nm] and 6 [N, Nm].")
      .def(
          "set_EE",
          [](Robot& self, const py::object& NE_T_EE) {
            self.request(SetNEToEERequest{typedFrameOf(NE_T_EE, "NE_T_EE")}, "The end effector");
          },
          py::arg("NE_T_EE"), "Pose of the end effector in NE, 4x4.")
      .def(
          "set_K",
          [](Robot& self, const py::object& EE_T_K) {
            self.request(SetEEToKRequest{typedFrameOf(EE_T_K, "EE_T_K")}, "The stiffness frame");
          },
          py::arg("EE_T_K"), "Pose of the stiffness frame in EE, 4x4.")
      .def(
          "set_load",
          [](Robot& self, const py::object& mass, const py::object& F_x_Cload,
             const py::object& inertia) {
            const franka_core::Payload load{number(mass, "mass"), finite<3>(F_x_Cload, "F_x_Cload"),
                                            finite<9>(inertia, "load_inertia")};
            const std::string fault = franka_sim::payloadFault(load);
            if (!fault.empty()) {
              throw std::invalid_argument(fault);
            }
            self.request(franka_sim::loadRequest(load), "The load");
          },
          py::arg("mass"), py::arg("F_x_Cload"), py::arg("load_inertia"),
          "The configured load: mass [kg], center of mass in F, 3 [m], and inertia, "
          "3x3 [kg m^2].");
}

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

void bindHand(py::module_& module, py::class_<Robot>& robot) {
  using franka_sim::GripperOutcome;
  py::enum_<GripperOutcome>(module, "GripperOutcome", py::module_local(),
                            "Outcome of a hand command.")
      .value("Running", GripperOutcome::kRunning)
      .value("Succeeded", GripperOutcome::kSucceeded)
      .value("Failed", GripperOutcome::kFailed)
      .value("Interrupted", GripperOutcome::kInterrupted);
  robot.def("hand_homing", [](Robot& self) {
    return self.useHand([](GripperUnit& hand) { return hand.homing(); });
  });
  robot.def(
      "hand_move",
      [](Robot& self, const py::object& width, const py::object& speed) {
        const double w = number(width, "width");
        const double v = numberUpTo(kMaxFingerSpeed, speed, "speed", "m/s");
        return self.useHand(
            [&](GripperUnit& hand) { return accepted(hand.move(w, v), hand, "motion", w, v); });
      },
      py::arg("width"), py::arg("speed"));
  robot.def(
      "hand_grasp",
      [](Robot& self, const py::object& width, const py::object& speed, const py::object& force,
         const py::object& inner, const py::object& outer) {
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
  robot.def("hand_stop", [](Robot& self) {
    return self.useHand([](GripperUnit& hand) { return hand.stop(); });
  });
  robot.def("hand_outcome", [](Robot& self, GripperUnit::Ticket ticket) {
    return self.useHand([&](GripperUnit& hand) { return hand.outcome(ticket); });
  });
  robot.def("hand_state", [](Robot& self) {
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

}  // namespace

void bindSimulatedRobot(py::module_& module,
                        py::class_<Shared, std::shared_ptr<Shared>>& simulation) {
  py::class_<Robot> robot(module, "SimulatedRobot", py::module_local(), "A robot of a simulation.");
  robot
      .def(
          "require_open", [](const Robot& self) { self.simulated(); },
          "Raises RuntimeError once the simulation is closed.")
      .def_property_readonly("state", &Robot::state, "The present state, a RobotState.")
      .def_property_readonly("live_state", &Robot::liveState,
                             py::return_value_policy::reference_internal, "A LiveState.")
      .def_property_readonly(
          "model",
          [](const Robot& self) {
            return SimModel(self.simulated().units().unit().configuration().model);
          },
          "The ArmModel of the robot's own control.")
      .def_property_readonly(
          "limits",
          [](Robot& self) {
            std::array<double, 7> lowest, highest;
            self.use([&](SimulatedRobot& robot) {
              for (std::size_t i = 0; i < lowest.size(); i++) {
                const franka_core::JointRange range = robot.units().unit().limits().reach(i);
                lowest[i] = range.lowest;
                highest[i] = range.highest;
              }
            });
            return py::make_tuple(copy(lowest, Shape::kVector), copy(highest, Shape::kVector));
          },
          "Lowest and highest joint positions, 7 [rad] each.")
      .def_property_readonly(
          "brakes_closed",
          [](Robot& self) {
            return self.use(
                [](SimulatedRobot& robot) { return robot.units().unit().status().brakes_closed; });
          },
          "Whether the brakes are closed.")
      .def(
          "hash",
          [](Robot& self) {
            return self.use([](SimulatedRobot& robot) { return robot.units().hash(); });
          },
          "Hash of all states since the first command: equal hashes mean equal runs.")
      .def(
          "check_positions",
          [](Robot& self, const py::object& q) {
            const auto positions = finite<7>(q, "q");
            self.use([&](SimulatedRobot& robot) {
              franka_sim::Simulation::checkPositions(robot, positions);
            });
          },
          py::arg("q"), "Raises ValueError if the arm cannot be at joint positions, 7 [rad].")
      .def(
          "place", [](Robot& self, const py::object& q) { self.place(finite<7>(q, "q")); },
          py::arg("q"), "Puts the arm at joint positions, 7 [rad], at rest.");
  bindCommands(robot);
  bindRequests(robot);
  bindHand(module, robot);
  simulation.def("robot", [](const std::shared_ptr<Shared>& self, const std::string& name) {
    return Robot(self, *self->use([&](franka_sim::Simulation& s) { return &s.robot(name); }));
  });
}

}  // namespace pyfranka
