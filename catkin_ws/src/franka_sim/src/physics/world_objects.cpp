// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// World: its content by name (bodies grouped into models, joints, cameras), and external changes
/// at run time.

#include <franka_sim/physics/body_properties.h>
#include <franka_sim/physics/world.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "physics/world_impl.h"

namespace franka_sim {
namespace {

bool hasOneDegree(const mjModel& model, int joint) {
  return model.jnt_type[joint] == mjJNT_HINGE || model.jnt_type[joint] == mjJNT_SLIDE;
}

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
  for (const std::string& what : notes) {
    list += (list.empty() ? "" : "; ") + what;
  }
  return list.empty() ? list
                      : subject + " has elements that are not simulated as written: " + list + ".";
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

std::vector<std::string> World::frames() const {
  std::vector<std::string> names;
  for (const NamedFrame& named : impl_->ordered_frames) {
    names.push_back(named.name);
  }
  return names;
}

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

std::vector<WorldModel> World::models() const {
  std::vector<WorldModel> result;
  std::set<std::string> no_models{"", "world"};
  for (const auto& robot : impl_->robots) {
    for (const physics::UrdfLink& link : robot->urdf.links) {
      no_models.insert(link.name);
    }
    result.push_back(modelOfRobot(*robot, *impl_));
  }
  std::set<std::string> scopes;  // of links: SDF models
  for (const auto& [name, frame] : impl_->frames) {
    const std::size_t scope = name.find(kScope);
    if (scope != std::string::npos) {
      scopes.insert(name.substr(0, scope));
      no_models.insert(name);
    }
  }
  for (const auto& [name, frame] : impl_->frames) {
    const bool is_top = frame.body == 0 || impl_->model->body_parentid[frame.body] == 0;
    if (no_models.count(name) == 0 && (is_top || scopes.count(name) > 0)) {
      result.push_back(modelOfBody(name, frame, *impl_));
    }
  }
  return result;
}

std::vector<BodyState> World::bodyStates(const std::vector<std::string>& names) const {
  std::vector<BodyState> states;
  for (const std::string& name : names) {
    states.push_back({bodyPose(name), Twist{}});
  }
  // Velocities at the present positions; mj_comVel writes what the next step computes anyway.
  mj_comPos(impl_->model.get(), impl_->data.get());
  mj_comVel(impl_->model.get(), impl_->data.get());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const int body = impl_->frame(names[i]).body;
    double velocity[6];  // angular, linear at the body's origin
    mj_objectVelocity(impl_->model.get(), impl_->data.get(), mjOBJ_XBODY, body, velocity, 0);
    const Eigen::Vector3d angular(velocity[0], velocity[1], velocity[2]);
    const Eigen::Vector3d linear(velocity[3], velocity[4], velocity[5]);
    const Eigen::Map<const Eigen::Vector3d> at(impl_->data->xpos + 3 * body);
    const Eigen::Map<const Eigen::Vector3d> origin(states[i].pose.position.data());
    states[i].twist = {array(linear + angular.cross(origin - at)), array(angular)};
  }
  return states;
}

std::vector<WorldCamera> World::cameras() const {
  std::vector<WorldCamera> result;
  const mjModel& model = *impl_->model;
  for (int c = 0; c < model.ncam; ++c) {
    const char* name = mj_id2name(&model, mjOBJ_CAMERA, c);
    if (name == nullptr) {
      continue;
    }
    WorldCamera camera;
    camera.name = name;
    camera.field_of_view = model.cam_fovy[c];
    if (model.nuser_cam >= 3) {
      const double* user = model.cam_user + c * model.nuser_cam;
      const auto whole = [](double value, int fallback) {
        return value >= 1 && value <= 4096 ? static_cast<int>(std::lround(value)) : fallback;
      };
      camera.width = whole(user[0], camera.width);
      camera.height = whole(user[1], camera.height);
      camera.rate = user[2] > 0 ? user[2] : camera.rate;
    }
    result.push_back(camera);
  }
  return result;
}

void World::setGravity(const std::array<double, 3>& gravity) {
  sizes::check(gravity, sizes::kMaxGravity, "m/s^2", "Gravity");
  impl_->set_gravity = gravity;
  std::copy(gravity.begin(), gravity.end(), impl_->model->opt.gravity);
  impl_->disturb();
}

Twist World::bodyTwist(const std::string& body) const { return bodyStates({body}).front().twist; }

void World::setBodyTwist(const std::string& body, const Twist& twist) {
  const int joint = impl_->freeJoint(body);
  impl_->requireRuns();
  sizes::check(twist.linear, sizes::kMaxVelocity, "m/s",
               "The linear velocity of body '" + body + "'");
  sizes::check(twist.angular, sizes::kMaxVelocity, "rad/s",
               "The angular velocity of body '" + body + "'");
  const Frame frame = impl_->frame(body);
  const Eigen::Isometry3d pose = impl_->pose(frame);
  const Eigen::Isometry3d body_pose = pose * frame.pose.inverse();
  double* qvel = impl_->data->qvel + impl_->model->jnt_dofadr[joint];
  // MuJoCo: linear velocity in world axes, angular velocity in body axes.
  const Eigen::Vector3d lever = body_pose.translation() - pose.translation();
  Eigen::Vector3d::Map(qvel) = vector(twist.linear) + vector(twist.angular).cross(lever);
  Eigen::Vector3d::Map(qvel + 3) = body_pose.linear().transpose() * vector(twist.angular);
  impl_->disturb();
}

void World::setJointVelocity(const std::string& joint, double velocity) {
  const physics::JointSlot slot = impl_->slot(joint);
  impl_->requireRuns();
  sizes::check(velocity, sizes::kMaxVelocity, "m/s or rad/s",
               "The velocity for joint '" + joint + "'");
  impl_->data->qvel[slot.dof] = velocity;
  impl_->disturb();
}

}  // namespace franka_sim
