// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Worlds with robots in this process; pyfranka/sim gives them their Python interface.
#include <franka_sim/robot/parameter_checks.h>
#include <franka_sim/simulation/files.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

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
using release = py::gil_scoped_release;

template <std::size_t size>
std::array<double, size> finite(const py::object& values, const char* name) {
  const std::array<double, size> array = arrayOf<size>(values, name);
  if (!std::all_of(array.begin(), array.end(), [](double value) { return std::isfinite(value); })) {
    throw std::invalid_argument(std::string(name) + " must be finite numbers.");
  }
  return array;
}

double durationOf(double seconds) {
  if (!(seconds >= 0.0 && seconds <= 1e6)) {
    throw std::invalid_argument("duration must be 0 or more seconds, not " +
                                std::to_string(seconds) + ".");
  }
  return seconds;
}

/// A robot of a simulation, which it keeps alive.
class Robot {
 public:
  Robot(std::shared_ptr<Shared> shared, SimulatedRobot& robot)
      : shared_(std::move(shared)), robot_(&robot) {}

  const franka_core::RobotState& state() const { return robot_->state(); }
  const SimulatedRobot& simulated() const { return *robot_; }

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

MoveRequest motionOf(MotionGeneratorMode generator, const std::string& controller) {
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

franka_sim::TargetMotion motionOf(bool linear) {
  return linear ? franka_sim::TargetMotion::kLinear : franka_sim::TargetMotion::kSmooth;
}

std::array<double, 7> dampingOf(const py::object& values) {
  const auto damping = finite<7>(values, "damping");
  if (*std::min_element(damping.begin(), damping.end()) < 0.0) {
    throw std::invalid_argument("damping must not be negative.");
  }
  return damping;
}

void commandTorques(Robot& self, const py::object& values, bool limit_rate,
                    const py::object& damping) {
  const auto tau = finite<7>(values, "torque");
  franka_sim::TorqueShaping shaping{limit_rate, {}};
  if (!damping.is_none()) {
    shaping.damping = dampingOf(damping);
  }
  self.use([&](SimulatedRobot& robot) { robot.commandTorques(tau, shaping); });
}

void commandJoints(Robot& self, const py::object& values, const std::string& controller,
                   MotionGeneratorMode generator) {
  RobotCommand command;
  const bool positions = generator == MotionGeneratorMode::kJointPosition;
  (positions ? command.q_c : command.dq_c) =
      finite<7>(values, positions ? "joint_positions" : "joint_velocities");
  const MoveRequest motion = motionOf(generator, controller);
  self.use([&](SimulatedRobot& robot) { robot.command(motion, command); });
}

void commandCartesian(Robot& self, RobotCommand command, const py::object& elbow,
                      const std::string& controller, MotionGeneratorMode generator) {
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
    throw std::invalid_argument(std::string(name) + " " + fault);
  }
  return frame;
}

void bindCommands(py::class_<Robot>& robot) {
  robot
      .def("command_torques", &commandTorques, py::arg("torques"), py::arg("limit_rate"),
           py::arg("damping"), "7 [Nm], without gravity.")
      .def(
          "command_joint_positions",
          [](Robot& self, const py::object& values, const std::string& controller) {
            commandJoints(self, values, controller, MotionGeneratorMode::kJointPosition);
          },
          py::arg("joint_positions"), py::arg("controller"), "7 [rad].")
      .def(
          "command_joint_velocities",
          [](Robot& self, const py::object& values, const std::string& controller) {
            commandJoints(self, values, controller, MotionGeneratorMode::kJointVelocity);
          },
          py::arg("joint_velocities"), py::arg("controller"), "7 [rad/s].")
      .def(
          "command_cartesian_pose",
          [](Robot& self, const py::object& values, const py::object& elbow,
             const std::string& controller) {
            RobotCommand command;
            command.O_T_EE_c = finite<16>(values, "cartesian_pose");
            commandCartesian(self, command, elbow, controller,
                             MotionGeneratorMode::kCartesianPosition);
          },
          py::arg("cartesian_pose"), py::arg("elbow"), py::arg("controller"), "4x4.")
      .def(
          "command_cartesian_velocities",
          [](Robot& self, const py::object& values, const py::object& elbow,
             const std::string& controller) {
            RobotCommand command;
            command.O_dP_EE_c = finite<6>(values, "cartesian_velocities");
            commandCartesian(self, command, elbow, controller,
                             MotionGeneratorMode::kCartesianVelocity);
          },
          py::arg("cartesian_velocities"), py::arg("elbow"), py::arg("controller"),
          "6 [m/s, rad/s].")
      .def(
          "joint_impedance",
          [](Robot& self, const py::object& target, double duration, const py::object& stiffness,
             bool linear) {
            const auto q = finite<7>(target, "target");
            const double seconds = durationOf(duration);
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
              law.setTarget(q, seconds, motionOf(linear));
            });
          },
          py::arg("target"), py::arg("duration"), py::arg("stiffness"), py::arg("linear"), "")
      .def(
          "cartesian_impedance",
          [](Robot& self, const py::object& target, double duration, const py::object& stiffness,
             const std::optional<double>& nullspace_stiffness, bool linear,
             const py::object& damping) {
            const auto pose = frameOf(target, "target");
            const double seconds = durationOf(duration);
            const auto K = stiffness.is_none() ? std::optional<std::array<double, 6>>()
                                               : std::optional(finite<6>(stiffness, "stiffness"));
            const auto D = damping.is_none() ? std::optional<std::array<double, 7>>()
                                             : std::optional(dampingOf(damping));
            const double nullspace = nullspace_stiffness.value_or(0.0);
            if ((K && *std::min_element(K->begin(), K->end()) < 0.0) || !(nullspace >= 0.0)) {
              throw std::invalid_argument("stiffness must not be negative.");
            }
            self.use([&](SimulatedRobot& robot) {
              franka_sim::CartesianLaw& law = robot.cartesianLaw();
              if (K) {
                law.setStiffness(*K);
              }
              if (nullspace_stiffness) {
                law.setNullspaceStiffness(nullspace);
              }
              law.setTarget(pose, seconds, motionOf(linear));
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
          "moving", [](const Robot& self) { return self.simulated().moving(); },
          "Whether a motion runs.");
}

void bindRequests(py::class_<Robot>& robot) {
  robot
      .def(
          "recover", [](Robot& self) { self.use([](SimulatedRobot& robot) { robot.recover(); }); },
          "Starts the recovery from errors, which takes some ticks.")
      .def(
          "set_user_stop",
          [](Robot& self, bool pressed) {
            self.request(franka_sim::UserStop{pressed}, "The user stop");
          },
          py::arg("pressed"), "Presses or releases the user stop.")
      .def(
          "set_brakes",
          [](Robot& self, bool closed) { self.request(franka_sim::Brakes{closed}, "The brakes"); },
          py::arg("closed"), "Closes or opens the brakes.")
      .def(
          "set_guiding",
          [](Robot& self, bool active) { self.request(franka_sim::Guiding{active}, "Guiding"); },
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
          [](Robot& self, double mass, const py::object& F_x_Cload, const py::object& inertia) {
            const franka_core::Payload load{mass, finite<3>(F_x_Cload, "F_x_Cload"),
                                            finite<9>(inertia, "load_inertia")};
            const std::string fault = franka_sim::payloadFault(load);
            if (!fault.empty()) {
              throw std::invalid_argument(fault);
            }
            self.request(franka_sim::loadRequest(load), "The load");
          },
          py::arg("mass"), py::arg("F_x_Cload"), py::arg("load_inertia"),
          "What the robot knows of its load: mass [kg], centre of mass in F, 3 [m], and inertia, "
          "3x3 [kg m^2].");
}

void bindHand(py::module_& module, py::class_<Robot>& robot) {
  using franka_sim::GripperOutcome;
  py::enum_<GripperOutcome>(module, "GripperOutcome", "What became of a command of the hand.")
      .value("Running", GripperOutcome::kRunning)
      .value("Succeeded", GripperOutcome::kSucceeded)
      .value("Failed", GripperOutcome::kFailed)
      .value("Interrupted", GripperOutcome::kInterrupted);
  robot.def("hand_homing", [](Robot& self) {
    return self.useHand([](GripperUnit& hand) { return hand.homing(); });
  });
  robot.def(
      "hand_move",
      [](Robot& self, double width, double speed) {
        return self.useHand([&](GripperUnit& hand) { return hand.move(width, speed); });
      },
      py::arg("width"), py::arg("speed"));
  robot.def(
      "hand_grasp",
      [](Robot& self, double width, double speed, double force, double inner, double outer) {
        return self.useHand(
            [&](GripperUnit& hand) { return hand.grasp(width, inner, outer, speed, force); });
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
  py::class_<Robot> robot(module, "Robot", "A robot of a simulation.");
  robot
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
          [](const Robot& self) {
            std::array<double, 7> lowest, highest;
            for (std::size_t i = 0; i < lowest.size(); i++) {
              const franka_core::JointRange range =
                  self.simulated().units().unit().limits().reach(i);
              lowest[i] = range.lowest;
              highest[i] = range.highest;
            }
            return py::make_tuple(copy(lowest, Shape::kVector), copy(highest, Shape::kVector));
          },
          "Lowest and highest joint positions, 7 [rad] each.")
      .def_property_readonly(
          "brakes_closed",
          [](const Robot& self) { return self.simulated().units().unit().status().brakes_closed; },
          "Whether the brakes are closed.")
      .def(
          "hash", [](const Robot& self) { return self.simulated().units().hash(); },
          "Hash of all states since the first command: equal hashes mean equal runs.")
      .def(
          "check_positions",
          [](const Robot& self, const py::object& q) {
            franka_sim::Simulation::checkPositions(self.simulated(), finite<7>(q, "q"));
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
           [](Shared& self, const std::string& body) {
             const franka_sim::Pose pose =
                 self.use([&](Simulation& s) { return s.world().bodyPose(body); });
             return py::make_tuple(copy(pose.position, Shape::kVector),
                                   copy(pose.orientation, Shape::kVector));
           })
      .def("place_body",
           [](Shared& self, const std::string& body, const py::object& position,
              const py::object& orientation) {
             const franka_sim::Pose pose = poseOf(position, orientation);
             self.use([&](Simulation& s) { s.world().setBodyPose(body, pose); });
           })
      .def("push",
           [](Shared& self, const std::string& body, const py::object& force,
              const py::object& torque, std::int64_t ticks) {
             const auto f = finite<3>(force, "force");
             const auto t = finite<3>(torque, "torque");
             const std::uint64_t duration = ticksOf(ticks);
             self.use([&](Simulation& s) { s.world().push(body, f, t, duration); });
           })
      .def("contacts",
           [](Shared& self) {
             py::list list;
             for (const franka_sim::Contact& contact :
                  self.use([](Simulation& s) { return s.world().contacts(); })) {
               list.append(py::make_tuple(contact.body1, contact.body2,
                                          copy(contact.position, Shape::kVector),
                                          copy(contact.force, Shape::kVector)));
             }
             return list;
           })
      .def("overlaps",
           [](Shared& self, const std::string& robot) {
             return self.use([&](Simulation& s) { return s.world().describeOverlaps(robot); });
           })
      .def("cameras",
           [](Shared& self) {
             std::vector<std::string> names;
             for (const franka_sim::WorldCamera& camera :
                  self.use([](Simulation& s) { return s.world().cameras(); })) {
               names.push_back(camera.name);
             }
             return names;
           })
      .def("render", [](Shared& self, const std::string& camera, int width, int height) {
        franka_sim::Picture picture;
        {
          const release free;
          picture = self.render(camera, width, height);
        }
        return py::make_tuple(pictureArray(picture), depthArray(picture));
      });
}

constexpr std::uint64_t kTicksBetweenSignals = 1000;  // chosen here: some 20 ms

// Ctrl-C ends a long step.
void step(Shared& self, std::uint64_t ticks) {
  const Shared::Use use(self);
  while (ticks > 0) {
    const std::uint64_t next = std::min(ticks, kTicksBetweenSignals);
    {
      const release free;
      self.step(next);
    }
    ticks -= next;
    if (PyErr_CheckSignals() != 0) {
      throw py::error_already_set();
    }
  }
}

franka_sim::fci::Pace paceOf(bool real_time, double patience) {
  constexpr double kLongest = 86400.0;  // [s] chosen here
  if (!(patience > 0.0 && patience <= kLongest)) {
    throw std::invalid_argument("patience must be more than 0 and at most 86400 seconds, not " +
                                std::to_string(patience) + ".");
  }
  franka_sim::fci::Pace pace;
  pace.mode =
      real_time ? franka_sim::fci::PaceMode::kRealTime : franka_sim::fci::PaceMode::kFreeRunning;
  pace.patience = std::chrono::milliseconds(static_cast<std::int64_t>(std::ceil(1e3 * patience)));
  return pace;
}

}  // namespace

void bindSimulation(py::module_& module) {
  using franka_sim::Simulation;
  py::register_exception<franka_sim::RequestRefused>(module, "RequestRefused", PyExc_RuntimeError)
      .attr("__doc__") = "The robot cannot do what was requested; its mode does not allow it.";
  py::class_<franka_sim::Snapshot>(module, "Snapshot", "The state of a world at a tick.");
  py::class_<Simulation::Robot>(module, "RobotSetup", "What is needed to add a robot.")
      .def(py::init([](const std::string& robot, const std::string& name, const std::string& urdf,
                       const py::object& base, double yaw, const std::string& realism, bool hand) {
             const auto position = finite<3>(base, "base");
             return Simulation::Robot{{robot, name, urdf, position, yaw, realism}, hand};
           }),
           py::arg("robot"), py::arg("name"), py::arg("urdf"), py::arg("base"), py::arg("yaw"),
           py::arg("realism"), py::arg("hand"));
  bindSimulatedRobot(module);
  py::class_<Shared, std::shared_ptr<Shared>> simulation(module, "Simulation",
                                                         "A world with robots.");
  simulation
      .def(py::init([](const std::string& world, const std::vector<Simulation::Robot>& robots) {
             const release free;
             return std::make_shared<Shared>(world, robots);
           }),
           py::arg("world"), py::arg("robots"))
      .def(
          "step", [](Shared& self, std::int64_t ticks) { step(self, ticksOf(ticks)); },
          py::arg("ticks"))
      .def(
          "serve",
          [](Shared& self, const std::string& robot, const std::string& address, bool real_time,
             double patience) { self.serve(robot, address, paceOf(real_time, patience)); },
          py::arg("robot"), py::arg("address"), py::arg("real_time"), py::arg("patience"))
      .def("attend", &Shared::attend)
      .def("reset", [](Shared& self) { self.use([](Simulation& s) { s.reset(); }); })
      .def(
          "snapshot",
          [](Shared& self) { return self.use([](Simulation& s) { return s.world().snapshot(); }); })
      .def("restore",
           [](Shared& self, const franka_sim::Snapshot& snapshot) {
             self.use([&](Simulation& s) { s.restore(snapshot); });
           })
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
      .def("close", &Shared::close);
  bindWorld(simulation);
  bindBatch(module);
  module.def("world_file", &franka_sim::worldFile, py::arg("name"),
             "The file of a world by its name, as Simulation takes it.");
}

}  // namespace pyfranka
