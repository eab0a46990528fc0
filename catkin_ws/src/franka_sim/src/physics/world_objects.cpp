// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// World: objects and external changes at run time.

#include <franka_sim/physics/sizes.h>
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

void World::addObject(const std::string& name, const std::string& text, const Pose& pose) {
  impl_->checkNewBody(name, "Object '" + name + "'");
  const auto names = robots();
  if (std::find(names.begin(), names.end(), name) != names.end()) {
    throw std::runtime_error("Object '" + name +
                             "' cannot be put into the simulated world: a robot "
                             "has that name; choose another one.");
  }
  sizes::check(pose.position, sizes::kFarthest, "m",
               "The position in the pose of object '" + name + "'");
  auto new_world = impl_->world->with(name, text, pose);
  auto same_robots = impl_->copyRobots();
  impl_->rebuild(&same_robots, std::move(new_world));
}

void World::removeObject(const std::string& name) {
  auto new_world = impl_->world->without(name);
  auto same_robots = impl_->copyRobots();
  impl_->rebuild(&same_robots, std::move(new_world));
}

std::vector<std::string> World::objects() const { return impl_->world->objects(); }

std::string World::unsupported(const std::string& object) const {
  std::string list;
  for (const std::string& what : impl_->world->unsupported(object)) {
    list += (list.empty() ? "" : "; ") + what;
  }
  const std::string subject = object.empty() ? impl_->world->title() : "Object '" + object + "'";
  return list.empty() ? list : subject + " has elements that are not simulated: " + list + ".";
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
  sizes::check(gravity, sizes::kGravity, "m/s^2", "Gravity");
  impl_->set_gravity = gravity;
  std::copy(gravity.begin(), gravity.end(), impl_->model->opt.gravity);
}

Twist World::bodyTwist(const std::string& body) const { return bodyStates({body}).front().twist; }

void World::setBodyTwist(const std::string& body, const Twist& twist) {
  const int joint = impl_->freeJoint(body);
  impl_->requireRuns();
  sizes::check(twist.linear, sizes::kFastest, "m/s", "The linear velocity of body '" + body + "'");
  sizes::check(twist.angular, sizes::kFastest, "rad/s",
               "The angular velocity of body '" + body + "'");
  const Frame frame = impl_->frame(body);
  const Eigen::Isometry3d pose = impl_->pose(frame);
  const Eigen::Isometry3d body_pose = pose * frame.pose.inverse();
  double* qvel = impl_->data->qvel + impl_->model->jnt_dofadr[joint];
  // MuJoCo: linear velocity in world axes, angular velocity in body axes.
  const Eigen::Vector3d lever = body_pose.translation() - pose.translation();
  Eigen::Vector3d::Map(qvel) = vector(twist.linear) + vector(twist.angular).cross(lever);
  Eigen::Vector3d::Map(qvel + 3) = body_pose.linear().transpose() * vector(twist.angular);
}

void World::setJointVelocity(const std::string& joint, double velocity) {
  const physics::JointSlot slot = impl_->slot(joint);
  impl_->requireRuns();
  sizes::check(velocity, sizes::kFastest, "m/s or rad/s", "The velocity for joint '" + joint + "'");
  impl_->data->qvel[slot.dof] = velocity;
}

struct Snapshot::Content {
  std::uint64_t generation, ticks;
  physics::DataPtr data;
  physics::MotorSide motor_side;
  physics::JointFrictions frictions;
  std::vector<Push> pushes;
  bool contacts_kept;
  std::vector<GeomContact> contacts;
  std::vector<double> eq_data;
  std::vector<unsigned char> eq_active;
  std::array<double, 3> gravity;
  std::map<std::string, physics::MujocoArm> arms;
  std::map<std::string, physics::MujocoDrive> drives;
};

Snapshot World::snapshot() const {
  impl_->requireRuns();
  const mjModel& model = *impl_->model;
  auto content = std::make_shared<Snapshot::Content>();
  content->generation = impl_->generation;
  content->ticks = impl_->ticks;
  content->data.reset(mj_copyData(nullptr, &model, impl_->data.get()));
  if (!content->data) {
    throw std::runtime_error("There is not enough memory for a snapshot of the simulated world.");
  }
  content->motor_side = impl_->motor_side;
  content->frictions = impl_->frictions;
  content->pushes = impl_->pushes;
  content->contacts_kept = impl_->contacts_kept;
  content->contacts = impl_->kept_contacts;
  content->eq_data.assign(model.eq_data, model.eq_data + mjNEQDATA * model.neq);
  content->eq_active.assign(model.eq_active, model.eq_active + model.neq);
  content->gravity = gravity();
  for (const auto& [key, arm] : impl_->arms) {
    content->arms.emplace(key, *arm);
  }
  for (const auto& [joint, drive] : impl_->drives) {
    content->drives.emplace(joint, *drive);
  }
  return Snapshot(content);
}

void World::restore(const Snapshot& snapshot) {
  const Snapshot::Content* content = snapshot.content();
  if (content == nullptr || content->generation != impl_->generation) {
    throw std::runtime_error(
        "The snapshot cannot be restored: a robot or object came or went since it was taken. Take "
        "another one.");
  }
  mjModel& model = *impl_->model;
  impl_->forgetFaults();
  setGravity(content->gravity);
  mj_copyData(impl_->data.get(), &model, content->data.get());
  std::copy(content->eq_data.begin(), content->eq_data.end(), model.eq_data);
  std::copy(content->eq_active.begin(), content->eq_active.end(), model.eq_active);
  impl_->motor_side = content->motor_side;
  impl_->frictions = content->frictions;
  impl_->pushes = content->pushes;
  impl_->preparation.drop();
  impl_->contacts_kept = content->contacts_kept;
  impl_->kept_contacts = content->contacts;
  impl_->ticks = content->ticks;
  impl_->kinematics_fresh = false;
  for (auto& [key, arm] : impl_->arms) {
    const auto then = content->arms.find(key);
    if (then != content->arms.end()) {
      *arm = then->second;
    } else {
      arm->reset();
    }
  }
  for (auto& [joint, drive] : impl_->drives) {
    const auto then = content->drives.find(joint);
    if (then != content->drives.end()) {
      *drive = then->second;
    } else {
      drive->reset();
    }
  }
}

}  // namespace franka_sim
