// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/world/world_impl.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "physics/mjcf/rotations.h"
#include "physics/pictures/scene_model.h"

namespace franka_sim {

using physics::JointSlot;
using physics::RobotModel;

namespace {

constexpr std::size_t kExpectedPushes = 64;

std::string nameOf(const mjModel& model, int type, int id) {
  const char* name = mj_id2name(&model, type, id);
  return name != nullptr ? name : "";
}

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

World::Impl::Impl(const std::string& file, ResourceResolver resolve)
    : world(std::make_shared<physics::MjcfWorld>(file, std::move(resolve))) {
  pushes.reserve(kExpectedPushes);
  const auto first = beginChange();
  first->compile();
  exchange(*first);
}

void World::Impl::exchange(WorldChange::Content& change) {
  faultText();  // while its model still exists
  if (set_gravity) {
    std::copy(set_gravity->begin(), set_gravity->end(), change.model->opt.gravity);
  }
  std::map<std::string, WorldLight> kept_lights;
  for (const auto& [name, light] : set_lights) {
    const int id = mj_name2id(change.model.get(), mjOBJ_LIGHT, name.c_str());
    if (id >= 0) {
      physics::writeLight(change.model.get(), id, light);
      kept_lights.emplace(name, light);
    }
  }
  std::map<std::string, double> torques;
  const physics::JointFrictions old_frictions = frictions;
  if (model) {
    physics::carryState(*model, *data, *change.model, change.data.get());
    for (int j = 0; j < model->njnt; ++j) {
      torques[nameOf(*model, mjOBJ_JOINT, j)] = motor_side.torque(model->jnt_dofadr[j]);
    }
  }
  // Nothing below throws, except for lack of memory.
  robots.swap(change.robots);
  world.swap(change.world);
  std::swap(identity, change.identity);
  set_lights.swap(kept_lights);
  model.swap(change.model);
  data.swap(change.data);
  data->ncon = 0;  // those of a model that was taken back
  generation = change.generation = physics::uniqueModelNumber();
  index(change);
  for (const auto& [joint, torque] : torques) {
    const int id = mj_name2id(model.get(), mjOBJ_JOINT, joint.c_str());
    if (id >= 0) {
      motor_side.setTorque(model->jnt_dofadr[id], torque);
    }
  }
  frictions.carry(old_frictions);
}

void World::Impl::orderFrames() {
  ordered_frames.clear();
  for (int b = 0; b < model->nbody; ++b) {
    const std::string name = nameOf(*model, mjOBJ_BODY, b);
    const auto found = frames.find(name);
    const bool is_own = !name.empty() && found->second.body == b;
    ordered_frames.push_back(
        {name, is_own ? found->second : Frame{b, Eigen::Isometry3d::Identity()}});
  }
  for (const auto& [name, frame] : frames) {
    if (!name.empty() && ordered_frames[frame.body].name != name) {
      ordered_frames.push_back({name, frame});
    }
  }
}

void World::Impl::index(WorldChange::Content& change) {
  visual_mjcf.clear();
  warned = {};
  view = {model.get(), data.get(), &motor_side, &hold_limits, preparation_thread.get()};
  kinematics_fresh = false;
  kept_qpos.assign(model->nq, 0.0);
  preparation.fit(*model);
  owners = physics::Ownership(*model, physics::robotOfBody(*model, robots));
  clearance.fit(*model, owners);
  object_rest.fit(*model, owners);
  collisions.fit(*model, owners);
  without_gravity = physics::LinksWithoutGravity(*model);
  contacts_kept = false;
  objects_held = false;
  kept_contacts.reserve(model->nconmax);
  frames.clear();
  for (int b = 0; b < model->nbody; ++b) {
    frames[nameOf(*model, mjOBJ_BODY, b)] = {b, Eigen::Isometry3d::Identity()};
  }
  for (const physics::BodyAlias& alias : world->aliases()) {
    const auto body = frames.find(alias.body);
    if (body != frames.end()) {
      frames.insert({alias.name, {body->second.body, body->second.pose * alias.pose}});
    }
  }
  for (const auto& robot : robots) {
    for (const physics::Segment& segment : robot->segments) {
      const int body =
          mj_name2id(model.get(), mjOBJ_BODY, robot->urdf.links[segment.link].name.c_str());
      for (const auto& [link, pose] : segment.links) {
        frames[robot->urdf.links[link].name] = {body, pose};
      }
    }
  }
  orderFrames();
  geom_links.clear();
  for (int g = 0; g < model->ngeom; ++g) {
    const std::string link = physics::linkOfGeom(nameOf(*model, mjOBJ_GEOM, g));
    const auto found = frames.find(link);
    const bool is_link = found != frames.end() && found->second.body == model->geom_bodyid[g];
    geom_links.push_back(is_link ? link : nameOf(*model, mjOBJ_BODY, model->geom_bodyid[g]));
  }
  std::vector<int> brake_dofs(model->neq, -1);
  for (int e = 0; e < model->neq; ++e) {
    const std::string name = nameOf(*model, mjOBJ_EQUALITY, e);
    const int joint = model->eq_type[e] == mjEQ_JOINT ? model->eq_obj1id[e] : -1;
    if (joint >= 0 && name == physics::brakeName(nameOf(*model, mjOBJ_JOINT, joint))) {
      brake_dofs[e] = model->jnt_dofadr[joint];
    }
  }
  motor_side.prepare(*model, std::move(brake_dofs));
  motor_side.reset(*data);
  frictions = {};
  for (const auto& robot : robots) {
    for (const auto& [joint, law] : robot->description.friction) {
      frictions.add(*model, joint, law);
    }
  }
  hold_limits.fit(*model);
  bindPlants(change);
  const auto gone = [this](const Push& push) {
    return push.joint.empty() ? frames.count(push.body_name) == 0 : !has(push.joint);
  };
  pushes.erase(std::remove_if(pushes.begin(), pushes.end(), gone), pushes.end());
  for (Push& push : pushes) {
    push.dof = push.joint.empty() ? -1 : slot(push.joint).dof;
    push.body = push.dof < 0 ? frames[push.body_name].body : model->dof_bodyid[push.dof];
  }
}

void World::Impl::bindPlants(WorldChange::Content& change) {
  const auto bind = [this](auto* plants, auto* taken) {
    plants->merge(*taken);
    for (auto it = plants->begin(); it != plants->end();) {
      auto& plant = *it->second;
      if (!has(plant.joints()[0])) {
        taken->insert(plants->extract(it++));
        continue;
      }
      typename std::decay_t<decltype(plant)>::Slots slots;
      for (std::size_t i = 0; i < slots.size(); ++i) {
        slots[i] = slot(plant.joints()[i]);
      }
      plant.bind(slots);
      ++it;
    }
  };
  bind(&arms, &change.arms);
  bind(&hands, &change.hands);
  bind(&drives, &change.drives);
  for (auto& [key, arm] : arms) {
    arm->restoreBrakes();
  }
}

bool World::Impl::has(const std::string& joint) const noexcept {
  return mj_name2id(model.get(), mjOBJ_JOINT, joint.c_str()) >= 0;
}

JointSlot World::Impl::slot(const std::string& joint) const {
  const int id = mj_name2id(model.get(), mjOBJ_JOINT, joint.c_str());
  if (id < 0) {
    throw std::runtime_error("There is no joint '" + joint + "' in the simulated world.");
  }
  if (model->jnt_type[id] != mjJNT_HINGE && model->jnt_type[id] != mjJNT_SLIDE) {
    throw std::runtime_error("Joint '" + joint + "' has more than one degree of freedom.");
  }
  return {model->jnt_qposadr[id], model->jnt_dofadr[id],
          mj_name2id(model.get(), mjOBJ_EQUALITY, physics::brakeName(joint).c_str())};
}

Frame World::Impl::frame(const std::string& body) const {
  const auto found = frames.find(body);
  if (body.empty() || found == frames.end()) {
    throw std::runtime_error("There is no body '" + body + "' in the simulated world.");
  }
  return found->second;
}

int World::Impl::freeJoint(const std::string& body) const {
  const Frame found = frame(body);
  const int joint = model->body_jntnum[found.body] > 0 ? model->body_jntadr[found.body] : -1;
  if (joint < 0 || model->jnt_type[joint] != mjJNT_FREE) {
    throw std::runtime_error("Body '" + body +
                             "' is not free to move; it cannot be put elsewhere.");
  }
  return joint;
}

const RobotModel& World::Impl::robot(const std::string& name) const {
  for (const auto& robot : robots) {
    if (robot->description.name == name) {
      return *robot;
    }
  }
  throw std::runtime_error("There is no robot '" + name + "' in the simulated world.");
}

void World::Impl::checkNewBody(const std::string& body, const std::string& of) const {
  if (frames.count(body) > 0) {
    throw std::runtime_error(of + " cannot be put into the simulated world: there is a body '" +
                             body + "' already; choose another name.");
  }
}

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
