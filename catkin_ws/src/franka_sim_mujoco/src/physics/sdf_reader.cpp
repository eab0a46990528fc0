// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <sdf/Actor.hh>
#include <sdf/Camera.hh>
#include <sdf/Collision.hh>
#include <sdf/Console.hh>
#include <sdf/Joint.hh>
#include <sdf/JointAxis.hh>
#include <sdf/Light.hh>
#include <sdf/Link.hh>
#include <sdf/Model.hh>
#include <sdf/ParserConfig.hh>
#include <sdf/Root.hh>
#include <sdf/Scene.hh>
#include <sdf/Sensor.hh>
#include <sdf/Visual.hh>
#include <sdf/World.hh>
#include <stdexcept>

#include "physics/sdf_files.h"
#include "physics/sdf_scene.h"
#include "physics/sdf_shapes.h"

namespace franka_sim_mujoco::physics {
namespace {

constexpr double kNoLimit = 1e15;  ///< SDF writes "unlimited" as 1e16

class Reader {
 public:
  Reader(std::string title, const SdfFiles& files) : title_(std::move(title)), files_(files) {}

  SdfScene take() { return std::move(scene_); }

  void readWorld(const sdf::World& world) {
    scene_.gravity = {world.Gravity().X(), world.Gravity().Y(), world.Gravity().Z()};
    for (uint64_t i = 0; i < world.ModelCount(); ++i) {
      readTopModel(*world.ModelByIndex(i));
    }
    for (uint64_t i = 0; i < world.LightCount(); ++i) {
      readLight(*world.LightByIndex(i), -1);
    }
    if (const sdf::Scene* look = world.Scene()) {
      scene_.ambient = rgb(look->Ambient());
      if (world.Element()->GetElement("scene")->HasElement("background")) {
        scene_.background = rgb(look->Background());
      }
    }
    for (uint64_t i = 0; i < world.ActorCount(); ++i) {
      note("actor '" + world.ActorByIndex(i)->Name() + "'");
    }
    notePlugins(world.Element(), "the world");
    if (world.WindLinearVelocity() != ignition::math::Vector3d::Zero) {
      note("wind");
    }
  }

  void readTopModel(const sdf::Model& model) {
    scene_.models.push_back({model.Name(), poseOf(model), {}, model.SelfCollide()});
    readModel(model, model.Name(), Eigen::Isometry3d::Identity(), false);
  }

 private:
  void note(const std::string& what) { scene_.unsupported.insert(what); }

  void notePlugins(const sdf::ElementPtr& element, const std::string& of) {
    if (element && element->HasElement("plugin")) {
      for (auto plugin = element->GetElement("plugin"); plugin;
           plugin = plugin->GetNextElement("plugin")) {
        note("plugin '" + plugin->Get<std::string>("name") + "' of " + of);
      }
    }
  }

  template <typename Thing>
  Eigen::Isometry3d poseOf(const Thing& thing, const std::string& in = "") const {
    ignition::math::Pose3d pose;
    const sdf::Errors errors = thing.SemanticPose().Resolve(pose, in);
    if (!errors.empty()) {
      throw std::runtime_error(title_ + ": the pose of '" + thing.Name() +
                               "' cannot be resolved: " + errors.front().Message());
    }
    return toIsometry(pose);
  }

  /// @param name with the models around it. @param parent pose of what stands around it.
  void readModel(const sdf::Model& model, const std::string& name, const Eigen::Isometry3d& parent,
                 bool is_static) {
    const Eigen::Isometry3d pose = parent * poseOf(model);
    is_static = is_static || model.Static();
    for (uint64_t i = 0; i < model.LinkCount(); ++i) {
      readLink(*model.LinkByIndex(i), name, pose, is_static);
    }
    for (uint64_t i = 0; i < model.ModelCount(); ++i) {
      const sdf::Model& inner = *model.ModelByIndex(i);
      readModel(inner, name + "::" + inner.Name(), pose, is_static);
    }
    for (uint64_t i = 0; i < model.JointCount(); ++i) {
      readJoint(*model.JointByIndex(i), name, pose);
    }
    notePlugins(model.Element(), "model '" + name + "'");
    if (model.Element()->HasElement("gripper")) {
      note("<gripper> of model '" + name + "'");
    }
  }

  void readLink(const sdf::Link& link, const std::string& model, const Eigen::Isometry3d& base,
                bool is_static) {
    SdfLink result;
    result.name = model + "::" + link.Name();
    result.model = scene_.models.back().name;
    result.is_static = is_static;
    result.pose = base * poseOf(link);
    const ignition::math::Inertiald& inertia = link.Inertial();
    result.inertial.mass = inertia.MassMatrix().Mass();
    result.inertial.com = toIsometry(inertia.Pose()).translation();
    const ignition::math::Matrix3d moi = inertia.Moi();
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        result.inertial.inertia(row, column) = moi(row, column);
      }
    }
    for (uint64_t i = 0; i < link.CollisionCount(); ++i) {
      const sdf::Collision& collision = *link.CollisionByIndex(i);
      const std::string what = "collision '" + collision.Name() + "' of '" + result.name + "'";
      if (auto shape = readShape(*collision.Geom(), files_, what, &scene_.unsupported)) {
        shape->name = collision.Name();
        shape->pose = poseOf(collision) * shape->pose;
        shape->surface = readSurface(collision.Element(), what, &scene_.unsupported);
        result.collisions.push_back(*shape);
      }
    }
    for (uint64_t i = 0; i < link.VisualCount(); ++i) {
      const sdf::Visual& visual = *link.VisualByIndex(i);
      const std::string what = "visual '" + visual.Name() + "' of '" + result.name + "'";
      if (auto shape = readShape(*visual.Geom(), files_, what, &scene_.unsupported)) {
        shape->name = visual.Name();
        shape->pose = poseOf(visual) * shape->pose;
        shape->rgba = readColour(visual, what, &scene_.unsupported);
        shape->opacity = 1 - visual.Transparency();
        result.visuals.push_back(*shape);
      }
    }
    const int index = static_cast<int>(scene_.links.size());
    scene_.links.push_back(result);
    scene_.models.back().links.push_back(index);
    index_[result.name] = index;
    readAttachments(link, result.name, index);
  }

  void readAttachments(const sdf::Link& link, const std::string& name, int index) {
    for (uint64_t i = 0; i < link.LightCount(); ++i) {
      readLight(*link.LightByIndex(i), index);
    }
    for (uint64_t i = 0; i < link.SensorCount(); ++i) {
      readSensor(*link.SensorByIndex(i), name, index);
    }
    if (link.Element()->HasElement("gravity") && !link.Element()->Get<bool>("gravity")) {
      note("<gravity>false</gravity> of link '" + name + "'");
    }
    if (link.EnableWind()) {
      note("wind on link '" + name + "'");
    }
    if (link.ParticleEmitterCount() > 0) {
      note("particle emitters of link '" + name + "'");
    }
  }

  void readSensor(const sdf::Sensor& sensor, const std::string& link, int index) {
    const std::string name = link + "::" + sensor.Name();
    const sdf::Camera* camera = sensor.CameraSensor();
    if (camera == nullptr) {
      note("sensor '" + name + "' of type " + sensor.TypeStr());
      return;
    }
    SdfCamera result;
    result.name = name;
    result.link = index;
    result.pose = poseOf(sensor) * toIsometry(camera->RawPose());
    result.horizontal_view = camera->HorizontalFov().Radian();
    result.width = static_cast<int>(camera->ImageWidth());
    result.height = static_cast<int>(camera->ImageHeight());
    if (sensor.UpdateRate() > 0) {
      result.rate = sensor.UpdateRate();
    }
    scene_.cameras.push_back(result);
  }

  void readLight(const sdf::Light& light, int link) {
    SdfLight result;
    result.name = light.Name();
    result.link = link;
    result.kind = light.Type() == sdf::LightType::DIRECTIONAL ? SdfLight::Kind::kDirectional
                  : light.Type() == sdf::LightType::SPOT      ? SdfLight::Kind::kSpot
                                                              : SdfLight::Kind::kPoint;
    const Eigen::Isometry3d pose = poseOf(light);
    result.position = pose.translation();
    const ignition::math::Vector3d d = light.Direction();
    result.direction = pose.linear() * Eigen::Vector3d(d.X(), d.Y(), d.Z()).normalized();
    result.diffuse = rgb(light.Diffuse());
    result.specular = rgb(light.Specular());
    result.attenuation = {light.ConstantAttenuationFactor(), light.LinearAttenuationFactor(),
                          light.QuadraticAttenuationFactor()};
    result.cutoff = light.SpotOuterAngle().Radian() / 2;
    result.shadows = light.CastShadows();
    scene_.lights.push_back(result);
  }

  int linkOf(const std::string& name, const std::string& model, const std::string& joint) const {
    if (name == "world") {
      return -1;
    }
    const auto found = index_.find(model + "::" + name);
    if (found == index_.end()) {
      throw std::runtime_error(title_ + ": joint '" + joint + "' names the link '" + name +
                               "', which is not there.");
    }
    return found->second;
  }

  void readJoint(const sdf::Joint& joint, const std::string& model, const Eigen::Isometry3d& base) {
    SdfJoint result;
    result.name = model + "::" + joint.Name();
    std::string parent, child;
    if (!joint.ResolveParentLink(parent).empty() || !joint.ResolveChildLink(child).empty()) {
      throw std::runtime_error(title_ + ": the links of joint '" + result.name +
                               "' cannot be found.");
    }
    result.parent = linkOf(parent, model, result.name);
    result.child = linkOf(child, model, result.name);
    result.position = (base * poseOf(joint, "__model__")).translation();
    switch (joint.Type()) {
      case sdf::JointType::REVOLUTE:
      case sdf::JointType::CONTINUOUS:
        result.kind = SdfJoint::Kind::kHinge;
        break;
      case sdf::JointType::PRISMATIC:
        result.kind = SdfJoint::Kind::kSlide;
        break;
      case sdf::JointType::BALL:
        result.kind = SdfJoint::Kind::kBall;
        break;
      case sdf::JointType::FIXED:
        break;
      default:
        note("the type of joint '" + result.name + "' (it is held fixed)");
    }
    const sdf::JointAxis* axis = joint.Axis(0);
    const bool moves_along_axis =
        result.kind == SdfJoint::Kind::kHinge || result.kind == SdfJoint::Kind::kSlide;
    if (axis != nullptr && moves_along_axis) {
      readAxis(*axis, base, joint.Type() != sdf::JointType::CONTINUOUS, &result);
    }
    if (result.child < 0 || isChild(result.child)) {
      note("joint '" + result.name + "', which closes a loop");
      return;
    }
    scene_.joints.push_back(result);
  }

  bool isChild(int link) const {
    return std::any_of(scene_.joints.begin(), scene_.joints.end(),
                       [link](const SdfJoint& joint) { return joint.child == link; });
  }

  void readAxis(const sdf::JointAxis& axis, const Eigen::Isometry3d& base, bool limited,
                SdfJoint* joint) {
    ignition::math::Vector3d xyz;
    const sdf::Errors errors = axis.ResolveXyz(xyz, "__model__");
    if (!errors.empty()) {
      throw std::runtime_error(title_ + ": the axis of joint '" + joint->name +
                               "' cannot be resolved: " + errors.front().Message());
    }
    joint->axis = base.linear() * Eigen::Vector3d(xyz.X(), xyz.Y(), xyz.Z()).normalized();
    joint->damping = axis.Damping();
    joint->friction = axis.Friction();
    joint->stiffness = axis.SpringStiffness();
    joint->reference = axis.SpringReference();
    const bool below = axis.Lower() > -kNoLimit, above = axis.Upper() < kNoLimit;
    if (limited && (below || above)) {
      const double far = joint->kind == SdfJoint::Kind::kHinge ? 1e3 : 1e6;
      joint->limits = {below ? axis.Lower() : -far, above ? axis.Upper() : far};
    }
  }

  std::string title_;
  const SdfFiles& files_;
  SdfScene scene_;
  std::map<std::string, int> index_;
};

void throwFirst(const sdf::Errors& errors, const std::string& title) {
  if (!errors.empty()) {
    throw std::runtime_error(title + ": " + errors.front().Message());
  }
}

}  // namespace

bool looksLikeSdf(const std::string& text) {
  std::size_t at = 0;
  while ((at = text.find('<', at)) != std::string::npos) {
    if (text.compare(at, 4, "<!--") == 0) {
      at = text.find("-->", at);
    } else if (text[at + 1] != '?' && text[at + 1] != '!') {
      return text.compare(at, 4, "<sdf") == 0 || text.compare(at, 7, "<gazebo") == 0;
    }
    at = at == std::string::npos ? at : at + 1;
  }
  return false;
}

SdfScene readSdf(const std::string& text, const std::string& folder, const std::string& title,
                 const ResourceResolver& resolve, const std::string& model_name) {
  sdf::Console::Instance()->SetQuiet(true);
  const SdfFiles files(folder, resolve);
  sdf::ParserConfig config;
  config.SetFindCallback([&files](const std::string& uri) { return files.find(uri); });
  sdf::Root root;
  throwFirst(root.LoadSdfString(withStandardModels(text, files, title, model_name), config), title);
  Reader reader(title, files);
  if (!model_name.empty()) {
    if (root.Model() == nullptr) {
      throw std::runtime_error(title + ": there is no <model> in the SDF text.");
    }
    reader.readTopModel(*root.Model());
  } else if (root.WorldCount() == 1) {
    reader.readWorld(*root.WorldByIndex(0));
  } else if (root.WorldCount() == 0 && root.Model() != nullptr) {
    reader.readTopModel(*root.Model());
  } else {
    throw std::runtime_error(title + ": an SDF world file must hold one <world>; this one holds " +
                             std::to_string(root.WorldCount()) + ".");
  }
  return reader.take();
}

}  // namespace franka_sim_mujoco::physics
