// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The steps of a world: pushes, contacts, faults, preparation and reset.
#include <algorithm>
#include <string>

#include "physics/engine/rotations.h"
#include "physics/world/world_impl.h"

namespace franka_sim {

namespace {

Eigen::Isometry3d poseOf(const mjData& data, int body) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Map<const Eigen::Vector3d>(data.xpos + 3 * body);
  const double* q = data.xquat + 4 * body;
  pose.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  return pose;
}

bool isOfRobot(const physics::Ownership& owners, const mjContact& contact) {
  return owners.robot_of_geom[contact.geom1] >= 0 || owners.robot_of_geom[contact.geom2] >= 0;
}

}  // namespace

void World::Impl::updateKinematics() noexcept {
  // A step leaves the poses of the state before it.
  if (kinematics_fresh) {
    return;
  }
  // mj_kinematics normalizes quaternions in place; reading must not change later results.
  physics::copyQuaternions(*model, data->qpos, kept_qpos.data());
  mj_kinematics(model.get(), data.get());
  physics::copyQuaternions(*model, kept_qpos.data(), data->qpos);
  kinematics_fresh = true;
}

void World::Impl::disturb() noexcept {
  kinematics_fresh = false;
  clearance.disturb();
  object_rest.disturb();
  preparation.drop();
}

bool World::Impl::isObject(int body) const noexcept {
  return owners.robot_of_body[body] < 0 && model->body_weldid[body] != 0;
}

bool World::Impl::isPushed() const noexcept { return !pushes.empty() || !without_gravity.empty(); }

bool World::Impl::pushesObjects() const noexcept {
  const auto& floating = without_gravity.bodies();
  return std::any_of(pushes.begin(), pushes.end(),
                     [this](const Push& push) { return isObject(push.body); }) ||
         std::any_of(floating.begin(), floating.end(), [this](int body) { return isObject(body); });
}

Eigen::Isometry3d World::Impl::pose(const Frame& frame) {
  updateKinematics();
  return poseOf(*data, frame.body) * frame.pose;
}

void World::Impl::addPush(const Push& push) {
  pushes.push_back(push);
  if (isObject(push.body)) {  // what was decided or prepared for the next tick holds it
    object_rest.disturb();
    preparation.drop();
  }
}

void World::Impl::applyPushes() noexcept {
  kinematics_fresh = false;
  updateKinematics();
  clearPushes();
  for (const Push& push : pushes) {
    if (push.dof >= 0) {
      data->qfrc_applied[push.dof] += push.effort;
      continue;
    }
    // MuJoCo applies forces at the center of mass.
    const Eigen::Vector3d point = poseOf(*data, push.body) * push.point;
    const Eigen::Map<const Eigen::Vector3d> com(data->xipos + 3 * push.body);
    double* wrench = data->xfrc_applied + 6 * push.body;
    Eigen::Map<Eigen::Vector3d>(wrench) += push.force;
    Eigen::Map<Eigen::Vector3d>(wrench + 3) += push.torque + (point - com).cross(push.force);
  }
  without_gravity.push(*model, data.get());
}

void World::Impl::clearPushes() noexcept {
  mju_zero(data->xfrc_applied, 6 * model->nbody);
  for (const Push& push : pushes) {
    if (push.dof >= 0) {
      data->qfrc_applied[push.dof] = 0.0;
    }
  }
}

void World::Impl::retirePushes() noexcept {
  clearPushes();  // a tick applies those that remain
  for (Push& push : pushes) {
    --push.ticks_left;
  }
  const auto over = [](const Push& push) { return push.ticks_left == 0; };
  pushes.erase(std::remove_if(pushes.begin(), pushes.end(), over), pushes.end());
}

void World::Impl::stop(const physics::EngineError& error) noexcept {
  data->pstack = 0;  // of a function that has not returned
  fault_text = std::string(error.what()) + ". The world stands still until it is reset.";
  stop(physics::StepFault{physics::StepFault::Where::kEngine});
}

void World::Impl::stop(const physics::StepFault& why) noexcept {
  fault = why;
  mju_zero(data->qvel, model->nv);
  mju_zero(data->qfrc_applied, model->nv);
  data->ncon = 0;
  pushes.clear();
  motor_side.reset(*data);
  disturb();
  contacts_kept = false;
  objects_held = false;
}

int World::Impl::startTick() {
  clearance.startTick(model.get(), data.get());
  object_rest.startTick(*data, clearance.areObjectsClear() && !pushesObjects(),
                        [this]() -> const std::vector<GeomContact>& { return contacts(); });
  collisions.leaveOut(clearance.isClear(), object_rest.held());
  const bool one =
      substeps == Substeps::kAdaptive && clearance.isClear() && frictions.longestStep() >= kTick;
  const int count = one ? 1 : kSmallSteps;
  model->opt.timestep = kTick / count;
  return count;
}

void World::Impl::step() noexcept {
  if (fault) {
    return;
  }
  try {
    const physics::EngineErrorScope scope;
    advance();
  } catch (const physics::EngineError& error) {
    stop(error);
  }
}

void World::Impl::advance() {
  const int count = startTick();
  motor_side.startTick(*model, *data);
  object_rest.startSteps(*data, motor_side);
  for (int substep = 0; substep < count; ++substep) {
    if (isPushed()) {
      applyPushes();
    }
    for (auto& [joint, drive] : drives) {
      drive->prepare(substep + 1, count);
    }
    if (const auto why =
            preparation.step(model.get(), data.get(), collisions, frictions, hold_limits)) {
      stop(*why);
      return;
    }
    motor_side.addSubstep(*model, *data, frictions);
    object_rest.finishStep(data.get());
  }
  motor_side.finishTick(*model, *data, count, kTick);
  clearance.finishTick();
  object_rest.finishTick(&motor_side);
  if (isPushed()) {
    retirePushes();
  }
  kinematics_fresh = false;
  contacts_kept = false;
  objects_held = object_rest.held();
  ++ticks;
}

void World::Impl::prepareStep() noexcept {
  if (fault) {
    return;
  }
  contacts();
  contacts_kept = true;
  try {
    const physics::EngineErrorScope scope;
    startTick();
    preparation.prepare(model.get(), data.get(), collisions);
    kinematics_fresh = true;
  } catch (const physics::EngineError& error) {
    stop(error);
  }
}

void World::Impl::setPreparesBeside(bool beside) {
  if (!beside) {
    preparation_thread.reset();
  } else if (!preparation_thread) {
    preparation_thread = std::make_unique<physics::PreparationThread>([this] { prepareStep(); });
  }
  view.preparation_thread = preparation_thread.get();
}

void World::Impl::prepareBeside() noexcept {
  if (preparation_thread) {
    preparation_thread->request();
  }
}

const std::vector<GeomContact>& World::Impl::contacts() noexcept {
  if (contacts_kept) {
    return kept_contacts;
  }
  kept_contacts.clear();
  for (int c = 0; c < data->ncon; ++c) {
    const mjContact& contact = data->contact[c];
    if (contact.efc_address < 0 || (objects_held && !isOfRobot(owners, contact))) {
      continue;
    }
    double local[6];
    mj_contactForce(model.get(), data.get(), c, local);
    GeomContact& kept = kept_contacts.emplace_back();
    kept.geom1 = contact.geom1;
    kept.geom2 = contact.geom2;
    std::copy_n(contact.pos, 3, kept.position.begin());
    // Rows of `frame` are the contact's axes; the first points from geom 1 to geom 2.
    mju_rotVecMatT(kept.force.data(), local, contact.frame);
  }
  if (objects_held) {
    const std::vector<GeomContact>& held = object_rest.state().contacts;
    kept_contacts.insert(kept_contacts.end(), held.begin(), held.end());
  }
  return kept_contacts;
}

const mjData& World::Impl::findContacts() {
  contacts();
  contacts_kept = true;
  preparation.drop();
  updateKinematics();
  const physics::EngineErrorScope scope;
  mj_collision(model.get(), data.get());
  return *data;
}

void World::Impl::reset() {
  mj_resetData(model.get(), data.get());
  physics::placeInitially(*model, data.get(), robots);
  for (auto& [key, arm] : arms) {
    arm->reset();
  }
  for (auto& [joint, drive] : drives) {
    drive->reset();
  }
  pushes.clear();
  clearFaults();
  motor_side.reset(*data);
  frictions.reset();
  disturb();
  contacts_kept = false;
  objects_held = false;
  kinematics_fresh = false;
  ticks = 0;
}

}  // namespace franka_sim
