// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <franka_sim/physics/world_properties.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "physics/scene_model.h"
#include "physics/world_impl.h"

namespace franka_sim {

BodyInertia bodyInertia(World& world, const std::string& body) {
  const Frame frame = implOf(world).frame(body);
  const mjModel& model = *implOf(world).model;
  if (!frame.pose.isApprox(Eigen::Isometry3d::Identity(), 1e-12)) {
    throw std::runtime_error("Body '" + body + "' is fixed to '" +
                             mj_id2name(&model, mjOBJ_BODY, frame.body) +
                             "', whose inertia contains its own.");
  }
  const double* q = model.body_iquat + 4 * frame.body;
  const Eigen::Matrix3d axes = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  const Eigen::Map<const Eigen::Vector3d> principal(model.body_inertia + 3 * frame.body);
  const Eigen::Matrix3d inertia = axes * principal.asDiagonal() * axes.transpose();
  const double* center = model.body_ipos + 3 * frame.body;
  return {
      model.body_mass[frame.body],
      {center[0], center[1], center[2]},
      {inertia(0, 0), inertia(0, 1), inertia(0, 2), inertia(1, 1), inertia(1, 2), inertia(2, 2)}};
}

void endPushes(World& world, const std::string& body) {
  World::Impl& impl = implOf(world);
  impl.frame(body);  // throws for an unknown one
  impl.pushes.erase(std::remove_if(impl.pushes.begin(), impl.pushes.end(),
                                   [&](const Push& push) { return push.body_name == body; }),
                    impl.pushes.end());
  mju_zero(impl.data->xfrc_applied, 6 * impl.model->nbody);  // a tick sets those that remain
  impl.disturb();
}

}  // namespace franka_sim

namespace franka_sim::sizes {

void check(const std::array<double, 3>& values, double largest, const char* unit,
           const std::string& what) {
  for (const double value : values) {
    check(value, largest, unit, what);
  }
}

void check(double value, double largest, const char* unit, const std::string& what) {
  if (!std::isfinite(value)) {
    throw std::runtime_error(what + " is not finite; give numbers in " + unit + ".");
  }
  if (std::abs(value) > largest) {
    throw std::runtime_error(what + " is " + franka_core::numberText(value) + " " + unit +
                             "; at most " + franka_core::numberText(largest) + " " + unit +
                             " are simulated.");
  }
}

}  // namespace franka_sim::sizes

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

WorldLight light(World& world, const std::string& name) {
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
