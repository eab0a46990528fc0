// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// World: objects and external changes at run time.

#include <franka_sim/physics/body_properties.h>
#include <franka_sim/physics/world.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "physics/world_impl.h"

namespace franka_sim {
namespace {

bool hasOneDegree(const mjModel& model, int joint) {
  return model.jnt_type[joint] == mjJNT_HINGE || model.jnt_type[joint] == mjJNT_SLIDE;
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
