// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/mjcf/mjcf_world.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "physics/contacts/contact_capacity.h"
#include "physics/contacts/contact_parameters.h"
#include "physics/engine/model_compiler.h"
#include "physics/engine/model_data.h"
#include "physics/engine/rotations.h"
#include "physics/mjcf/mjcf_files.h"
#include "physics/mjcf/xml_util.h"

namespace franka_sim::physics {
namespace {

using tinyxml2::XMLElement;

constexpr const char* kEmptyWorld = R"(<mujoco model="empty">
  <asset>
    <texture name="sky" type="skybox" builtin="gradient" rgb1="0.72 0.8 0.9" rgb2="0.95 0.96 0.98"
      width="64" height="384"/>
    <texture name="ground" type="2d" builtin="checker" rgb1="0.83 0.84 0.85" rgb2="0.79 0.8 0.81"
      width="256" height="256"/>
    <material name="ground" texture="ground" texrepeat="2 2" texuniform="true" specular="0.1"/>
  </asset>
  <worldbody>
    <light name="sun" directional="true" pos="1 -1 4" dir="-0.35 0.4 -1" diffuse="0.55 0.55 0.55"
      specular="0.15 0.15 0.15" castshadow="true"/>
    <geom name="ground" type="plane" size="5 5 0.1" material="ground" condim="3" solref="0.01 1"/>
  </worldbody>
</mujoco>)";

/// Empty when it cannot be read.
std::string readText(const std::string& file) {
  std::error_code error;
  std::ostringstream text;
  if (std::filesystem::is_regular_file(file, error)) {
    text << std::ifstream(file, std::ios::binary).rdbuf();
  }
  return text.str();
}

/// The last element of that name below the root (robots come after the world file's content); added
/// if there is none.
XMLElement* section(XMLElement* root, const char* name) {
  XMLElement* found = root->LastChildElement(name);
  return found != nullptr ? found : append(root, name);
}

/// Sections may appear several times and later ones win, so all of them are read and written.
void setEverywhere(XMLElement* root, const char* name, const char* attribute, const char* value) {
  section(root, name);
  for (auto* e = root->FirstChildElement(name); e != nullptr; e = e->NextSiblingElement(name)) {
    e->SetAttribute(attribute, value);
  }
}

/// Refuses compiler settings that would silently change robots.
void checkCompiler(const XMLElement& root, const std::string& title) {
  for (auto* e = root.FirstChildElement("compiler"); e != nullptr;
       e = e->NextSiblingElement("compiler")) {
    for (const char* attribute : {"boundmass", "boundinertia", "settotalmass", "inertiafromgeom",
                                  "strippath", "coordinate", "fusestatic"}) {
      if (e->Attribute(attribute) != nullptr) {
        throw std::runtime_error(title + ": the compiler setting '" + attribute + "' in line " +
                                 std::to_string(e->GetLineNum()) +
                                 " would change the robots too; remove it.");
      }
    }
  }
}

double angleUnit(const XMLElement& root) {
  double unit = kDegree;
  for (auto* e = root.FirstChildElement("compiler"); e != nullptr;
       e = e->NextSiblingElement("compiler")) {
    const std::string angle = optional(*e, "angle");
    if (!angle.empty()) {
      unit = angle == "radian" ? 1.0 : kDegree;
    }
  }
  return unit;
}

/// Geoms with their sliding friction: the world's by name, those of robots from the attribute.
void collectGeoms(XMLElement* body, const std::map<std::string, double>& frictions,
                  std::vector<std::pair<XMLElement*, double>>* geoms) {
  for (auto* e = body->FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    const std::string kind = e->Name();
    if (kind == "body") {
      collectGeoms(e, frictions, geoms);
    } else if (kind == "geom") {
      const auto known = frictions.find(optional(*e, "name"));
      const char* own = e->Attribute("friction");
      if (known != frictions.end()) {
        geoms->emplace_back(e, known->second);
      } else if (own != nullptr) {
        geoms->emplace_back(e, toNumbers(own, "friction").front());
      }
    }
  }
}

bool movesFreely(const mjModel& model, int body) {
  for (int b = body; b > 0; b = model.body_parentid[b]) {
    if (model.body_dofnum[b] > 0) {
      return true;
    }
  }
  return false;
}

}  // namespace

MjcfWorld::MjcfWorld(const std::string& file, ResourceResolver resolve)
    : title_(file.empty() ? "The built-in world" : "World file " + file),
      resolve_(std::move(resolve)) {
  load(file);
  inspect();
}

MjcfWorld::MjcfWorld(const MjcfWorld& other, std::vector<std::shared_ptr<const MjcfObject>> objects)
    : title_(other.title_),
      resolve_(other.resolve_),
      objects_(std::move(objects)),
      aliases_(other.aliases_),
      unsupported_(other.unsupported_),
      angle_unit_(other.angle_unit_) {
  other.document_.DeepCopy(&document_);
  inspect();
}

std::unique_ptr<MjcfWorld> MjcfWorld::with(const std::string& object, const std::string& text,
                                           const Pose& pose) const {
  const auto added = readObject(object, text, pose, angle_unit_, resolve_);
  tinyxml2::XMLDocument present;
  compose(&present);
  avoidNamesOf(*present.RootElement(), added.get());
  auto all = objects_;
  all.push_back(added);
  return std::unique_ptr<MjcfWorld>(new MjcfWorld(*this, std::move(all)));
}

std::unique_ptr<MjcfWorld> MjcfWorld::without(const std::string& object) const {
  std::vector<std::shared_ptr<const MjcfObject>> rest;
  for (const auto& present : objects_) {
    if (present->name != object) {
      rest.push_back(present);
    }
  }
  if (rest.size() == objects_.size()) {
    throw std::runtime_error("There is no object '" + object +
                             "' that was put into the simulated world.");
  }
  return std::unique_ptr<MjcfWorld>(new MjcfWorld(*this, std::move(rest)));
}

std::vector<std::string> MjcfWorld::objects() const {
  std::vector<std::string> names;
  for (const auto& object : objects_) {
    names.push_back(object->name);
  }
  return names;
}

std::vector<BodyAlias> MjcfWorld::aliases() const {
  std::vector<BodyAlias> all = aliases_;
  for (const auto& object : objects_) {
    all.insert(all.end(), object->aliases.begin(), object->aliases.end());
  }
  return all;
}

std::set<std::string> MjcfWorld::unsupported(const std::string& object) const {
  for (const auto& present : objects_) {
    if (present->name == object) {
      return present->unsupported;
    }
  }
  return object.empty() ? unsupported_ : std::set<std::string>();
}

void MjcfWorld::load(const std::string& file) {
  std::string folder;
  if (file.empty()) {
    document_.Parse(kEmptyWorld);
  } else {
    folder = folderOf(file);
    const std::string text = readText(file);
    if (looksLikeSdf(text)) {
      loadSdf(text, folder);
    } else {
      loadExpanded(file, title_, &document_);
    }
  }
  XMLElement* root = document_.RootElement();
  if (root == nullptr || std::string(root->Name()) != "mujoco") {
    throw std::runtime_error(title_ + ": it is neither MJCF nor SDF, its root element is " +
                             (root == nullptr ? "missing" : "<" + std::string(root->Name()) + ">") +
                             " instead of <mujoco> or <sdf>.");
  }
  checkCompiler(*root, title_);
  normalize(folder);
}

void MjcfWorld::loadSdf(const std::string& text, const std::string& folder) {
  SdfScene scene = readSdf(text, folder, title_, resolve_);
  aliases_ = writeSdf(&scene, 1, true, &document_).aliases;
  unsupported_ = scene.unsupported;
}

void MjcfWorld::normalize(const std::string& folder) {
  XMLElement* root = document_.RootElement();
  angle_unit_ = angleUnit(*root);
  makeFilesAbsolute(root, folder);
  unsupported_.merge(dropKeyframes(root));
  unsupported_.merge(noteAutolimits(*root));
  repairInertias(root, title_, &unsupported_);
  // As since MuJoCo 3; robots say of every joint whether it is limited.
  setEverywhere(root, "compiler", "autolimits", "true");
  setEverywhere(root, "option", "timestep", kTimestep);
  setEverywhere(root, "option", "integrator", "Euler");
  setEverywhere(root, "option", "cone", "elliptic");
  setEverywhere(root, "option", "impratio", kImpratio);
  XMLElement* visual = section(root, "visual");
  section(visual, "quality")->SetAttribute("shadowsize", "1024");
  section(visual, "quality")->SetAttribute("offsamples", "0");
  int count = 0;
  for (auto* e = root->FirstChildElement("worldbody"); e != nullptr;
       e = e->NextSiblingElement("worldbody")) {
    nameGeoms(e, "world", &count);
  }
}

void MjcfWorld::compose(tinyxml2::XMLDocument* document) const {
  document_.DeepCopy(document);
  for (const auto& object : objects_) {
    for (auto* from = object->document.RootElement()->FirstChildElement(); from != nullptr;
         from = from->NextSiblingElement()) {
      if (std::string(from->Name()) == "compiler") {
        continue;
      }
      XMLElement* to = section(document->RootElement(), from->Name());
      for (auto* e = from->FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
        to->InsertEndChild(e->DeepClone(document));
      }
    }
  }
}

void MjcfWorld::inspect() {
  tinyxml2::XMLDocument composed;
  compose(&composed);
  const ModelPtr model =
      compile(toText(composed),
              objects_.empty() ? title_ : title_ + " with object '" + objects_.back()->name + "'");
  for (int i = 0; i < model->ngeom; ++i) {
    WorldGeom geom;
    const char* name = mj_id2name(model.get(), mjOBJ_GEOM, i);
    const char* body = mj_id2name(model.get(), mjOBJ_BODY, model->geom_bodyid[i]);
    geom.name = name != nullptr ? name : "";
    geom.body = body != nullptr ? body : "";
    geom.friction = model->geom_friction[3 * i];
    geom.torsion = model->geom_friction[3 * i + 1];
    geom.graspable = movesFreely(*model, model->geom_bodyid[i]);
    geom.collides = (model->geom_contype[i] | model->geom_conaffinity[i]) != 0;
    geoms_.push_back(geom);
    has_priorities_ = has_priorities_ || model->geom_priority[i] != 0;
  }
}

/// Of two surfaces the more slippery one decides, as in Gazebo; MuJoCo would take the rougher one
/// (decision 37). It prefers the one of higher priority, so the priority is the rank in
/// slipperiness.
void MjcfWorld::rankFrictions(XMLElement* root) const {
  std::map<std::string, double> frictions;
  for (const WorldGeom& geom : geoms_) {
    frictions[geom.name] = geom.friction;
  }
  std::vector<std::pair<XMLElement*, double>> geoms;
  for (auto* e = root->FirstChildElement("worldbody"); e != nullptr;
       e = e->NextSiblingElement("worldbody")) {
    collectGeoms(e, frictions, &geoms);
  }
  std::set<double> values;
  for (const auto& [geom, friction] : geoms) {
    values.insert(friction);
  }
  for (const auto& [geom, friction] : geoms) {
    const auto rougher = std::distance(values.upper_bound(friction), values.end());
    geom->SetAttribute("priority", static_cast<int>(rougher));
  }
}

GivenSizes MjcfWorld::givenSizes() const {
  GivenSizes given;
  for (auto* e = document_.RootElement()->FirstChildElement("size"); e != nullptr;
       e = e->NextSiblingElement("size")) {
    given.nconmax = given.nconmax || e->Attribute("nconmax") != nullptr;
    given.njmax = given.njmax || e->Attribute("njmax") != nullptr;
    given.nstack = given.nstack || e->Attribute("nstack") != nullptr;
  }
  return given;
}

std::string MjcfWorld::merge(const std::vector<const RobotModel*>& robots, bool visuals) const {
  tinyxml2::XMLDocument merged;
  compose(&merged);
  XMLElement* root = merged.RootElement();
  const MjcfTarget target{section(root, "asset"),
                          section(root, "worldbody"),
                          section(root, "contact"),
                          section(root, "equality"),
                          visuals,
                          angle_unit_,
                          &geoms_};
  for (const RobotModel* robot : robots) {
    writeRobot(*robot, target);
  }
  if (!visuals && !has_priorities_) {
    rankFrictions(root);
  }
  return toText(merged);
}

}  // namespace franka_sim::physics
