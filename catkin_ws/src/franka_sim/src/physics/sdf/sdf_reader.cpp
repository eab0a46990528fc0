// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "physics/mjcf/mjcf_files.h"
#include "physics/mjcf/xml_util.h"
#include "physics/sdf/sdf_frames.h"
#include "physics/sdf/sdf_scene.h"
#include "physics/sdf/sdf_text.h"

namespace franka_sim::physics {
namespace {

using tinyxml2::XMLElement;

constexpr double kNoLimit = 1e15;  ///< SDF writes "unlimited" as 1e16

/// Calls `act` for each child of a name.
template <typename Act>
void forEach(const XMLElement& parent, const char* name, Act act) {
  for (const XMLElement* child = parent.FirstChildElement(name); child != nullptr;
       child = child->NextSiblingElement(name)) {
    act(*child);
  }
}

Eigen::Vector3d toVector(const std::vector<double>& n) { return {n[0], n[1], n[2]}; }

std::array<double, 3> rgb(const std::array<double, 4>& color) {
  return {color[0], color[1], color[2]};
}

/// A model that is being read: its pose and its frames.
struct Place {
  std::string name;   ///< prefixed with those of the enclosing models, except merged ones
  std::string scope;  ///< of its frames: prefixed with all of them
  const SdfFrames& frames;
  Eigen::Isometry3d pose;  ///< in the world
  bool is_static;
};

class Reader {
 public:
  Reader(std::string title, std::set<std::string> notes) : title_(std::move(title)) {
    scene_.unsupported = std::move(notes);
  }

  SdfScene take() { return std::move(scene_); }

  void readWorld(const XMLElement& world) {
    const SdfFrames frames(world, title_);
    scene_.gravity = {0, 0, -9.8};
    const std::vector<double> gravity = childNumbers(world, "gravity", {0, 0, -9.8}, title_);
    std::copy(gravity.begin(), gravity.end(), scene_.gravity.begin());
    forEach(world, "model", [&](const XMLElement& model) { readTopModel(model, frames); });
    forEach(world, "light",
            [&](const XMLElement& light) { readLight(light, frames.poseOf(light, ""), -1); });
    const XMLElement* look = world.FirstChildElement("scene");
    const XMLElement& scene = look == nullptr ? world : *look;  // a world has no colors of its own
    scene_.ambient = rgb(readColor(scene, "ambient", {0.4, 0.4, 0.4, 1}, title_));
    scene_.background = rgb(readColor(scene, "background", {0.7, 0.7, 0.7, 1}, title_));
    forEach(world, "actor",
            [&](const XMLElement& actor) { note("actor '" + optional(actor, "name") + "'"); });
    forEach(world, "population", [&](const XMLElement& population) {
      note("population '" + optional(population, "name") + "'");
    });
    notePlugins(world, "the world");
    forEach(world, "physics", [&](const XMLElement& physics) {
      if (physics.FirstChildElement("gravity") != nullptr) {
        note("<gravity> of <physics>");
      }
    });
    noteUnknown(
        world, "the world",
        {"model", "light", "frame", "gravity", "scene", "actor", "population", "plugin", "wind",
         "physics", "gui", "audio", "magnetic_field", "atmosphere", "spherical_coordinates"},
        &scene_.unsupported);
    const XMLElement* wind = world.FirstChildElement("wind");
    if (wind != nullptr &&
        !toVector(childNumbers(*wind, "linear_velocity", {0, 0, 0}, title_)).isZero(0)) {
      note("wind");
    }
  }

  /// @param frames of the enclosing scope
  void readTopModel(const XMLElement& model, const SdfFrames& frames) {
    const std::string name = required(model, "name", title_);
    const Place place{name, name, frames.model(name), frames.pose(name), false};
    scene_.models.push_back({name, place.pose, {}, isTrue(model, "self_collide")});
    readModel(model, place);
  }

 private:
  void note(const std::string& what) { scene_.unsupported.insert(what); }

  void noteTrue(const XMLElement& element, const std::string& setting, const std::string& of) {
    if (isTrue(element, setting.c_str())) {
      note("<" + setting + "> of " + of);
    }
  }

  void noteUnlessZero(const XMLElement& element, const std::string& number, const std::string& of) {
    if (childNumbers(element, number.c_str(), {0}, title_ + ": " + of)[0] != 0) {
      note("<" + number + "> in <" + element.Name() + "> of " + of);
    }
  }

  void notePlugins(const XMLElement& element, const std::string& of) {
    forEach(element, "plugin", [&](const XMLElement& plugin) {
      note("plugin '" + optional(plugin, "name") + "' (" + optional(plugin, "filename") + ") of " +
           of);
    });
  }

  void readModel(const XMLElement& model, Place place) {
    place.is_static = place.is_static || isTrue(model, "static");
    if (!place.is_static && model.FirstChildElement("link") == nullptr &&
        model.FirstChildElement("model") == nullptr) {
      throw std::runtime_error(title_ + ": model '" + place.name + "' needs at least one link.");
    }
    forEach(model, "link", [&](const XMLElement& link) { readLink(link, place); });
    forEach(model, "model", [&](const XMLElement& inner) {
      const std::string name = required(inner, "name", title_);
      readModel(inner,
                {isMerged(inner) ? place.name : place.name + "::" + name, place.scope + "::" + name,
                 place.frames.model(name), place.pose * place.frames.pose(name), place.is_static});
    });
    forEach(model, "joint", [&](const XMLElement& joint) { readJoint(joint, place); });
    const std::string what = "model '" + place.name + "'";
    notePlugins(model, what);
    noteTrue(model, "enable_wind", what);
    noteUnknown(model, what,
                {"link", "model", "joint", "frame", "pose", "static", "self_collide", "plugin",
                 "enable_wind", "allow_auto_disable"},
                &scene_.unsupported);
  }

  UrdfInertial readInertial(const XMLElement& link, const std::string& name) {
    UrdfInertial result;
    result.mass = 1;
    result.com = Eigen::Vector3d::Zero();
    result.inertia = Eigen::Matrix3d::Identity();
    const XMLElement* element = link.FirstChildElement("inertial");
    if (element == nullptr) {
      return result;
    }
    const std::string where = title_ + ": link '" + name + "'";
    if (element->BoolAttribute("auto")) {
      note("the automatic inertia of link '" + name + "'");
    }
    noteUnknown(*element, "the inertia of link '" + name + "'", {"mass", "inertia", "pose"},
                &scene_.unsupported);
    result.mass = childNumbers(*element, "mass", {1}, where)[0];
    Eigen::Matrix3d moments = Eigen::Matrix3d::Identity();
    if (const XMLElement* inertia = element->FirstChildElement("inertia")) {
      const auto entry = [&](const char* entry_name, double fallback) {
        return childNumbers(*inertia, entry_name, {fallback}, where)[0];
      };
      moments.diagonal() << entry("ixx", 1), entry("iyy", 1), entry("izz", 1);
      moments(0, 1) = moments(1, 0) = entry("ixy", 0);
      moments(0, 2) = moments(2, 0) = entry("ixz", 0);
      moments(1, 2) = moments(2, 1) = entry("iyz", 0);
    }
    if (!(result.mass > 0)) {
      throw std::runtime_error(where + ": its mass must be greater than zero.");
    }
    moments = possibleInertia(moments, where, &scene_.unsupported);
    const Eigen::Isometry3d pose = writtenPose(*element, where);
    result.com = pose.translation();
    result.inertia = pose.linear() * moments * pose.linear().transpose();
    return result;
  }

  void readLink(const XMLElement& link, const Place& place) {
    const std::string own_name = required(link, "name", title_);
    SdfLink result;
    result.name = place.name + "::" + own_name;
    if (std::any_of(scene_.links.begin(), scene_.links.end(),
                    [&result](const SdfLink& other) { return other.name == result.name; })) {
      throw std::runtime_error(title_ + ": two links are called '" + result.name +
                               "' after merging; names must differ.");
    }
    result.model = scene_.models.back().name;
    result.is_static = place.is_static;
    result.gravity = isTrue(link, "gravity", true);
    result.pose = place.pose * place.frames.pose(own_name);
    result.inertial = readInertial(link, result.name);
    forEach(link, "collision", [&](const XMLElement& collision) {
      const std::string name = optional(collision, "name");
      const std::string what = "collision '" + name + "' of '" + result.name + "'";
      if (auto shape = readShape(collision, what, &scene_.unsupported)) {
        shape->name = name;
        shape->pose = place.frames.poseIn(collision, own_name) * shape->pose;
        shape->surface = readSurface(collision, what, &scene_.unsupported);
        result.collisions.push_back(*shape);
      }
      noteUnknown(collision, what, {"geometry", "surface", "pose", "max_contacts", "laser_retro"},
                  &scene_.unsupported);
    });
    forEach(link, "visual", [&](const XMLElement& visual) {
      const std::string name = optional(visual, "name");
      const std::string what = "visual '" + name + "' of '" + result.name + "'";
      if (auto shape = readShape(visual, what, &scene_.unsupported)) {
        shape->name = name;
        shape->pose = place.frames.poseIn(visual, own_name) * shape->pose;
        shape->rgba = readMaterial(visual, what, &scene_.unsupported);
        shape->opacity = 1 - childNumbers(visual, "transparency", {0}, what)[0];
        result.visuals.push_back(*shape);
      }
      noteUnknown(visual, what,
                  {"geometry", "material", "transparency", "pose", "cast_shadows", "laser_retro",
                   "meta", "visibility_flags"},
                  &scene_.unsupported);
    });
    if (link.FirstChildElement("self_collide") != nullptr) {
      result.self_collide = isTrue(link, "self_collide");
    }
    const int index = static_cast<int>(scene_.links.size());
    scene_.links.push_back(result);
    scene_.models.back().links.push_back(index);
    index_[place.scope + "::" + own_name] = index;
    forEach(link, "light", [&](const XMLElement& light) {
      readLight(light, place.frames.poseIn(light, own_name), index);
    });
    forEach(link, "sensor", [&](const XMLElement& sensor) {
      readSensor(sensor, place.frames.poseIn(sensor, own_name), index);
    });
    noteOfLink(link, result.name);
  }

  void noteOfLink(const XMLElement& link, const std::string& name) {
    const std::string what = "link '" + name + "'";
    for (const char* setting : {"enable_wind", "kinematic"}) {
      noteTrue(link, setting, what);
    }
    if (const XMLElement* decay = link.FirstChildElement("velocity_decay")) {
      noteUnlessZero(*decay, "linear", what);
      noteUnlessZero(*decay, "angular", what);
    }
    noteUnknown(link, what,
                {"inertial", "collision", "visual", "light", "sensor", "pose", "gravity",
                 "enable_wind", "kinematic", "self_collide", "velocity_decay", "must_be_base_link"},
                &scene_.unsupported);
  }

  /// @param pose in the link
  void readSensor(const XMLElement& sensor, const Eigen::Isometry3d& pose, int link) {
    const std::string name =
        scene_.links[static_cast<std::size_t>(link)].name + "::" + optional(sensor, "name");
    for (const CameraSensor& camera : readCameras(sensor, pose, name, &scene_.unsupported)) {
      scene_.cameras.emplace_back(camera, link);
    }
  }

  /// @param pose in the link, or in the world
  void readLight(const XMLElement& light, const Eigen::Isometry3d& pose, int link) {
    SdfLight result;
    result.name = optional(light, "name");
    const std::string where = title_ + ": light '" + result.name + "'";
    result.link = link;
    const std::string kind = optional(light, "type");
    result.kind = kind == "directional" ? SdfLight::Kind::kDirectional
                  : kind == "spot"      ? SdfLight::Kind::kSpot
                                        : SdfLight::Kind::kPoint;
    result.position = pose.translation();
    const Eigen::Vector3d along = toVector(childNumbers(light, "direction", {0, 0, -1}, where));
    result.direction = pose.linear() * along.normalized();
    result.diffuse = rgb(readColor(light, "diffuse", {1, 1, 1, 1}, where));
    result.specular = rgb(readColor(light, "specular", {0.1, 0.1, 0.1, 1}, where));
    result.attenuation = {1, 1, 0};  // SDF's
    if (const XMLElement* attenuation = light.FirstChildElement("attenuation")) {
      result.attenuation = {childNumbers(*attenuation, "constant", {1}, where)[0],
                            childNumbers(*attenuation, "linear", {1}, where)[0],
                            childNumbers(*attenuation, "quadratic", {0}, where)[0]};
    }
    const XMLElement* spot = light.FirstChildElement("spot");
    result.cutoff = spot == nullptr ? 0 : childNumbers(*spot, "outer_angle", {0}, where)[0] / 2;
    result.shadows = isTrue(light, "cast_shadows");
    noteUnknown(light, "light '" + result.name + "'",
                {"pose", "direction", "diffuse", "specular", "attenuation", "spot", "cast_shadows",
                 "intensity", "visualize", "light_on"},
                &scene_.unsupported);
    scene_.lights.push_back(result);
  }

  /// @param frame that a joint names
  int linkOf(const std::string& frame, const Place& place, const std::string& joint) const {
    if (frame.empty()) {
      throw std::runtime_error(title_ + ": joint '" + joint + "' needs a <parent> and a <child>.");
    }
    try {
      const std::string link = place.frames.linkOf(frame);
      return link == "world" ? -1 : index_.at(place.scope + "::" + link);
    } catch (const std::exception&) {
      throw std::runtime_error(title_ + ": joint '" + joint + "' names '" + frame +
                               "', and there is no such link or frame.");
    }
  }

  void readJoint(const XMLElement& joint, const Place& place) {
    SdfJoint result;
    const std::string own_name = required(joint, "name", title_);
    result.name = place.name + "::" + own_name;
    result.parent = linkOf(childText(joint, "parent"), place, result.name);
    result.child = linkOf(childText(joint, "child"), place, result.name);
    result.position = (place.pose * place.frames.pose(own_name)).translation();
    const std::string what = "joint '" + result.name + "'";
    noteUnknown(joint, what,
                {"parent", "child", "pose", "axis", "axis2", "physics", "thread_pitch",
                 "gearbox_ratio", "gearbox_reference_body"},
                &scene_.unsupported);
    const std::string kind = optional(joint, "type");
    if (kind == "revolute" || kind == "continuous") {
      result.kind = SdfJoint::Kind::kHinge;
    } else if (kind == "prismatic") {
      result.kind = SdfJoint::Kind::kSlide;
    } else if (kind == "ball") {
      result.kind = SdfJoint::Kind::kBall;
    } else if (kind != "fixed") {
      note("the type of " + what + " (it is held fixed)");
    }
    if (result.kind == SdfJoint::Kind::kHinge || result.kind == SdfJoint::Kind::kSlide) {
      const XMLElement* axis = joint.FirstChildElement("axis");
      if (axis == nullptr) {
        throw std::runtime_error(title_ + ": " + what + " needs an <axis>.");
      }
      noteUnlessZero(*axis, "initial_position", what);
      noteUnknown(*axis, "the axis of " + what,
                  {"xyz", "dynamics", "limit", "initial_position", "use_parent_model_frame"},
                  &scene_.unsupported);
      readAxis(*axis, place, own_name, &result);
      if (kind == "continuous") {
        result.limits.reset();
      }
    }
    if (result.child < 0 || isChild(result.child)) {
      note(what + ", which closes a loop");
      return;
    }
    scene_.joints.push_back(result);
  }

  bool isChild(int link) const {
    return std::any_of(scene_.joints.begin(), scene_.joints.end(),
                       [link](const SdfJoint& joint) { return joint.child == link; });
  }

  void readAxis(const XMLElement& axis, const Place& place, const std::string& own_name,
                SdfJoint* joint) const {
    const std::string where = title_ + ": joint '" + joint->name + "'";
    const Eigen::Vector3d xyz = toVector(childNumbers(axis, "xyz", {0, 0, 1}, where));
    if (xyz.isZero(0)) {
      throw std::runtime_error(where + ": the <axis> 0 0 0 has no direction.");
    }
    const XMLElement* written = axis.FirstChildElement("xyz");
    const std::string frame = written == nullptr ? "" : optional(*written, "expressed_in");
    const Eigen::Isometry3d in_model = place.frames.pose(frame.empty() ? own_name : frame);
    joint->axis = place.pose.linear() * in_model.linear() * xyz.normalized();
    if (const XMLElement* dynamics = axis.FirstChildElement("dynamics")) {
      joint->damping = childNumbers(*dynamics, "damping", {0}, where)[0];
      joint->friction = childNumbers(*dynamics, "friction", {0}, where)[0];
      joint->stiffness = childNumbers(*dynamics, "spring_stiffness", {0}, where)[0];
      joint->reference = childNumbers(*dynamics, "spring_reference", {0}, where)[0];
    }
    if (const XMLElement* limit = axis.FirstChildElement("limit")) {
      readLimits(*limit, where, joint);
    }
  }

  void readLimits(const XMLElement& limit, const std::string& where, SdfJoint* joint) const {
    const double far = joint->kind == SdfJoint::Kind::kHinge ? 1e3 : 1e6;
    const auto bound = [&](const char* name, double none) {
      // "inf" is not a number that a pose could hold, but it is a limit.
      const bool infinite = childText(limit, name).find("inf") != std::string::npos;
      return infinite ? none : childNumbers(limit, name, {none}, where)[0];
    };
    const double lower = bound("lower", -2 * kNoLimit), upper = bound("upper", 2 * kNoLimit);
    if (lower > -kNoLimit || upper < kNoLimit) {
      joint->limits = {lower > -kNoLimit ? lower : -far, upper < kNoLimit ? upper : far};
    }
  }

  std::string title_;
  SdfScene scene_;
  std::map<std::string, int> index_;
};

}  // namespace

bool looksLikeSdf(const std::string& text) {
  const std::string root = rootName(text);
  return root == "sdf" || root == "gazebo" || root == "model" || root == "world";
}

SdfScene readSdf(const std::string& text, const std::string& folder, const std::string& title,
                 const ResourceResolver& resolve, const std::string& model_name) {
  const bool is_world = model_name.empty();
  tinyxml2::XMLDocument document(true, tinyxml2::COLLAPSE_WHITESPACE);
  std::set<std::string> notes;
  expandSdf(text, SdfFiles(folder, resolve), title, model_name, &document, &notes);
  const XMLElement& root = *document.RootElement();
  int worlds = 0;
  forEach(root, "world", [&worlds](const XMLElement&) { ++worlds; });
  const XMLElement* model = root.FirstChildElement("model");
  noteUnknown(root, "the file", {"world", "model"}, &notes);
  if (model != nullptr && (worlds > 0 ? is_world : model->NextSiblingElement("model") != nullptr)) {
    notes.insert(worlds > 0 ? "models outside the world" : "models after the first one");
  }
  Reader reader(title, std::move(notes));
  if (is_world && worlds == 1) {
    reader.readWorld(*root.FirstChildElement("world"));
  } else if (model != nullptr && (worlds == 0 || !is_world)) {
    const SdfFrames frames(root, title);
    reader.readTopModel(*model, frames);
  } else if (is_world) {
    throw std::runtime_error(title + ": an SDF world file must hold one <world>; this one holds " +
                             std::to_string(worlds) + ".");
  } else {
    throw std::runtime_error(title + ": there is no <model> in the SDF text.");
  }
  return reader.take();
}

}  // namespace franka_sim::physics
