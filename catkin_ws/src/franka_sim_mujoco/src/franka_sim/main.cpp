// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// A simulated robot on the network, without ROS.
#include <franka_core/limits.h>
#include <franka_sim_mujoco/fci/served_models.h>
#include <franka_sim_mujoco/fci/sim_robot.h>
#include <franka_sim_mujoco/physics/world.h>
#include <franka_sim_mujoco/ros/physics_config.h>
#include <sched.h>
#include <sys/mman.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <mutex>
#include <optional>
#include <stdexcept>

#include "files.h"
#include "options.h"
#include "person.h"
#include "viewer.h"

namespace franka_sim_mujoco {
namespace {

std::atomic<bool> stop_requested{false};

void requestStop(int /*signal*/) { stop_requested = true; }

constexpr std::array<double, 7> kReady{0, -M_PI_4, 0, -3 * M_PI_4, 0, M_PI_2, M_PI_4};
constexpr double kFingersAtStart = 0.001;  // [m] each

// Flange to the hand's nominal end effector: turned by -45 deg about z, 0.1034 m along it
// (fci.md 3).
constexpr std::array<double, 16> kHandF_T_NE{
    M_SQRT1_2, -M_SQRT1_2, 0, 0, M_SQRT1_2, M_SQRT1_2, 0, 0, 0, 0, 1, 0, 0, 0, 0.1034, 1};

// Force laws of the fingers: gains of the manual (franka_ros.md 9.5).
constexpr FingerGains kFingerGains{100.0, 0.0, 1.0};

std::string worldFile(const std::string& name) {
  std::error_code error;
  if (name.empty() || std::filesystem::exists(name, error)) {
    return name;
  }
  const std::string file = packageFile("franka_sim_mujoco", "worlds/" + name);
  if (file.empty()) {
    throw std::runtime_error("There is no world '" + name +
                             "': neither a file nor one of those that come with franka_sim.");
  }
  return file;
}

std::string robotText(const Options& options) {
  if (!options.urdf.empty()) {
    return readFile(options.urdf);
  }
  const std::string name = "robots/" + options.robot + ".urdf";
  const std::string file = packageFile("franka_sim_mujoco", name);
  if (file.empty()) {
    throw std::runtime_error("franka_sim does not find its file " + name +
                             "; give a robot description with --urdf.");
  }
  return readFile(file);
}

JointPhysics jointPhysics(const Options& options) {
  const std::string file = packageFile("franka_description", "config/physics.yaml");
  if (file.empty()) {
    throw std::runtime_error("franka_sim does not find config/physics.yaml of franka_description.");
  }
  return readJointPhysics(file, options.robot, options.friction);
}

RobotDescription describeRobot(const Options& options, const std::string& urdf,
                               const JointPhysics& physics, bool hand) {
  RobotDescription robot;
  robot.name = options.arm_id;
  robot.urdf = urdf;
  robot.resolve = resolveUri;
  robot.base.position = options.base;
  for (std::size_t i = 0; i < 7; i++) {
    robot.initial_positions[options.arm_id + "_joint" + std::to_string(i + 1)] = kReady[i];
  }
  if (hand) {
    for (const char* finger : {"_finger_joint1", "_finger_joint2"}) {
      robot.initial_positions[options.arm_id + finger] = kFingersAtStart;
    }
  }
  applyJointPhysics(physics, options.arm_id, robot);
  return robot;
}

std::uint16_t newestProtocol(const Options& options) {
  return options.protocol != 0 ? options.protocol : (options.robot == "panda" ? 5 : 10);
}

std::uint16_t oldestProtocol(const Options& options) {
  return options.protocol != 0 ? options.protocol : (options.robot == "panda" ? 3 : 6);
}

ControlUnitParameters unitParameters(const Options& options, const std::string& urdf,
                                     const JointPhysics& physics, bool hand) {
  ControlUnitParameters parameters{franka_core::ArmModel::fromUrdf(urdf, options.arm_id)};
  parameters.rotor_inertia = physics.rotor_inertia;
  parameters.coulomb_friction = physics.coulomb_friction;
  parameters.viscous_friction = physics.damping;
  parameters.end_effector = franka_core::endEffectorFromUrdf(urdf, options.arm_id);
  if (hand) {
    parameters.F_T_NE = kHandF_T_NE;
  }
  parameters.has_hand = hand;
  behaveAsOverFci(parameters, newestProtocol(options));
  return parameters;
}

fci::RobotServerParameters serverParameters(const Options& options,
                                            const franka_core::ArmModel& model) {
  fci::RobotServerParameters server;
  server.address = options.ip;
  server.oldest_version = oldestProtocol(options);
  server.newest_version = newestProtocol(options);
  server.model_library = fci::servedLibrary(model);
  server.urdf = fci::servedUrdf(model, server.newest_version);
  return server;
}

// Against the wall clock the ticks go before other work, where the system allows it; where not,
// they are as punctual as the machine's load lets them be.
void preferThisThread() {
  constexpr int kPriority = 70;
  sched_param parameters{};
  parameters.sched_priority = kPriority;
  if (sched_setscheduler(0, SCHED_FIFO, &parameters) == 0) {
    mlockall(MCL_CURRENT | MCL_FUTURE);
  }
}

void serve(const Options& options) {
  const std::string urdf = robotText(options);
  const JointPhysics physics = jointPhysics(options);
  World world(worldFile(options.world));
  const bool hand = urdf.find(options.arm_id + "_finger_joint1") != std::string::npos;
  world.addRobot(describeRobot(options, urdf, physics, hand));

  const ControlUnitParameters unit = unitParameters(options, urdf, physics, hand);
  std::optional<fci::SimRobot::Hand> served_hand;
  if (hand && options.hand) {
    served_hand = fci::SimRobot::Hand{&world.hand(options.arm_id, options.arm_id), {}};
    served_hand->parameters.gains = {kFingerGains, kFingerGains};
  }
  fci::SimRobot robot(unit, world.arm(options.arm_id, options.arm_id),
                      serverParameters(options, unit.model), served_hand);
  std::mutex mutex;
  const bool viewed = options.viewer;
  fci::Host host(
      [&world, &mutex, viewed] {
        // Without a window the world belongs to this thread alone.
        const auto lock =
            viewed ? std::unique_lock<std::mutex>(mutex) : std::unique_lock<std::mutex>();
        world.step();
      },
      options.pace);
  host.add(robot);
  std::optional<fci::LineServer> lines;
  if (options.control_port != 0) {
    lines.emplace(options.ip, options.control_port);
    addPersonCommands(*lines, robot, host, world, stop_requested);
    host.add(*lines);
  }
  std::optional<Viewer> viewer;
  if (viewed) {
    viewer.emplace(world, mutex);
  }

  if (!options.pace.lockstep) {
    preferThisThread();
  }
  std::printf("A simulated %s waits for clients at %s (protocol %s).\n", options.robot.c_str(),
              options.ip.c_str(),
              options.protocol != 0 ? std::to_string(options.protocol).c_str()
                                    : (options.robot == "panda" ? "3 to 5" : "6 to 10"));
  std::fflush(stdout);
  host.run(stop_requested);
}

}  // namespace
}  // namespace franka_sim_mujoco

int main(int argc, char** argv) {
  using namespace franka_sim_mujoco;  // NOLINT: the program's own
  try {
    const Options options = readOptions(argc, argv);
    if (options.help) {
      std::fputs(kUsage, stdout);
      return 0;
    }
    std::signal(SIGINT, requestStop);
    std::signal(SIGTERM, requestStop);
    serve(options);
    return 0;
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "franka_sim: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "franka_sim: %s\n", error.what());
    return 1;
  }
}
