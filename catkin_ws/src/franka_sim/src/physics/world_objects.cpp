// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// World: its content by name (bodies grouped into models, joints, cameras), and external changes
/// at run time.
#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_properties.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "physics/contacts.h"
#include "physics/world_impl.h"

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

void applyAtOnce(World& world, WorldChange change) {
  change.compile();
  world.apply(change);
}

}  // namespace

void physics::placeInitially(const mjModel& model, mjData* data, const Robots& robots) {
  for (const auto& robot : robots) {
    for (const UrdfJoint& joint : robot->urdf.joints) {
      const int id = mj_name2id(&model, mjOBJ_JOINT, joint.name.c_str());
      if (joint.type != UrdfJoint::Type::kFixed && id >= 0) {
        data->qpos[model.jnt_qposadr[id]] = robot->initialPosition(joint);
      }
    }
  }
}

std::vector<int> physics::robotOfBody(const mjModel& model, const Robots& robots) {
  std::vector<int> robot_of_body(model.nbody, -1);
  for (std::size_t r = 0; r < robots.size(); ++r) {
    for (const Segment& segment : robots[r]->segments) {
      const std::string& link = robots[r]->urdf.links[segment.link].name;
      const int body = mj_name2id(&model, mjOBJ_BODY, link.c_str());
      if (body > 0) {
        robot_of_body[body] = static_cast<int>(r);
      }
    }
  }
  return robot_of_body;
}

void WorldChange::compile() { content_->compile(); }

void WorldChange::Content::compile() {
  if (describe) {
    describe(*this);
  }
  std::vector<const physics::RobotModel*> list;
  for (const auto& robot : robots) {
    list.push_back(robot.get());
  }
  const std::string title =
      list.empty() ? world->title()
                   : world->title() + " with robot '" + list.back()->description.name + "'";
  model = physics::compile(world->merge(list, false), title);
  physics::setContactCapacity(model.get(), physics::robotOfBody(*model, robots),
                              world->givenSizes());
  identity = physics::identityOf(*model, list);
  data = physics::makeData(*model);
  mj_resetData(model.get(), data.get());
  physics::placeInitially(*model, data.get(), robots);
}

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
  if (!content.added.empty()) {
    impl_->news.insert(unsupported(content.added));
  }
}

void World::addRobot(const RobotDescription& robot) { applyAtOnce(*this, beginAddRobot(robot)); }

void World::removeRobot(const std::string& name) { applyAtOnce(*this, beginRemoveRobot(name)); }

void World::addObject(const std::string& name, const std::string& text, const Pose& pose) {
  applyAtOnce(*this, beginAddObject(name, text, pose));
}

void World::removeObject(const std::string& name) { applyAtOnce(*this, beginRemoveObject(name)); }

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
