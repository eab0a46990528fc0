// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tinyxml2.h>

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "physics/contacts/contact_capacity.h"
#include "physics/mjcf/mjcf_object.h"
#include "physics/mjcf/mjcf_robot.h"
#include "physics/mjcf/robot_model.h"

namespace franka_sim::physics {

/// A world file (MJCF or SDF) and objects added later, ready to be merged with robots: includes
/// expanded, file names absolute, the physics settings of this simulator set, geoms named, and
/// compiled once as a check. Immutable.
class MjcfWorld {
 public:
  /// @param file path of the MJCF or SDF; empty: ground, light and sky.
  /// @param resolve finds files that SDF texts name by package:// and model://
  /// @throws std::runtime_error naming the file and what is wrong.
  explicit MjcfWorld(const std::string& file, ResourceResolver resolve = {});

  /// A copy with one object more or less. @throws std::runtime_error with a sentence
  std::unique_ptr<MjcfWorld> with(const std::string& object, const std::string& text,
                                  const Pose& pose) const;
  std::unique_ptr<MjcfWorld> without(const std::string& object) const;

  /// The world with robots as MJCF text. @param visuals visual shapes for the robots
  /// @throws std::runtime_error as writeRobot, or when the world already uses a robot's names.
  std::string merge(const std::vector<const RobotModel*>& robots, bool visuals) const;

  /// "World file <path>" or "The built-in world".
  const std::string& title() const noexcept { return title_; }
  GivenSizes givenSizes() const;
  const std::vector<WorldGeom>& geoms() const noexcept { return geoms_; }
  std::vector<std::string> objects() const;
  /// Further names of bodies.
  std::vector<BodyAlias> aliases() const;
  /// Unsupported elements of the file, or of an object.
  std::set<std::string> unsupported(const std::string& object) const;

 private:
  MjcfWorld(const MjcfWorld& other, std::vector<std::shared_ptr<const MjcfObject>> objects);
  void load(const std::string& file);
  void loadSdf(const std::string& text, const std::string& folder);
  void normalize(const std::string& folder);
  void compose(tinyxml2::XMLDocument* document) const;
  void inspect();
  void rankFrictions(tinyxml2::XMLElement* root) const;

  std::string title_;
  ResourceResolver resolve_;
  tinyxml2::XMLDocument document_;
  std::vector<std::shared_ptr<const MjcfObject>> objects_;
  std::vector<BodyAlias> aliases_;
  std::set<std::string> unsupported_;
  double angle_unit_{1};
  std::vector<WorldGeom> geoms_;
  bool has_priorities_{false};  ///< the author set which geom's friction counts
};

}  // namespace franka_sim::physics
