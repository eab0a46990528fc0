// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <dlfcn.h>
#include <franka_sim/robot/control_unit_parameters.h>
#include <franka_sim/robot/protocol_range.h>
#include <franka_sim/robot/realism.h>
#include <franka_sim/simulation/missing_file.h>
#include <franka_sim/simulation/robot_setup.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

namespace franka_sim {

namespace {

std::filesystem::path libraryFolder() {
  Dl_info info;
  return dladdr(reinterpret_cast<const void*>(&readFile), &info) != 0 && info.dli_fname != nullptr
             ? std::filesystem::path(info.dli_fname).parent_path()
             : std::filesystem::path();
}

std::string ifThere(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::exists(path, error) ? path.lexically_normal().string() : std::string();
}

/// The lines that rospack, ROS's search for packages, prints; none without ROS.
std::vector<std::string> rospack(const std::string& arguments) {
  std::vector<std::string> lines;
  if (std::getenv("ROS_PACKAGE_PATH") == nullptr) {
    return lines;
  }
  const std::string command = "rospack " + arguments + " 2>/dev/null";
  const auto close = [](std::FILE* file) { ::pclose(file); };
  const std::unique_ptr<std::FILE, decltype(close)> pipe(::popen(command.c_str(), "re"), close);
  std::string line;
  for (int c = pipe ? std::fgetc(pipe.get()) : EOF; c != EOF; c = std::fgetc(pipe.get())) {
    if (c != '\n') {
      line.push_back(static_cast<char>(c));
    } else {
      lines.push_back(std::exchange(line, {}));
    }
  }
  return lines;
}

/// Folders that packages export to gazebo_ros as gazebo_model_path. Searched once.
const std::vector<std::string>& exportedModelFolders() {
  static const std::vector<std::string> kFolders = [] {
    std::vector<std::string> folders;
    for (const std::string& line : rospack("plugins --attrib=gazebo_model_path gazebo_ros")) {
      const std::size_t space = line.find(' ');  // after the package's name
      std::istringstream list(space == std::string::npos ? "" : line.substr(space + 1));
      for (std::string folder; std::getline(list, folder, ':');) {
        folders.push_back(folder);
      }
    }
    return folders;
  }();
  return kFolders;
}

/// A file of a package of this workspace, or else of any that ROS finds.
std::string anyPackageFile(const std::string& package, const std::string& file) {
  const std::string own = packageFile(package, file);
  const auto is_plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  };
  if (!own.empty() || !std::all_of(package.begin(), package.end(), is_plain)) {
    return own;
  }
  const std::vector<std::string> found = rospack("find " + package);
  return found.empty() ? "" : ifThere(std::filesystem::path(found.front()) / file);
}

}  // namespace

std::string readFile(const std::string& name) {
  std::ifstream file(name);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) {
    throw std::runtime_error("Cannot read the file '" + name + "'.");
  }
  return text.str();
}

std::string packageFile(const std::string& package, const std::string& file) {
  const std::filesystem::path places[] = {
      libraryFolder() / "../share" / package,
#ifdef FRANKA_SIM_SOURCES
      std::filesystem::path(FRANKA_SIM_SOURCES) / package,
#endif
  };
  for (const auto& place : places) {
    const std::string found = ifThere(place / file);
    if (!found.empty()) {
      return found;
    }
  }
  return "";
}

std::string worldFile(const std::string& name) {
  std::error_code error;
  if (name.empty() || std::filesystem::exists(name, error)) {
    return name;
  }
  const std::string file = packageFile("franka_sim", "worlds/" + name);
  if (file.empty()) {
    throw MissingFile("There is no world '" + name +
                      "': neither a file nor one of those that come with franka_sim.");
  }
  return file;
}

std::string fileOfUri(const std::string& uri, const PackageFinder& find) {
  static const std::string kPackage = "package://", kFile = "file://";
  if (uri.compare(0, kFile.size(), kFile) == 0) {
    return uri.substr(kFile.size());
  }
  if (uri.compare(0, kPackage.size(), kPackage) != 0) {
    return uri;
  }
  const std::size_t slash = uri.find('/', kPackage.size());
  // Without a file in it: names such as `sun`, which are not packages; rospack would print errors
  // about them.
  if (slash == std::string::npos) {
    return "";
  }
  return find(uri.substr(kPackage.size(), slash - kPackage.size()), uri.substr(slash + 1));
}

std::string resolveUri(const std::string& uri) {
  static const std::string kModel = "model://";
  if (uri.compare(0, kModel.size(), kModel) != 0) {
    return fileOfUri(uri, anyPackageFile);
  }
  for (const std::string& folder : exportedModelFolders()) {
    const std::string found = ifThere(std::filesystem::path(folder) / uri.substr(kModel.size()));
    if (!found.empty()) {
      return found;
    }
  }
  return "";
}

namespace {

constexpr double kFingersAtStart = 0.001;  // [m] each

std::string describe(const RobotSetup& setup, bool hand) {
  if (!setup.urdf.empty()) {
    return readFile(setup.urdf);
  }
  const std::string urdf = setup.meshes ? robotWithMeshes(setup.robot, setup.arm_id).urdf
                                        : robotText(setup.robot, setup.arm_id);
  return hand ? urdf : withoutHand(urdf, setup.arm_id);
}

RobotPhysics physicsOf(const RobotSetup& setup, const char* profile) {
  const std::string file = packageFile("franka_description", "config/physics.yaml");
  if (file.empty()) {
    throw std::runtime_error("franka_sim does not find config/physics.yaml of franka_description.");
  }
  return readRobotPhysics(file, setup.robot, readRealism(setup.realism, profile));
}

RobotDescription describeRobot(const RobotSetup& setup, const std::string& urdf,
                               const RobotPhysics& physics, bool hand) {
  RobotDescription robot;
  robot.name = setup.arm_id;
  robot.urdf = urdf;
  robot.resolve = resolveUri;
  robot.base.position = setup.base;
  robot.base.orientation = {std::cos(0.5 * setup.yaw), 0, 0, std::sin(0.5 * setup.yaw)};
  setInitialPositions(kReadyPose, setup.arm_id, robot);
  applyRestOffset(kJointStiffness, setup.arm_id, robot);
  if (hand) {
    for (const char* finger : {"_finger_joint1", "_finger_joint2"}) {
      robot.initial_positions[setup.arm_id + finger] = kFingersAtStart;
    }
  }
  applyPhysics(physics, setup.arm_id, robot);
  return robot;
}

ControlUnitParameters unitParameters(const RobotSetup& setup, const std::string& urdf,
                                     const RobotPhysics& physics, bool hand) {
  ControlUnitParameters parameters{franka_core::ArmModel::fromUrdf(urdf, setup.arm_id)};
  applyPhysics(physics, parameters);
  parameters.end_effector = franka_core::endEffectorFromUrdf(urdf, setup.arm_id);
  parameters.F_T_NE = franka_core::nominalEndEffectorFromUrdf(urdf, setup.arm_id)
                          .value_or(franka_core::kIdentityTransform);
  parameters.has_hand = hand;
  parameters.rules = InterfaceRules::kFci;
  parameters.protocol_version = protocolsOf(setup.robot).newest;
  return parameters;
}

}  // namespace

RobotInWorld addRobot(const RobotSetup& setup, const char* profile, World& world, bool hand) {
  const std::string& id = setup.arm_id;
  const std::string urdf = describe(setup, hand);
  const RobotPhysics physics = physicsOf(setup, profile);
  const bool has_hand = urdf.find(id + "_finger_joint1") != std::string::npos;
  const ControlUnitParameters unit = unitParameters(setup, urdf, physics, has_hand);
  world.addRobot(describeRobot(setup, urdf, physics, has_hand));
  return {unit, physics, &world.arm(id, id), has_hand ? &world.hand(id, id) : nullptr};
}

namespace {

using tinyxml2::XMLElement;

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

// The file in franka_description that shows a link. Both fingers are one mesh.
std::string meshOf(const std::string& robot, const std::string& part) {
  const std::string folder = robot == "fr3" ? "meshes/visual/fr3/" : "meshes/visual/";
  return folder + (endsWith(part, "finger") ? "finger" : part) + ".dae";
}

void setVisual(XMLElement* link, const std::string& mesh, bool turned) {
  while (XMLElement* visual = link->FirstChildElement("visual")) {
    link->DeleteChild(visual);
  }
  XMLElement* visual = link->InsertNewChildElement("visual");
  XMLElement* origin = visual->InsertNewChildElement("origin");
  origin->SetAttribute("xyz", "0 0 0");
  origin->SetAttribute("rpy", turned ? "0 0 3.141592653589793" : "0 0 0");
  visual->InsertNewChildElement("geometry")
      ->InsertNewChildElement("mesh")
      ->SetAttribute("filename", ("package://franka_description/" + mesh).c_str());
}

/// The link's name in an element of a joint, "parent" or "child".
std::string linkOf(const XMLElement& joint, const char* which) {
  const XMLElement* const element = joint.FirstChildElement(which);
  const char* const link = element != nullptr ? element->Attribute("link") : nullptr;
  return link != nullptr ? link : "";
}

/// Removes a link, the joint that carries it, and what it carries.
void removeBranch(XMLElement& robot, const std::string& link) {
  std::vector<std::string> carried;
  for (XMLElement* joint = robot.FirstChildElement("joint"); joint != nullptr;) {
    XMLElement* const next = joint->NextSiblingElement("joint");
    if (linkOf(*joint, "parent") == link) {
      carried.push_back(linkOf(*joint, "child"));
    }
    if (linkOf(*joint, "child") == link) {
      robot.DeleteChild(joint);
    }
    joint = next;
  }
  for (const std::string& child : carried) {
    removeBranch(robot, child);
  }
  for (XMLElement* body = robot.FirstChildElement("link"); body != nullptr;) {
    XMLElement* const next = body->NextSiblingElement("link");
    if (body->Attribute("name", link.c_str()) != nullptr) {
      robot.DeleteChild(body);
    }
    body = next;
  }
}

}  // namespace

std::string robotText(const std::string& robot, const std::string& arm_id) {
  const std::string name = "robots/" + robot + ".urdf";
  const std::string file = packageFile("franka_sim", name);
  if (file.empty()) {
    throw std::runtime_error("franka_sim does not find its file " + name +
                             "; give a robot description with --urdf.");
  }
  std::string urdf = readFile(file);
  const std::string old_name = "\"" + robot + "_";
  const std::string new_name = "\"" + arm_id + "_";
  for (std::size_t at = urdf.find(old_name); at != std::string::npos;
       at = urdf.find(old_name, at + new_name.size())) {
    urdf.replace(at, old_name.size(), new_name);
  }
  return urdf;
}

std::string withoutHand(const std::string& urdf, const std::string& arm_id) {
  tinyxml2::XMLDocument document;
  if (document.Parse(urdf.c_str()) != tinyxml2::XML_SUCCESS) {
    throw std::runtime_error("The description of the robot '" + arm_id +
                             "' is not XML: " + document.ErrorStr() + ".");
  }
  removeBranch(*document.RootElement(), arm_id + "_hand");
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

RobotLook robotWithMeshes(const std::string& robot, const std::string& arm_id) {
  tinyxml2::XMLDocument document;
  if (document.Parse(robotText(robot, arm_id).c_str()) != tinyxml2::XML_SUCCESS) {
    throw std::runtime_error("franka_sim cannot read its file robots/" + robot +
                             ".urdf: " + document.ErrorStr() + ".");
  }
  RobotLook look;
  for (XMLElement* link = document.RootElement()->FirstChildElement("link"); link != nullptr;
       link = link->NextSiblingElement("link")) {
    if (link->FirstChildElement("visual") == nullptr) {
      continue;
    }
    const std::string part = std::string(link->Attribute("name")).substr(arm_id.size() + 1);
    const std::string mesh = meshOf(robot, part);
    if (packageFile("franka_description", mesh).empty()) {
      look.missing.push_back(mesh);
    } else {
      setVisual(link, mesh, part == "rightfinger");
    }
  }
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  look.urdf = printer.CStr();
  return look;
}

}  // namespace franka_sim
