// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/physics/input_limits.h>
#include <franka_sim/physics/world_lights.h>

#include <algorithm>
#include <stdexcept>

#include "physics/engine/model_lights.h"
#include "physics/world/world_impl.h"

namespace franka_sim {

namespace {

int lightId(const World::Impl& world, const std::string& name) {
  const int id = mj_name2id(world.model.get(), mjOBJ_LIGHT, name.c_str());
  if (id < 0 || world.model->light_active[id] == 0) {
    throw std::runtime_error("There is no light '" + name + "' in the simulated world.");
  }
  return id;
}

/// The frame in which positions of a light are given, in its MuJoCo body: that of its link.
Eigen::Isometry3d linkFrame(const World::Impl& world, const std::string& name) {
  const std::size_t scope = name.rfind("::");
  const auto link =
      scope == std::string::npos ? world.frames.end() : world.frames.find(name.substr(0, scope));
  return link == world.frames.end() ? Eigen::Isometry3d::Identity() : link->second.pose;
}

void checkShares(const std::array<double, 3>& values, const std::string& what) {
  if (!std::all_of(values.begin(), values.end(), [](double value) { return value >= 0; })) {
    throw std::runtime_error(what + " must be made of numbers that are not negative.");
  }
}

}  // namespace

WorldLight light(const World& world, const std::string& name) {
  const World::Impl& impl = implOf(world);
  WorldLight light = physics::readLight(*impl.model, lightId(impl, name));
  const Eigen::Isometry3d frame = linkFrame(impl, name);
  light.position = array(frame.inverse() * vector(light.position));
  light.direction = array(frame.linear().transpose() * vector(light.direction));
  return light;
}

void setLight(World& world, const std::string& name, const WorldLight& light) {
  World::Impl& impl = implOf(world);
  const int id = lightId(impl, name);
  const std::string of = " of light '" + name + "'";
  checkShares(light.diffuse, "The diffuse color" + of);
  checkShares(light.specular, "The specular color" + of);
  checkShares(light.attenuation, "The attenuation" + of);
  sizes::check(light.position, sizes::kMaxPosition, "m", "The position" + of);
  const Eigen::Vector3d direction = vector(light.direction);
  if (!direction.allFinite() || direction.norm() < 1e-9) {
    throw std::runtime_error("The direction" + of + " must be a vector that is not 0 0 0.");
  }
  const Eigen::Isometry3d frame = linkFrame(impl, name);
  WorldLight in_body = light;
  in_body.position = array(frame * vector(light.position));
  in_body.direction = array(frame.linear() * direction.normalized());
  physics::writeLight(impl.model.get(), id, in_body);
  impl.set_lights[name] = in_body;
}

}  // namespace franka_sim
