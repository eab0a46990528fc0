// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The model and what it is made of. The steps: world_steps.cpp.
#include "physics/world/world_impl.h"

#include <algorithm>
#include <stdexcept>

#include "physics/engine/model_identity.h"
#include "physics/engine/model_lights.h"
#include "physics/world/state_transfer.h"

namespace franka_sim {

using physics::JointSlot;
using physics::RobotModel;

namespace {

constexpr std::size_t kExpectedPushes = 64;

std::string nameOf(const mjModel& model, int type, int id) {
  const char* name = mj_id2name(&model, type, id);
  return name != nullptr ? name : "";
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

}  // namespace franka_sim
