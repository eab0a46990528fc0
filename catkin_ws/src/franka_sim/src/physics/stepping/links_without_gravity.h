// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>
#include <tinyxml2.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace franka_sim::physics {

/// Links that gravity does not pull. MuJoCo 2.2 has no setting for them, so each step pushes them
/// with the opposite of their weight. In a model's text such a link has a site at its center of
/// mass, whose size is the link's mass.
class LinksWithoutGravity {
 public:
  /// Writes one into the body that it belongs to, alone or with others. @param com in the body [m]
  static void write(const std::string& link, double mass, const Eigen::Vector3d& com,
                    tinyxml2::XMLElement* body);
  /// Whether the link is one from which a body has its name.
  static bool has(const mjModel& model, int body);

  LinksWithoutGravity() = default;
  /// Those of a model.
  explicit LinksWithoutGravity(const mjModel& model);

  /// Adds their forces to those of the next step, whose sites and centers of mass are known.
  /// Real-time safe.
  void push(const mjModel& model, mjData* data) const noexcept;

  bool empty() const noexcept { return sites_.empty(); }
  /// The bodies that have such links, some more than once.
  const std::vector<int>& bodies() const noexcept { return bodies_; }

 private:
  std::vector<int> sites_, bodies_;
};

}  // namespace franka_sim::physics
