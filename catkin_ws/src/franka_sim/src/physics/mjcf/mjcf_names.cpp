// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/mjcf/mjcf_names.h"

#include <filesystem>
#include <map>

#include "physics/mjcf/xml_util.h"

namespace franka_sim::physics {
namespace {

using tinyxml2::XMLElement;

/// Attributes that refer to a name, and its kind.
const std::map<std::string, std::string>& references() {
  static const std::map<std::string, std::string> kReferences{
      {"material", "material"}, {"mesh", "mesh"},  {"hfield", "hfield"}, {"texture", "texture"},
      {"target", "body"},       {"body", "body"},  {"body1", "body"},    {"body2", "body"},
      {"geom1", "geom"},        {"geom2", "geom"}, {"joint1", "joint"},  {"joint2", "joint"}};
  return kReferences;
}

/// The attribute with the element's name, or with the beginning of the names that it stands for.
const char* nameAttribute(const XMLElement& element) {
  return std::string(element.Name()) == "composite" ? "prefix" : "name";
}

std::string kindOf(const XMLElement& element) {
  const auto* parent = element.Parent() != nullptr ? element.Parent()->ToElement() : nullptr;
  if (parent != nullptr && std::string(parent->Name()) == "equality") {
    return "equality";  // its elements are called joint, too
  }
  const std::string kind = element.Name();
  return kind == "freejoint" ? "joint" : kind;
}

/// Empty if it has none.
std::string nameOf(const XMLElement& element) {
  const std::string kind = element.Name();
  const std::string name = optional(element, nameAttribute(element));
  const bool is_of_file = kind == "mesh" || kind == "texture" || kind == "hfield";
  return name.empty() && is_of_file
             ? std::filesystem::path(optional(element, "file")).stem().string()
             : name;
}

template <typename Element, typename Visit>
void visitAll(Element* parent, const Visit& visit) {
  for (auto* e = parent->FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    visit(e);
    visitAll(e, visit);
  }
}

}  // namespace

MjcfNames namesOf(const XMLElement& root) {
  MjcfNames names;
  visitAll(&root, [&](const XMLElement* e) {
    if (const std::string name = nameOf(*e); !name.empty()) {
      names.emplace(kindOf(*e), name);
    }
  });
  return names;
}

void prefixNames(XMLElement* root, const std::string& prefix) {
  const MjcfNames names = namesOf(*root);
  visitAll(root, [&](XMLElement* e) {
    for (const auto& [attribute, kind] : references()) {
      const std::string name = optional(*e, attribute.c_str());
      if (names.count({kind, name}) > 0) {
        e->SetAttribute(attribute.c_str(), (prefix + name).c_str());
      }
    }
    if (const std::string name = nameOf(*e); !name.empty()) {
      e->SetAttribute(nameAttribute(*e), (prefix + name).c_str());
    }
  });
}

}  // namespace franka_sim::physics
