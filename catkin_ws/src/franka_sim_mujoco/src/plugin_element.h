// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace franka_sim_mujoco {

/// The <gazebo><plugin> element of ros_control in a URDF.
struct PluginElement {
  std::string name;             ///< of the plugin
  std::string hardware_type;    ///< its robotSimType; empty: the URDF has no such element
  std::string robot_namespace;  ///< empty: the spawner's
  int control_ticks{1};         ///< controlPeriod in ticks of 1 ms
  /// The arm_id of each transmission of the type franka_hw/FrankaStateInterface; empty if another
  /// hardware than FrankaHWSim is named.
  std::vector<std::string> arms;
};

/// Reads the plugin element. Of several in one namespace, that of FrankaHWSim is preferred, which
/// drives all joints of the URDF.
/// @param spawn_namespace of plugins that name none
/// @throws std::runtime_error with a sentence: not XML, a wrong controlPeriod, one arm twice, and,
/// naming both, plugins in several namespaces
PluginElement readPluginElement(const std::string& urdf, const std::string& spawn_namespace);

}  // namespace franka_sim_mujoco
