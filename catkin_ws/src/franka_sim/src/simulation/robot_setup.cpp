// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/robot/control_unit_parameters.h>
#include <franka_sim/robot/realism.h>
#include <franka_sim/simulation/files.h>
#include <franka_sim/simulation/robot_setup.h>
#include <tinyxml2.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace franka_sim {
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
  if (hand) {
    parameters.F_T_NE = kHandF_T_NE;
  }
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
