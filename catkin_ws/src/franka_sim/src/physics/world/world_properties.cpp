// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <franka_sim/physics/world_properties.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "physics/pictures/scene_model.h"
#include "physics/world/world_impl.h"

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

/// Penetration of bodies that rest on each other is smaller (chosen here).
constexpr double kOverlap = 1e-3;  // [m]

/// @param what for example "body 'stone'"
void checkPush(std::size_t others, const std::string& what, std::uint64_t ticks) {
  if (ticks > sizes::kMaxPushTicks && ticks != sizes::kEndlessPush) {
    throw std::runtime_error("The push on " + what + " lasts " + std::to_string(ticks) +
                             " ms; give at most " + std::to_string(sizes::kMaxPushTicks) + ".");
  }
  if (others >= sizes::kMaxPushes) {
    throw std::runtime_error("The push on " + what +
                             " is refused: " + std::to_string(sizes::kMaxPushes) +
                             " pushes act already. Wait until they end.");
  }
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

Pose bodyPose(const World& world, const std::string& body) {
  World::Impl& impl = implOf(world);
  return toPose(impl.pose(impl.frame(body)));
}

std::vector<Pose> framePoses(const World& world) {
  World::Impl& impl = implOf(world);
  std::vector<Pose> poses;
  poses.reserve(impl.ordered_frames.size());
  for (const NamedFrame& named : impl.ordered_frames) {
    poses.push_back(toPose(impl.pose(named.frame)));
  }
  return poses;
}

void checkBodyPose(const World& world, const std::string& body, const Pose& pose) {
  implOf(world).freeJoint(body);
  sizes::check(pose.position, sizes::kMaxPosition, "m", "The position for body '" + body + "'");
  if (!hasUnitOrientation(pose)) {
    throw std::runtime_error("The orientation for body '" + body + "' is not a unit quaternion.");
  }
}

void setBodyPose(World& world, const std::string& body, const Pose& pose) {
  World::Impl& impl = implOf(world);
  checkBodyPose(world, body, pose);
  impl.requireRuns();
  const int joint = impl.freeJoint(body);
  const Frame frame = impl.frame(body);
  const bool is_body = frame.pose.matrix().isIdentity(0);
  const Eigen::Isometry3d place =
      is_body ? toIsometry(pose) : toIsometry(pose) * frame.pose.inverse();
  double* qpos = impl.data->qpos + impl.model->jnt_qposadr[joint];
  Eigen::Vector3d::Map(qpos) = place.translation();
  const Eigen::Quaterniond unit =
      is_body ? quaternion(pose).normalized() : Eigen::Quaterniond(place.linear()).normalized();
  qpos[3] = unit.w();
  qpos[4] = unit.x();
  qpos[5] = unit.y();
  qpos[6] = unit.z();
  mju_zero(impl.data->qvel + impl.model->jnt_dofadr[joint], 6);
  impl.disturb();
}

std::vector<BodyState> bodyStates(const World& world, const std::vector<std::string>& names) {
  World::Impl& impl = implOf(world);
  std::vector<BodyState> states;
  for (const std::string& name : names) {
    states.push_back({bodyPose(world, name), Twist{}});
  }
  // Velocities at the present positions; mj_comVel writes what the next step computes anyway.
  mj_comPos(impl.model.get(), impl.data.get());
  mj_comVel(impl.model.get(), impl.data.get());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const int body = impl.frame(names[i]).body;
    double velocity[6];  // angular, linear at the body's origin
    mj_objectVelocity(impl.model.get(), impl.data.get(), mjOBJ_XBODY, body, velocity, 0);
    const Eigen::Vector3d angular(velocity[0], velocity[1], velocity[2]);
    const Eigen::Vector3d linear(velocity[3], velocity[4], velocity[5]);
    const Eigen::Map<const Eigen::Vector3d> at(impl.data->xpos + 3 * body);
    const Eigen::Map<const Eigen::Vector3d> origin(states[i].pose.position.data());
    states[i].twist = {array(linear + angular.cross(origin - at)), array(angular)};
  }
  return states;
}

BodyState bodyState(const World& world, const std::string& body) {
  return bodyStates(world, {body}).front();
}

namespace {

void checkTwist(const std::string& body, const Twist& twist) {
  sizes::check(twist.linear, sizes::kMaxVelocity, "m/s",
               "The linear velocity of body '" + body + "'");
  sizes::check(twist.angular, sizes::kMaxVelocity, "rad/s",
               "The angular velocity of body '" + body + "'");
}

}  // namespace

void setBodyState(World& world, const std::string& body, const BodyState& state) {
  checkTwist(body, state.twist);
  setBodyPose(world, body, state.pose);
  setBodyTwist(world, body, state.twist);
}

void setBodyTwist(World& world, const std::string& body, const Twist& twist) {
  World::Impl& impl = implOf(world);
  const int joint = impl.freeJoint(body);
  impl.requireRuns();
  checkTwist(body, twist);
  const Frame frame = impl.frame(body);
  const Eigen::Isometry3d pose = impl.pose(frame);
  const Eigen::Isometry3d body_pose = pose * frame.pose.inverse();
  double* qvel = impl.data->qvel + impl.model->jnt_dofadr[joint];
  // MuJoCo: linear velocity in world axes, angular velocity in body axes.
  const Eigen::Vector3d lever = body_pose.translation() - pose.translation();
  Eigen::Vector3d::Map(qvel) = vector(twist.linear) + vector(twist.angular).cross(lever);
  Eigen::Vector3d::Map(qvel + 3) = body_pose.linear().transpose() * vector(twist.angular);
  impl.disturb();
}

void pushBody(World& world, const std::string& body, const std::array<double, 3>& force,
              const std::array<double, 3>& torque, std::uint64_t ticks,
              const std::optional<std::array<double, 3>>& point) {
  World::Impl& impl = implOf(world);
  const Frame frame = impl.frame(body);
  impl.requireRuns();
  if (point) {
    sizes::check(*point, sizes::kMaxPosition, "m", "The point of the push");
  }
  sizes::check(force, sizes::kMaxForce, "N", "The force on body '" + body + "'");
  sizes::check(torque, sizes::kMaxForce, "Nm", "The torque on body '" + body + "'");
  checkPush(impl.pushes.size(), "body '" + body + "'", ticks);
  if (ticks == 0) {
    return;
  }
  const Frame origin{frame.body, Eigen::Isometry3d::Identity()};
  const Eigen::Vector3d at =
      point ? impl.pose(origin).inverse() * vector(*point) : frame.pose.translation();
  impl.addPush({body, frame.body, at, vector(force), vector(torque), ticks});
}

BodyInertia bodyInertia(const World& world, const std::string& body) {
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
      {inertia(0, 0), inertia(0, 1), inertia(0, 2), inertia(1, 1), inertia(1, 2), inertia(2, 2)},
      !physics::LinksWithoutGravity::has(model, frame.body)};
}

void endPushes(World& world, const std::string& body) {
  World::Impl& impl = implOf(world);
  impl.frame(body);  // throws for an unknown one
  const auto ends = [&](const Push& push) { return push.joint.empty() && push.body_name == body; };
  impl.pushes.erase(std::remove_if(impl.pushes.begin(), impl.pushes.end(), ends),
                    impl.pushes.end());
  impl.disturb();
}

void pushJoint(World& world, const std::string& joint, double effort, std::uint64_t ticks) {
  World::Impl& impl = implOf(world);
  const int dof = impl.slot(joint).dof;
  const int body = impl.model->dof_bodyid[dof];
  if (!impl.isObject(body)) {
    throw std::runtime_error("Joint '" + joint +
                             "' belongs to a robot, whose controller commands its efforts. Push "
                             "its link instead (a Gazebo client: apply_body_wrench).");
  }
  impl.requireRuns();
  sizes::check(effort, sizes::kMaxForce, "N or Nm", "The effort on joint '" + joint + "'");
  checkPush(impl.pushes.size(), "joint '" + joint + "'", ticks);
  if (ticks > 0) {
    impl.addPush({"", body, {}, {}, {}, ticks, joint, effort, dof});
  }
}

void endJointPushes(World& world, const std::string& joint) {
  World::Impl& impl = implOf(world);
  impl.slot(joint);  // throws for an unknown one
  impl.pushes.erase(std::remove_if(impl.pushes.begin(), impl.pushes.end(),
                                   [&](const Push& push) { return push.joint == joint; }),
                    impl.pushes.end());
  impl.disturb();
}

JointMeasurement jointState(const World& world, const std::string& joint) {
  const World::Impl& impl = implOf(world);
  const physics::JointSlot slot = impl.slot(joint);
  return {impl.data->qpos[slot.qpos], impl.data->qvel[slot.dof], impl.motor_side.torque(slot.dof)};
}

void checkJointPosition(const World& world, const std::string& joint, double position) {
  World::Impl& impl = implOf(world);
  impl.slot(joint);
  const int id = mj_name2id(impl.model.get(), mjOBJ_JOINT, joint.c_str());
  impl.requireRuns();
  sizes::check(position, sizes::kMaxPosition, "m or rad", "The position for joint '" + joint + "'");
  const double* range = impl.model->jnt_range + 2 * id;
  if (impl.model->jnt_limited[id] && (position < range[0] || position > range[1])) {
    throw std::runtime_error("Joint '" + joint + "' cannot be put at " +
                             franka_core::numberText(position) + ", its stops are at " +
                             franka_core::numberText(range[0]) + " and " +
                             franka_core::numberText(range[1]) + ".");
  }
}

void setJointPosition(World& world, const std::string& joint, double position) {
  checkJointPosition(world, joint, position);
  World::Impl& impl = implOf(world);
  const physics::JointSlot slot = impl.slot(joint);
  impl.data->qpos[slot.qpos] = position;
  impl.data->qvel[slot.dof] = 0;
  impl.disturb();
  for (auto& [key, arm] : impl.arms) {
    arm->jointWasMoved(joint);
  }
  for (auto& [key, drive] : impl.drives) {
    drive->jointWasMoved(joint);
  }
}

void setJointVelocity(World& world, const std::string& joint, double velocity) {
  World::Impl& impl = implOf(world);
  const physics::JointSlot slot = impl.slot(joint);
  impl.requireRuns();
  sizes::check(velocity, sizes::kMaxVelocity, "m/s or rad/s",
               "The velocity for joint '" + joint + "'");
  impl.data->qvel[slot.dof] = velocity;
  impl.disturb();
}

std::vector<Contact> contacts(const World& world) {
  World::Impl& impl = implOf(world);
  std::vector<Contact> result;
  for (const GeomContact& contact : impl.contacts()) {
    result.push_back({impl.geom_links[contact.geom1], impl.geom_links[contact.geom2],
                      contact.position, contact.force});
  }
  return result;
}

Touches touches(const World& world, const std::string& body) {
  World::Impl& impl = implOf(world);
  impl.frame(body);
  Touches touches;
  for (const GeomContact& contact : impl.contacts()) {
    const bool first = impl.geom_links[contact.geom1] == body;
    if (!first && impl.geom_links[contact.geom2] != body) {
      continue;
    }
    const int robot = impl.owners.robot_of_geom[first ? contact.geom2 : contact.geom1];
    if (robot < 0) {
      touches.others = true;
      continue;
    }
    const std::string& name = impl.robots[robot]->description.name;
    if (std::find(touches.robots.begin(), touches.robots.end(), name) == touches.robots.end()) {
      touches.robots.push_back(name);
    }
  }
  return touches;
}

std::vector<Overlap> overlaps(const World& world, const std::string& robot) {
  World::Impl& impl = implOf(world);
  const physics::RobotModel& own = impl.robot(robot);
  const auto owned = [&own](const std::string& link) {
    return std::any_of(own.urdf.links.begin(), own.urdf.links.end(),
                       [&link](const physics::UrdfLink& candidate) {
                         return candidate.name != "world" && candidate.name == link;
                       });
  };
  const mjData& data = impl.findContacts();
  std::vector<Overlap> result;
  for (int c = 0; c < data.ncon; ++c) {
    const mjContact& contact = data.contact[c];
    std::string link = impl.geom_links[contact.geom1], body = impl.geom_links[contact.geom2];
    if (owned(body)) {
      std::swap(link, body);
    }
    if (contact.dist > -kOverlap || !owned(link) || owned(body)) {
      continue;
    }
    const auto same = std::find_if(result.begin(), result.end(), [&](const Overlap& other) {
      return other.link == link && other.body == body;
    });
    if (same == result.end()) {
      result.push_back({link, body, -contact.dist});
    } else {
      same->depth = std::max(same->depth, -contact.dist);
    }
  }
  return result;
}

std::string describeOverlaps(const World& world, const std::string& robot) {
  std::string list;
  for (const Overlap& overlap : overlaps(world, robot)) {
    list += (list.empty() ? "" : ", ") + overlap.link + " and " +
            (overlap.body.empty() ? "the ground or another fixed shape" : overlap.body) + " by " +
            franka_core::fixedText(1e3 * overlap.depth, 0) + " mm";
  }
  return list.empty() ? list
                      : "The robot '" + robot +
                            "' begins within other bodies, which will push it: " + list + ".";
}

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

std::vector<WorldCamera> cameras(const World& world) {
  std::vector<WorldCamera> result;
  const mjModel& model = *implOf(world).model;
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

std::array<double, 3> gravity(const World& world) {
  const double* g = implOf(world).model->opt.gravity;
  return {g[0], g[1], g[2]};
}

void setGravity(World& world, const std::array<double, 3>& gravity) {
  sizes::check(gravity, sizes::kMaxGravity, "m/s^2", "Gravity");
  World::Impl& impl = implOf(world);
  impl.set_gravity = gravity;
  std::copy(gravity.begin(), gravity.end(), impl.model->opt.gravity);
  impl.disturb();
}

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
