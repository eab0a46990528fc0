// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <franka_sim/physics/physics_config.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <stdexcept>

namespace franka_sim {

namespace {

// External torque [Nm] that a real FR3 reports although nothing touches it: the error of its own
// model, from a public recording (docs/fidelity.md).
constexpr std::array<double, 7> kGravityError{-0.34, -0.39, -0.06, -0.23, -0.05, 0.14, -0.25};

std::string jointName(const std::string& arm_id, std::size_t index) {
  return arm_id + "_joint" + std::to_string(index + 1);
}

/// A list of finite numbers under `parent`; if absent, `values` stays as it is.
template <std::size_t N>
void readNumbers(const YAML::Node& parent, const std::string& key, const std::string& where,
                 std::array<double, N>& values) {
  const YAML::Node node = parent[key];
  if (!node) {
    return;
  }
  const std::string complaint =
      where + "/" + key + " must be a list of " + std::to_string(N) + " finite numbers.";
  if (!node.IsSequence() || node.size() != values.size()) {
    throw std::runtime_error(complaint);
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    double number;
    if (!YAML::convert<double>::decode(node[i], number) || !std::isfinite(number)) {
      throw std::runtime_error(complaint);
    }
    values[i] = number;
  }
}

YAML::Node section(const YAML::Node& parent, const std::string& key, const std::string& where) {
  const YAML::Node node = parent[key];
  if (!node || !node.IsMap()) {
    throw std::runtime_error(where + " has no section '" + key + "'.");
  }
  return node;
}

/// A number under `parent`, within a range; if absent, `value` stays as it is.
void readOne(const YAML::Node& parent, const std::string& key, const std::string& where,
             double least, double most, double& value) {
  const YAML::Node node = parent[key];
  if (!node) {
    return;
  }
  double number;
  if (!YAML::convert<double>::decode(node, number) || !(number >= least && number <= most)) {
    throw std::runtime_error(where + "/" + key + " must be a number from " +
                             franka_core::numberText(least) + " to " +
                             franka_core::numberText(most) + ".");
  }
  value = number;
}

YAML::Node loadYaml(const std::string& file) {
  try {
    return YAML::LoadFile(file);
  } catch (const YAML::Exception& error) {
    throw std::runtime_error("The file of a robot's physics " + file +
                             " cannot be read: " + error.what());
  }
}

/// Names of the keys of a map that are not in `known`, so that no misspelt key is ignored.
void checkKeys(const YAML::Node& map, const std::set<std::string>& known,
               const std::string& where) {
  for (const auto& entry : map) {
    const auto key = entry.first.as<std::string>();
    if (known.count(key) == 0) {
      throw std::runtime_error(where + " has the unknown entry '" + key + "'.");
    }
  }
}

void readFriction(const YAML::Node& part, const std::string& where,
                  std::array<JointFriction, 7>& friction) {
  struct Entry {
    const char* key;
    double JointFriction::* member;
  };
  constexpr Entry kEntries[] = {
      {"amplitude", &JointFriction::amplitude}, {"slope", &JointFriction::slope},
      {"offset", &JointFriction::offset},       {"coulomb", &JointFriction::coulomb},
      {"viscous", &JointFriction::viscous},     {"damping", &JointFriction::damping}};
  checkKeys(part, {"amplitude", "slope", "offset", "coulomb", "viscous", "damping"}, where);
  for (const Entry& entry : kEntries) {
    std::array<double, 7> values;
    for (std::size_t i = 0; i < 7; ++i) {
      values[i] = friction[i].*entry.member;
    }
    readNumbers(part, entry.key, where, values);
    for (std::size_t i = 0; i < 7; ++i) {
      friction[i].*entry.member = values[i];
    }
  }
}

void readNoise(const YAML::Node& part, const std::string& where, SensorPhysics& sensors) {
  checkKeys(part,
            {"tau_J_resolution", "tau_J_second_difference", "dq_noise", "tau_J_ripple",
             "ripple_frequency"},
            where);
  std::array<double, 7> second_difference{};
  readNumbers(part, "tau_J_resolution", where, sensors.tau_J_resolution);
  readNumbers(part, "tau_J_second_difference", where, second_difference);
  readNumbers(part, "dq_noise", where, sensors.dq_noise);
  readNumbers(part, "tau_J_ripple", where, sensors.tau_J_ripple);
  readNumbers(part, "ripple_frequency", where, sensors.ripple_frequency);
  for (std::size_t i = 0; i < 7; ++i) {
    // The second difference of independent readings has six (1 + 4 + 1) times the variance of one
    // reading; rounding contributes step^2 / 12 to that variance.
    const double step = sensors.tau_J_resolution[i];
    const double variance = second_difference[i] * second_difference[i] / 6.0 - step * step / 12.0;
    sensors.tau_J_noise[i] = std::sqrt(std::max(variance, 0.0));
  }
}

// The figures are ranges; the seed chooses a robot among them.
void drawModelError(const YAML::Node& part, const std::string& where, std::uint64_t seed,
                    RobotPhysics& physics) {
  checkKeys(part, {"torque_offset", "link_mass", "link_centre"}, where);
  std::array<double, 7> offset{};
  double mass = 0.0;
  double center = 0.0;
  readNumbers(part, "torque_offset", where, offset);
  readOne(part, "link_mass", where, 0.0, 0.5, mass);
  readOne(part, "link_centre", where, 0.0, 0.1, center);
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> one(-1.0, 1.0);
  for (std::size_t i = 0; i < 7; ++i) {
    physics.torque_offset[i] = offset[i] * one(engine);
    physics.link_errors[i].mass = mass * one(engine);
    for (double& shift : physics.link_errors[i].center) {
      shift = center * one(engine);
    }
  }
}

void readGripper(const YAML::Node& part, const std::string& where, GripperLatency& latency) {
  checkKeys(part, {"start", "shortest"}, where);
  readOne(part, "start", where, 0.0, 10.0, latency.start);
  readOne(part, "shortest", where, 0.0, 10.0, latency.shortest);
}

/// Reads the parts that the realism turns on.
void readParts(const YAML::Node& robot, const std::string& where, const Realism& realism,
               RobotPhysics& physics) {
  const auto read = [&](bool present, const char* name, const auto& reader) {
    if (present) {
      reader(section(robot, name, where), where + "/" + name);
    }
  };
  using Node = YAML::Node;
  using Text = std::string;
  read(realism.motors, "motors", [&](const Node& part, const Text& there) {
    checkKeys(part, {"inertia"}, there);
    readNumbers(part, "inertia", there, physics.joints.rotor_inertia);
  });
  read(realism.friction, "friction", [&](const Node& part, const Text& there) {
    readFriction(part, there, physics.joints.friction);
  });
  read(realism.bandwidth, "bandwidth", [&](const Node& part, const Text& there) {
    checkKeys(part, {"tau_ext_hat_filtered"}, there);
    readNumbers(part, "tau_ext_hat_filtered", there, physics.sensors.tau_ext_cutoff);
  });
  read(realism.noise, "noise",
       [&](const Node& part, const Text& there) { readNoise(part, there, physics.sensors); });
  read(realism.model_error, "model_error", [&](const Node& part, const Text& there) {
    drawModelError(part, there, realism.seed, physics);
  });
  read(realism.gripper, "gripper",
       [&](const Node& part, const Text& there) { readGripper(part, there, physics.gripper); });
}

void checkPhysics(const RobotPhysics& physics, const std::string& where) {
  const auto require = [&](const std::array<double, 7>& values, bool zero, const char* what) {
    if (std::any_of(values.begin(), values.end(),
                    [&](double v) { return zero ? v < 0.0 : v <= 0.0; })) {
      throw std::runtime_error(where + ": " + what +
                               (zero ? " must not be negative." : " must be positive."));
    }
  };
  require(physics.sensors.tau_ext_cutoff, false, "the bandwidth of tau_ext_hat_filtered");
  require(physics.sensors.tau_J_resolution, true, "the resolution of tau_J");
  require(physics.sensors.tau_J_noise, true, "the noise of tau_J");
  require(physics.sensors.dq_noise, true, "the noise of dq");
}

/// Figures of one robot, as fitted to a recording (docs/sim_to_real.md).
void readOwnRobot(const std::string& file, RobotPhysics& physics) {
  const YAML::Node root = loadYaml(file);
  if (!root.IsMap()) {
    throw std::runtime_error(file + " must be a map with the entries of docs/sim_to_real.md.");
  }
  checkKeys(root, {"friction", "torque_offset", "payload"}, file);
  if (root["friction"]) {
    readFriction(section(root, "friction", file), file + ": friction", physics.joints.friction);
  }
  readNumbers(root, "torque_offset", file, physics.torque_offset);
  if (root["payload"]) {
    const YAML::Node payload = section(root, "payload", file);
    const std::string where = file + ": payload";
    checkKeys(payload, {"mass", "centre"}, where);
    LinkError& flange = physics.link_errors[7];
    readOne(payload, "mass", where, 0.0, 10.0, flange.added_mass);
    readNumbers(payload, "centre", where, flange.added_at);
  }
}

}  // namespace

RobotPhysics readRobotPhysics(const std::string& file, const std::string& robot_type,
                              const Realism& realism) {
  const YAML::Node robot = section(loadYaml(file), robot_type, file);
  const std::string where = file + ": " + robot_type;
  RobotPhysics physics;
  readNumbers(robot, "rotor_inertia", where, physics.joints.rotor_inertia);
  if (robot["joint_stops"]) {
    JointPhysics::Stops stops{};
    readNumbers(robot["joint_stops"], "lower", where + "/joint_stops", stops.lower);
    readNumbers(robot["joint_stops"], "upper", where + "/joint_stops", stops.upper);
    physics.joints.stops = stops;
  }
  readParts(robot, where, realism, physics);
  physics.sensors.seed = realism.seed;
  physics.command_delay = realism.delay;
  if (!realism.file.empty()) {
    readOwnRobot(realism.file, physics);
  }
  checkPhysics(physics, where);
  return physics;
}

void applyPhysics(const RobotPhysics& physics, const std::string& arm_id,
                  RobotDescription& description) {
  for (std::size_t i = 0; i < 7; ++i) {
    const std::string joint = jointName(arm_id, i);
    description.rotor_inertia[joint] = physics.joints.rotor_inertia[i];
    description.torque_offset[joint] = physics.torque_offset[i];
    if (physics.joints.friction[i].acts()) {
      description.friction[joint] = physics.joints.friction[i];
    }
    if (physics.joints.stops) {
      description.stops[joint] = {physics.joints.stops->lower[i], physics.joints.stops->upper[i]};
    }
  }
  for (std::size_t i = 0; i < physics.link_errors.size(); ++i) {
    if (physics.link_errors[i].exists()) {
      description.link_errors[arm_id + "_link" + std::to_string(i + 1)] = physics.link_errors[i];
    }
  }
}

void applyPhysics(const RobotPhysics& physics, ControlUnitParameters& parameters) {
  parameters.rotor_inertia = physics.joints.rotor_inertia;
  parameters.sensors = physics.sensors;
}

void setInitialPositions(const std::array<double, 7>& q, const std::string& arm_id,
                         RobotDescription& description) {
  for (std::size_t i = 0; i < 7; ++i) {
    description.initial_positions[jointName(arm_id, i)] = q[i];
  }
}

void applyRestOffset(const std::array<double, 7>& stiffness, const std::string& arm_id,
                     RobotDescription& description) {
  for (std::size_t i = 0; i < 7; ++i) {
    const auto start = description.initial_positions.find(jointName(arm_id, i));
    if (start != description.initial_positions.end() && stiffness[i] > 0.0) {
      start->second -= kGravityError[i] / stiffness[i];
    }
  }
}

}  // namespace franka_sim
