// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/physics/world_models.h>

#include <algorithm>
#include <set>

#include "physics/world/world_impl.h"

namespace franka_sim {

namespace {

constexpr char kScope[] = "::";

bool startsWith(const std::string& text, const std::string& begin) {
  return text.compare(0, begin.size(), begin) == 0;
}

/// Joints with one degree of freedom on one of these bodies.
std::vector<WorldJoint> jointsOn(const mjModel& model, const std::set<int>& bodies) {
  std::vector<WorldJoint> joints;
  for (int j = 0; j < model.njnt; ++j) {
    const char* name = mj_id2name(&model, mjOBJ_JOINT, j);
    const bool slides = model.jnt_type[j] == mjJNT_SLIDE;
    if (name != nullptr && bodies.count(model.jnt_bodyid[j]) > 0 &&
        (slides || model.jnt_type[j] == mjJNT_HINGE)) {
      joints.push_back(
          {name, slides, model.jnt_limited[j] != 0, model.dof_damping[model.jnt_dofadr[j]]});
    }
  }
  return joints;
}

WorldModel modelOfRobot(const physics::RobotModel& robot, const World::Impl& world) {
  WorldModel model;
  model.name = robot.description.name;
  model.body = robot.urdf.links[robot.urdf.root].name;
  std::set<int> bodies;
  for (const physics::UrdfLink& link : robot.urdf.links) {
    // Robots fixed in the world share a link of this name.
    if (link.name != "world") {
      model.links.push_back(link.name);
      bodies.insert(world.frame(link.name).body);
    }
  }
  bodies.erase(0);
  model.joints = jointsOn(*world.model, bodies);
  return model;
}

/// A model of the world file, or an object: SDF names its links name::link, MJCF each separately.
WorldModel modelOfBody(const std::string& name, const Frame& frame, const World::Impl& world) {
  WorldModel model;
  model.name = model.body = name;
  std::set<int> bodies{frame.body};
  for (const auto& [link, place] : world.frames) {
    if (startsWith(link, name + kScope)) {
      model.links.push_back(link);
      bodies.insert(place.body);
    }
  }
  bodies.erase(0);
  if (model.links.empty()) {
    for (const auto& [link, place] : world.frames) {
      // A static body belongs to the world; several of them are not a single model.
      if (link == name || (frame.body != 0 && !link.empty() && place.body != 0 &&
                           world.model->body_rootid[place.body] == frame.body)) {
        model.links.push_back(link);
        bodies.insert(place.body);
      }
    }
    bodies.erase(0);
  }
  model.joints = jointsOn(*world.model, bodies);
  model.is_static = std::all_of(bodies.begin(), bodies.end(),
                                [&](int body) { return world.model->body_weldid[body] == 0; });
  return model;
}

}  // namespace

std::vector<WorldModel> models(const World& world) {
  const World::Impl& impl = implOf(world);
  std::vector<WorldModel> result;
  std::set<std::string> no_models{"", "world"};
  for (const auto& robot : impl.robots) {
    for (const physics::UrdfLink& link : robot->urdf.links) {
      no_models.insert(link.name);
    }
    result.push_back(modelOfRobot(*robot, impl));
  }
  std::set<std::string> scopes;  // of links: SDF models
  for (const auto& [name, frame] : impl.frames) {
    const std::size_t scope = name.find(kScope);
    if (scope != std::string::npos) {
      scopes.insert(name.substr(0, scope));
      no_models.insert(name);
    }
  }
  for (const auto& [name, frame] : impl.frames) {
    const bool is_top = frame.body == 0 || impl.model->body_parentid[frame.body] == 0;
    if (no_models.count(name) == 0 && (is_top || scopes.count(name) > 0)) {
      result.push_back(modelOfBody(name, frame, impl));
    }
  }
  return result;
}

}  // namespace franka_sim
