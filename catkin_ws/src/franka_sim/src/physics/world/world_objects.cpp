// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// World: its set of robots and objects, which changes at run time.
#include <franka_sim/physics/input_limits.h>
#include <franka_sim/physics/world.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

#include "physics/world/world_impl.h"

namespace franka_sim {
namespace {

using Content = WorldChange::Content;

std::set<std::string> namesOfJoints(const mjModel& model) {
  std::set<std::string> names;
  for (int j = 0; j < model.njnt; ++j) {
    const char* name = mj_id2name(&model, mjOBJ_JOINT, j);
    names.insert(name != nullptr ? name : "");
  }
  return names;
}

bool hasOneDegree(const mjModel& model, int joint) {
  return model.jnt_type[joint] == mjJNT_HINGE || model.jnt_type[joint] == mjJNT_SLIDE;
}

void applyAtOnce(World& world, WorldChange change) {
  change.compile();
  world.apply(change);
}

}  // namespace

std::shared_ptr<Content> World::Impl::beginChange() const {
  auto change = std::make_shared<Content>();
  change->world = world;
  change->robots = robots;
  change->generation = generation;
  return change;
}

WorldChange World::beginAddRobot(const RobotDescription& robot) const {
  const std::string whose = " of the robot '" + robot.name + "'";
  sizes::check(robot.base.position, sizes::kMaxPosition, "m", "The position" + whose);
  for (const auto& [joint, position] : robot.initial_positions) {
    sizes::check(position, sizes::kMaxPosition, "m or rad",
                 "The initial position of joint '" + joint + "'" + whose);
  }
  const auto present = robots();
  if (std::find(present.begin(), present.end(), robot.name) != present.end()) {
    throw std::runtime_error("There is already a robot '" + robot.name +
                             "' in the simulated world; give the new one another name.");
  }
  auto change = impl_->beginChange();
  change->added = robot.name;
  change->describe = [robot, frames = impl_->frames,
                      joints = namesOfJoints(*impl_->model)](Content& content) {
    auto added = std::make_shared<physics::RobotModel>(physics::buildRobot(robot));
    for (const physics::UrdfLink& link : added->urdf.links) {
      if (link.name != "world" && frames.count(link.name) > 0) {
        throw std::runtime_error("Robot '" + robot.name + "' brings a link '" + link.name +
                                 "', and the simulated world has a body of that name already; give "
                                 "the robot another arm_id.");
      }
    }
    for (const physics::UrdfJoint& joint : added->urdf.joints) {
      if (joint.type != physics::UrdfJoint::Type::kFixed && joints.count(joint.name) > 0) {
        throw std::runtime_error("Robot '" + robot.name + "' brings a joint '" + joint.name +
                                 "', and the simulated world has a joint of that name already; "
                                 "give the robot another arm_id.");
      }
    }
    content.robots.push_back(std::move(added));
  };
  return WorldChange(std::move(change));
}

WorldChange World::beginRemoveRobot(const std::string& name) const {
  impl_->robot(name);
  auto change = impl_->beginChange();
  physics::Robots& rest = change->robots;
  const auto is_it = [&](const auto& robot) { return robot->description.name == name; };
  rest.erase(std::remove_if(rest.begin(), rest.end(), is_it), rest.end());
  return WorldChange(std::move(change));
}

WorldChange World::beginAddObject(const std::string& name, const std::string& text,
                                  const Pose& pose) const {
  impl_->checkNewBody(name, "Object '" + name + "'");
  const auto names = robots();
  if (std::find(names.begin(), names.end(), name) != names.end()) {
    throw std::runtime_error("Object '" + name +
                             "' cannot be put into the simulated world: a robot "
                             "has that name; choose another one.");
  }
  sizes::check(pose.position, sizes::kMaxPosition, "m",
               "The position in the pose of object '" + name + "'");
  auto change = impl_->beginChange();
  change->added = name;
  change->describe = [name, text, pose](Content& content) {
    content.world = content.world->with(name, text, pose);
  };
  return WorldChange(std::move(change));
}

WorldChange World::beginRemoveObject(const std::string& name) const {
  auto change = impl_->beginChange();
  change->describe = [name](Content& content) { content.world = content.world->without(name); };
  return WorldChange(std::move(change));
}

void World::apply(WorldChange& change) {
  Content& content = change.content();
  if (!content.model || content.generation != impl_->generation) {
    throw std::logic_error(
        "A change of the simulated world is compiled before it is applied, and no other one is "
        "applied meanwhile.");
  }
  impl_->exchange(content);
  const std::string added = std::exchange(content.added, {});  // reported once
  if (!added.empty()) {
    impl_->news.insert(unsupported(added));
  }
}

void World::addRobot(const RobotDescription& robot) { applyAtOnce(*this, beginAddRobot(robot)); }

void World::removeRobot(const std::string& name) { applyAtOnce(*this, beginRemoveRobot(name)); }

void World::addObject(const std::string& name, const std::string& text, const Pose& pose) {
  applyAtOnce(*this, beginAddObject(name, text, pose));
}

void World::removeObject(const std::string& name) { applyAtOnce(*this, beginRemoveObject(name)); }

std::vector<std::string> World::objects() const { return impl_->world->objects(); }

std::string World::unsupported(const std::string& name) const {
  std::string subject = name.empty() ? impl_->world->title() : "Object '" + name + "'";
  std::set<std::string> notes = impl_->world->unsupported(name);
  for (const auto& robot : impl_->robots) {
    if (robot->description.name == name) {
      subject = "Robot '" + name + "'";
      notes = robot->urdf.notes;
    }
  }
  std::string list;
  bool has_plugins = false;
  for (const std::string& note : notes) {
    has_plugins = has_plugins || note.rfind("plugin ", 0) == 0;
    const bool ends = !note.empty() && note.back() == '.';  // the text of an error
    list += (list.empty() ? "" : "; ") + note.substr(0, note.size() - ends);
  }
  const std::string instead =
      has_plugins ? " What replaces plugins: docs/tutorials/porting_from_noetic.md." : "";
  return list.empty()
             ? list
             : subject + " has elements that are not simulated as written: " + list + "." + instead;
}

std::vector<std::string> World::bodies() const {
  std::vector<std::string> names;
  for (const auto& [name, frame] : impl_->frames) {
    if (!name.empty()) {
      names.push_back(name);
    }
  }
  return names;
}

std::uint64_t World::generation() const noexcept { return impl_->generation; }

std::vector<std::string> World::joints() const {
  std::vector<std::string> names;
  for (int j = 0; j < impl_->model->njnt; ++j) {
    const char* name = mj_id2name(impl_->model.get(), mjOBJ_JOINT, j);
    if (name != nullptr && hasOneDegree(*impl_->model, j)) {
      names.emplace_back(name);
    }
  }
  return names;
}

}  // namespace franka_sim
