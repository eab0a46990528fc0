// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/physics/physics_config.h>
#include <franka_sim/physics/world.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <stdexcept>

namespace franka_sim {

namespace {

// External torque [Nm] that a real FR3 reports although nothing touches it: the error of its own
// model, from a public recording (docs/fidelity.md).
constexpr std::array<double, 7> kGravityError{-0.34, -0.39, -0.06, -0.23, -0.05, 0.14, -0.25};

std::string jointName(const std::string& arm_id, std::size_t index) {
  return arm_id + "_joint" + std::to_string(index + 1);
}

/// A list of seven finite numbers under `parent`; if absent, `values` stays as it is.
void readSeven(const YAML::Node& parent, const std::string& key, const std::string& where,
               std::array<double, 7>& values) {
  const YAML::Node node = parent[key];
  if (!node) {
    return;
  }
  const std::string complaint = where + "/" + key + " must be a list of 7 finite numbers.";
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

}  // namespace

JointPhysics readJointPhysics(const std::string& file, const std::string& robot_type,
                              const std::string& friction_set) {
  YAML::Node root;
  try {
    root = YAML::LoadFile(file);
  } catch (const YAML::Exception& error) {
    throw std::runtime_error("The joint physics file " + file + " cannot be read: " + error.what());
  }
  JointPhysics physics;
  const std::string where = file + ": " + robot_type;
  const YAML::Node robot = section(root, robot_type, file);
  readSeven(robot, "rotor_inertia", where, physics.rotor_inertia);
  readSeven(robot, "coulomb_friction", where, physics.coulomb_friction);
  readSeven(robot, "damping", where, physics.damping);
  if (robot["joint_stops"]) {
    JointPhysics::Stops stops{};
    readSeven(robot["joint_stops"], "lower", where + "/joint_stops", stops.lower);
    readSeven(robot["joint_stops"], "upper", where + "/joint_stops", stops.upper);
    physics.stops = stops;
  }
  if (friction_set != "none") {
    const YAML::Node set =
        section(section(root, "friction_sets", file), friction_set, file + ": friction_sets");
    const std::string set_where = file + ": friction_sets/" + friction_set;
    readSeven(set, "rotor_inertia", set_where, physics.rotor_inertia);
    readSeven(set, "coulomb_friction", set_where, physics.coulomb_friction);
    readSeven(set, "damping", set_where, physics.damping);
  }
  return physics;
}

void applyJointPhysics(const JointPhysics& physics, const std::string& arm_id,
                       RobotDescription& description) {
  for (std::size_t i = 0; i < 7; ++i) {
    const std::string joint = jointName(arm_id, i);
    description.rotor_inertia[joint] = physics.rotor_inertia[i];
    description.coulomb_friction[joint] = physics.coulomb_friction[i];
    description.damping[joint] = physics.damping[i];
    if (physics.stops) {
      description.stops[joint] = {physics.stops->lower[i], physics.stops->upper[i]};
    }
  }
}

void startAt(const std::array<double, 7>& q, const std::string& arm_id,
             RobotDescription& description) {
  for (std::size_t i = 0; i < 7; ++i) {
    description.initial_positions[jointName(arm_id, i)] = q[i];
  }
}

void comeToRest(const std::array<double, 7>& stiffness, const std::string& arm_id,
                RobotDescription& description) {
  for (std::size_t i = 0; i < 7; ++i) {
    const auto start = description.initial_positions.find(jointName(arm_id, i));
    if (start != description.initial_positions.end() && stiffness[i] > 0.0) {
      start->second -= kGravityError[i] / stiffness[i];
    }
  }
}

}  // namespace franka_sim
