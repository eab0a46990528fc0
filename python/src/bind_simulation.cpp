// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Worlds with robots in this process; pyfranka/sim gives them their Python interface.
#include <franka_core/numbers.h>
#include <franka_sim/physics/world_properties.h>
#include <franka_sim/robot/control_unit_parameters.h>
#include <franka_sim/robot/realism.h>
#include <franka_sim/simulation/robot_setup.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arguments.h"
#include "bindings.h"
#include "shared_simulation.h"
#include "sim_model.h"
#include "step_hooks.h"

namespace pyfranka {

namespace {

using namespace franka_core::fci;
using franka_core::ControllerMode;
using franka_core::MotionGeneratorMode;
using franka_core::RobotCommand;
using franka_sim::GripperUnit;
using franka_sim::SimulatedRobot;
using franka_sim::UnitRequest;
using release = py::gil_scoped_release;

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

  /// @throws std::runtime_error once the simulation is closed, as all others
  const franka_core::RobotState& state() const { return simulated().state(); }
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
            const double seconds = durationOf(duration);
            const franka_sim::TargetMotion motion = motionOf(linear);
            const auto K = stiffness.is_none() ? std::optional<std::array<double, 6>>()
                                               : std::optional(finite<6>(stiffness, "stiffness"));
            const auto D = damping.is_none() ? std::optional<std::array<double, 7>>()
                                             : std::optional(dampingOf(damping));
            const auto N = nullspace_stiffness.is_none()
                               ? std::optional<double>()
                               : std::optional(number(nullspace_stiffness, "nullspace_stiffness"));
            if ((K && *std::min_element(K->begin(), K->end()) < 0.0) || (N && *N < 0.0)) {
              throw std::invalid_argument("stiffness must not be negative.");
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
            self.request(SetNEToEERequest{frameOf(NE_T_EE, "NE_T_EE")}, "The end effector");
          },
          py::arg("NE_T_EE"), "Pose of the end effector in NE, 4x4.")
      .def(
          "set_K",
          [](Robot& self, const py::object& EE_T_K) {
            self.request(SetEEToKRequest{frameOf(EE_T_K, "EE_T_K")}, "The stiffness frame");
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
        const double v = number(speed, "speed");
        return self.useHand(
            [&](GripperUnit& hand) { return accepted(hand.move(w, v), hand, "motion", w, v); });
      },
      py::arg("width"), py::arg("speed"));
  robot.def(
      "hand_grasp",
      [](Robot& self, const py::object& width, const py::object& speed, const py::object& force,
         const py::object& inner, const py::object& outer) {
        const double w = number(width, "width");
        const double v = number(speed, "speed");
        const double f = number(force, "force");
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
    return self.useHand([](GripperUnit& hand) {
      return std::make_tuple(hand.width(), hand.maxWidth(), hand.isGrasped(), hand.temperature());
    });
  });
}

void bindSimulatedRobot(py::module_& module) {
  py::class_<Robot> robot(module, "Robot", py::module_local(), "A robot of a simulation.");
  robot
      .def(
          "require_open", [](const Robot& self) { self.simulated(); },
          "Raises RuntimeError once the simulation is closed.")
      .def_property_readonly("state", &Robot::state, py::return_value_policy::reference_internal,
                             "The present LiveState.")
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
}

franka_sim::Pose poseOf(const py::object& position, const py::object& orientation) {
  return {finite<3>(position, "position"), finite<4>(orientation, "orientation")};
}

int pixels(const py::object& side, const char* name) {
  const std::int64_t number = wholeNumber(side, name);
  if (number < 1 || number > franka_sim::Renderer::kMaxPictureSide) {
    throw std::invalid_argument(std::string(name) + " must be 1 to " +
                                std::to_string(franka_sim::Renderer::kMaxPictureSide) +
                                " pixels, not " + std::to_string(number) + ".");
  }
  return static_cast<int>(number);
}

py::array pictureArray(const franka_sim::Picture& picture) {
  return py::array_t<std::uint8_t>({picture.height, picture.width, 3}, picture.rgb.data());
}

py::object depthArray(const franka_sim::Picture& picture) {
  if (picture.depth.empty()) {
    return py::none();
  }
  return py::array_t<float>({picture.height, picture.width}, picture.depth.data());
}

void bindWorld(py::class_<Shared, std::shared_ptr<Shared>>& simulation) {
  using franka_sim::Simulation;
  simulation
      .def("bodies",
           [](Shared& self) { return self.use([](Simulation& s) { return s.world().bodies(); }); })
      .def("body_pose",
           [](Shared& self, const py::object& body) {
             const std::string name = text(body, "body");
             const franka_sim::Pose pose =
                 self.use([&](Simulation& s) { return bodyPose(s.world(), name); });
             return py::make_tuple(copy(pose.position, Shape::kVector),
                                   copy(pose.orientation, Shape::kVector));
           })
      .def("check_body_pose",  // whether place_body would take it
           [](Shared& self, const py::object& body, const py::object& position,
              const py::object& orientation) {
             const std::string name = text(body, "body");
             const franka_sim::Pose pose = poseOf(position, orientation);
             self.use([&](Simulation& s) { checkBodyPose(s.world(), name, pose); });
           })
      .def("place_body",
           [](Shared& self, const py::object& body, const py::object& position,
              const py::object& orientation) {
             const std::string name = text(body, "body");
             const franka_sim::Pose pose = poseOf(position, orientation);
             self.use([&](Simulation& s) { setBodyPose(s.world(), name, pose); });
           })
      .def("push",
           [](Shared& self, const py::object& body, const py::object& force,
              const py::object& torque, const py::object& ticks) {
             const std::string name = text(body, "body");
             const auto f = finite<3>(force, "force");
             const auto t = finite<3>(torque, "torque");
             const std::uint64_t duration = ticksOf(ticks);
             self.use([&](Simulation& s) { pushBody(s.world(), name, f, t, duration); });
           })
      .def("contacts",
           [](Shared& self) {
             py::list list;
             for (const franka_sim::Contact& contact :
                  self.use([](Simulation& s) { return contacts(s.world()); })) {
               list.append(py::make_tuple(contact.body1, contact.body2,
                                          copy(contact.position, Shape::kVector),
                                          copy(contact.force, Shape::kVector)));
             }
             return list;
           })
      .def("overlaps",
           [](Shared& self, const std::string& robot) {
             return self.use([&](Simulation& s) { return describeOverlaps(s.world(), robot); });
           })
      .def("cameras",
           [](Shared& self) {
             std::vector<std::string> names;
             for (const franka_sim::WorldCamera& camera :
                  self.use([](Simulation& s) { return cameras(s.world()); })) {
               names.push_back(camera.name);
             }
             return names;
           })
      .def("render", [](Shared& self, const py::object& camera, const py::object& width,
                        const py::object& height) {
        const std::string name = text(camera, "camera");
        const int w = pixels(width, "width");
        const int h = pixels(height, "height");
        franka_sim::Picture picture;
        {
          const release free;
          picture = self.render(name, w, h);
        }
        return py::make_tuple(pictureArray(picture), depthArray(picture));
      });
}

constexpr std::uint64_t kTicksBetweenSignals = 1000;  // chosen here: some 20 ms

// Ctrl-C ends a long step.
void step(Shared& self, std::uint64_t ticks, bool warns) {
  const Shared::Use use(self);
  while (ticks > 0) {
    const std::uint64_t next = std::min(ticks, kTicksBetweenSignals);
    {
      const release free;
      self.step(next);
    }
    ticks -= next;
    raiseSignal();  // also of a tick that waited for a client
  }
  if (warns) {
    for (const std::string& warning : self.simulation().world().takeWarnings()) {
      warnOfStep(warning);
    }
  }
}

franka_core::WaitMode waitOf(const py::object& name) {
  const std::string word = text(name, "wait");
  const std::optional<franka_core::WaitMode> mode = franka_core::toWaitMode(word);
  if (!mode) {
    throw std::invalid_argument("wait is 'auto', 'spin' or 'block', not '" + word + "'.");
  }
  return *mode;
}

/// @param limit [s]; none: without end
franka_sim::fci::Pace paceOf(bool real_time, const py::object& limit) {
  constexpr double kMaxPatience = 86400.0;  // [s] chosen here
  const auto patience =
      limit.is_none() ? std::optional<double>() : std::optional(number(limit, "patience"));
  if (patience && !(*patience > 0.0 && *patience <= kMaxPatience)) {
    throw std::invalid_argument(
        "patience must be more than 0 and at most 86400 seconds, or 'forever', not " +
        franka_core::numberText(*patience) + ".");
  }
  franka_sim::fci::Pace pace;
  pace.mode =
      real_time ? franka_sim::fci::PaceMode::kRealTime : franka_sim::fci::PaceMode::kFreeRunning;
  pace.patience = franka_sim::fci::Pace::kForever;
  if (patience) {
    const double milliseconds = std::ceil(1e3 * *patience);
    pace.patience = std::chrono::milliseconds(static_cast<std::int64_t>(milliseconds));
  }
  return pace;
}

struct Snapshot {
  franka_sim::SimulationSnapshot condition;
  std::uint64_t ticks;
};

}  // namespace

void bindSimulation(py::module_& module) {
  using franka_sim::Simulation;
  py::register_local_exception<franka_sim::RequestRefused>(module, "RequestRefused",
                                                           PyExc_RuntimeError)
      .attr("__doc__") =
      "The robot or its hand cannot do what was requested: its mode does not allow it, or no such "
      "value exists for it.";
  py::class_<Snapshot>(module, "Snapshot", py::module_local(),
                       "The state of a world and its robots at a tick.\n\n"
                       ">>> snapshot = sim.snapshot()\n>>> sim.restore(snapshot)")
      .def(
          "__reduce__",
          [](const Snapshot&) -> py::object {
            throw py::type_error(
                "A Snapshot cannot be pickled: restore it in the process that has taken it. "
                "Elsewhere make a Simulation with the same world, robots and seed, and repeat what "
                "has been commanded.");
          },
          "Raises TypeError.")
      .def("__repr__", [](const Snapshot& self) {
        return "<Snapshot at " + franka_core::numberText(1e-3 * double(self.ticks), 9) + " s>";
      });
  py::class_<Simulation::Robot>(module, "RobotSetup", py::module_local(),
                                "What is needed to add a robot.")
      .def(py::init([](const std::string& robot, const std::string& name, const std::string& urdf,
                       const py::object& base, double yaw, const std::string& realism, bool hand) {
             const auto position = finite<3>(base, "base");
             return Simulation::Robot{{robot, name, urdf, position, yaw, realism}, hand};
           }),
           py::arg("robot"), py::arg("name"), py::arg("urdf"), py::arg("base"), py::arg("yaw"),
           py::arg("realism"), py::arg("hand"));
  module.def("robot_with_meshes", [](const std::string& robot, const std::string& arm_id) {
    const franka_sim::RobotLook look = franka_sim::robotWithMeshes(robot, arm_id);
    return py::make_tuple(look.urdf, look.missing);
  });
  bindSimulatedRobot(module);
  py::class_<Shared, std::shared_ptr<Shared>> simulation(module, "Simulation", py::module_local(),
                                                         "A world with robots.");
  simulation
      .def(py::init([](const std::string& world, const std::vector<Simulation::Robot>& robots) {
             const release free;
             return std::make_shared<Shared>(world, robots);
           }),
           py::arg("world"), py::arg("robots"))
      .def(
          "step", [](Shared& self, const py::object& ticks) { step(self, ticksOf(ticks), true); },
          py::arg("ticks"))
      .def(
          "try_out",  // a step that will be undone: it does not warn
          [](Shared& self, const py::object& ticks) { step(self, ticksOf(ticks), false); },
          py::arg("ticks"))
      .def(
          "serve",
          [](Shared& self, const std::string& robot, const py::object& address, bool real_time,
             const py::object& patience, const py::object& wait) {
            franka_sim::fci::Pace pace = paceOf(real_time, patience);
            pace.wait = waitOf(wait);
            self.serve(robot, text(address, "ip"), pace, noSignal);
          },
          py::arg("robot"), py::arg("address"), py::arg("real_time"), py::arg("patience"),
          py::arg("wait"))
      .def("attend", &Shared::attend)
      .def("take_events", &Shared::takeEvents)
      .def("reset", [](Shared& self) { self.use([](Simulation& s) { s.reset(); }); })
      .def("snapshot",
           [](Shared& self) {
             return self.use(
                 [](Simulation& s) { return Snapshot{s.snapshot(), s.world().ticks()}; });
           })
      .def("restore",
           [](Shared& self, const py::object& snapshot) {
             const auto& kept =
                 objectOf<Snapshot>(snapshot, "snapshot", "what snapshot() has returned");
             self.use([&](Simulation& s) { s.restore(kept.condition); });
           })
      .def("stopped",
           [](Shared& self) { return self.use([](Simulation& s) { return s.world().stopped(); }); })
      .def("ticks",
           [](Shared& self) { return self.use([](Simulation& s) { return s.world().ticks(); }); })
      .def("hash",
           [](Shared& self) {
             return self.use([](Simulation& s) { return s.world().stateHash(); });
           })
      .def("robot",
           [](const std::shared_ptr<Shared>& self, const std::string& name) {
             return Robot(self, *self->use([&](Simulation& s) { return &s.robot(name); }));
           })
      .def("require_open", &Shared::requireOpen, "Raises RuntimeError once it is closed.")
      .def("close", &Shared::close);
  bindWorld(simulation);
  bindBatch(module);
  bindEpisode(module);
  module.def(
      "check_realism",
      [](const std::string& text) { franka_sim::readRealism(text, franka_sim::kInProcessProfile); },
      py::arg("realism"), "Raises ValueError for a profile that does not exist.");
  module.def("world_file", &franka_sim::worldFile, py::arg("name"),
             "The file of a world by its name, as Simulation takes it.");
}

}  // namespace pyfranka
