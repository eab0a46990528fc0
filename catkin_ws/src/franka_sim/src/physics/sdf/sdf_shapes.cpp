// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "physics/mjcf/xml_util.h"
#include "physics/sdf/sdf_scene.h"

namespace franka_sim::physics {
namespace {

using Kind = SdfShape::Kind;
using tinyxml2::XMLElement;

/// Gazebo's plain materials, by the word after "Gazebo/".
const std::map<std::string, std::array<double, 3>>& plainMaterials() {
  static const std::map<std::string, std::array<double, 3>> kColors{
      {"Black", {0.05, 0.05, 0.05}},  {"Blue", {0.1, 0.15, 0.9}},    {"DarkGrey", {0.2, 0.2, 0.2}},
      {"DarkGray", {0.2, 0.2, 0.2}},  {"Gold", {0.85, 0.65, 0.15}},  {"Green", {0.1, 0.7, 0.15}},
      {"Grey", {0.55, 0.55, 0.55}},   {"Gray", {0.55, 0.55, 0.55}},  {"Indigo", {0.3, 0.05, 0.5}},
      {"Orange", {0.95, 0.5, 0.1}},   {"Purple", {0.6, 0.1, 0.65}},  {"Red", {0.85, 0.1, 0.1}},
      {"Turquoise", {0.1, 0.8, 0.8}}, {"White", {0.95, 0.95, 0.95}}, {"Wood", {0.72, 0.58, 0.42}},
      {"Yellow", {0.95, 0.85, 0.1}},
  };
  return kColors;
}

const XMLElement* descend(const XMLElement* element, std::initializer_list<const char*> path) {
  for (const char* name : path) {
    element = element == nullptr ? nullptr : element->FirstChildElement(name);
  }
  return element;
}

std::optional<double> numberIn(const XMLElement* element, const char* name,
                               const std::string& where) {
  if (element == nullptr || childText(*element, name).empty()) {
    return std::nullopt;
  }
  return childNumbers(*element, name, {0}, where)[0];
}

/// Three numbers.
Eigen::Vector3d vectorIn(const XMLElement& element, const char* name,
                         const Eigen::Vector3d& fallback, const std::string& where) {
  const std::vector<double> n =
      childNumbers(element, name, {fallback.x(), fallback.y(), fallback.z()}, where);
  return {n[0], n[1], n[2]};
}

std::optional<SdfShape> readMesh(const XMLElement& mesh, const std::string& what,
                                 std::set<std::string>* unsupported) {
  SdfShape shape;
  shape.kind = Kind::kMesh;
  shape.mesh.file = childText(mesh, "uri");
  std::error_code error;
  if (!std::filesystem::path(shape.mesh.file).is_absolute() ||
      !std::filesystem::exists(shape.mesh.file, error)) {
    unsupported->insert(what + ": the mesh '" + shape.mesh.file + "' was not found");
    return std::nullopt;
  }
  const Eigen::Vector3d scale = vectorIn(mesh, "scale", Eigen::Vector3d::Ones(), what);
  shape.mesh.scale = {scale.x(), scale.y(), scale.z()};
  if (const XMLElement* submesh = mesh.FirstChildElement("submesh")) {
    shape.mesh.submesh = childText(*submesh, "name");
    shape.mesh.center = !shape.mesh.submesh.empty() && isTrue(*submesh, "center");
  }
  return shape;
}

}  // namespace

std::array<double, 4> readColor(const XMLElement& element, const char* name,
                                const std::array<double, 4>& fallback, const std::string& where) {
  const std::string text = childText(element, name);
  if (text.empty()) {
    return fallback;
  }
  const std::vector<double> n = toNumbers(text, where + ", <" + name + ">");
  if (n.size() != 3 && n.size() != 4) {
    throw std::runtime_error(where + ": <" + name + "> needs 3 or 4 numbers and has " +
                             std::to_string(n.size()) + ".");
  }
  return {n[0], n[1], n[2], n.size() == 4 ? n[3] : 1.0};
}

std::optional<SdfShape> readShape(const XMLElement& thing, const std::string& what,
                                  std::set<std::string>* unsupported) {
  const XMLElement* geometry = thing.FirstChildElement("geometry");
  const XMLElement* form = geometry == nullptr ? nullptr : geometry->FirstChildElement();
  const std::string kind = form == nullptr ? "empty" : form->Name();
  const auto number = [&](const char* name, double fallback) {
    return childNumbers(*form, name, {fallback}, what)[0];
  };
  SdfShape shape;
  if (kind == "box") {
    shape.kind = Kind::kBox;
    shape.size = vectorIn(*form, "size", Eigen::Vector3d::Ones(), what);
  } else if (kind == "sphere") {
    shape.kind = Kind::kSphere;
    shape.size.x() = number("radius", 1);
  } else if (kind == "cylinder") {
    shape.kind = Kind::kCylinder;
    shape.size = {number("radius", 1), number("length", 1), 0};
  } else if (kind == "capsule") {
    shape.kind = Kind::kCapsule;
    shape.size = {number("radius", 0.5), number("length", 1), 0};
  } else if (kind == "ellipsoid") {
    shape.kind = Kind::kEllipsoid;
    shape.size = vectorIn(*form, "radii", Eigen::Vector3d::Ones(), what);
  } else if (kind == "plane") {
    shape.kind = Kind::kPlane;
    const std::vector<double> size = childNumbers(*form, "size", {1, 1}, what);
    shape.size = {size[0], size[1], 0};
    const Eigen::Vector3d normal = vectorIn(*form, "normal", Eigen::Vector3d::UnitZ(), what);
    shape.pose.linear() =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal).matrix();
  } else if (kind == "mesh") {
    return readMesh(*form, what, unsupported);
  } else {
    unsupported->insert(what + (kind == "empty" ? ": it has no shape that is known"
                                                : ": its shape <" + kind + ">"));
    return std::nullopt;
  }
  return shape;
}

namespace {

/// 16 bits, as a whole number or with 0x. Of a longer mask the lowest ones count.
int readBitmask(const XMLElement* contact, const std::string& what) {
  constexpr std::int64_t kMax = 0xFFFFFFFF;
  const XMLElement* element = descend(contact, {"collide_bitmask"});
  if (element == nullptr || element->GetText() == nullptr) {
    return SdfSurface::kEveryBit;
  }
  const std::string_view text = element->GetText();
  std::optional<std::int64_t> mask;
  if (text.substr(0, 2) == "0x") {
    std::int64_t bits = -1;
    const auto [end, error] = std::from_chars(text.data() + 2, text.data() + text.size(), bits, 16);
    const bool whole = error == std::errc() && end == text.data() + text.size();
    mask = whole && bits >= 0 && bits <= kMax ? std::optional(bits) : std::nullopt;
  } else if (const std::optional<double> number = franka_core::readNumber(text)) {
    mask = franka_core::wholeNumber(*number, 0, kMax);
  }
  if (!mask) {
    throw std::runtime_error(what + ": the collide_bitmask is " + std::string(text) +
                             "; it must be a whole number from 0 to 65535.");
  }
  return static_cast<int>(*mask & SdfSurface::kEveryBit);
}

}  // namespace

SdfSurface readSurface(const XMLElement& collision, const std::string& what,
                       std::set<std::string>* unsupported) {
  SdfSurface surface;
  const XMLElement* element = collision.FirstChildElement("surface");
  const auto noteOthers = [&](const XMLElement* parent, std::initializer_list<const char*> known) {
    if (parent != nullptr) {
      noteUnknown(*parent, what, known, unsupported);
    }
  };
  noteOthers(element, {"friction", "bounce", "contact"});
  noteOthers(descend(element, {"friction"}), {"ode", "bullet", "torsional"});
  noteOthers(descend(element, {"contact"}),
             {"ode", "bullet", "collide_bitmask", "collide_without_contact",
              "collide_without_contact_bitmask", "poissons_ratio", "elastic_modulus"});
  const XMLElement* ode = descend(element, {"friction", "ode"});
  surface.mu = numberIn(ode, "mu", what).value_or(surface.mu);
  const double mu2 = numberIn(ode, "mu2", what).value_or(surface.mu);
  if (mu2 != surface.mu) {
    unsupported->insert(what + ": mu2 other than mu (the smaller one counts in every direction)");
    surface.mu = std::min(surface.mu, mu2);
  }
  for (const char* slip : {"slip1", "slip2"}) {
    if (numberIn(ode, slip, what).value_or(0) != 0) {
      unsupported->insert(what + ": " + slip);
    }
  }
  if (const XMLElement* torsional = descend(element, {"friction", "torsional"})) {
    // The moment of a round, evenly loaded patch: 3 pi / 16 of radius, coefficient and load.
    const double radius = numberIn(torsional, "patch_radius", what).value_or(0);
    const auto coefficient = numberIn(torsional, "coefficient", what);
    if (coefficient && radius > 0) {
      surface.torsion = 3 * M_PI / 16 * radius * *coefficient;
    }
  }
  const XMLElement* bounce = descend(element, {"bounce"});
  if (numberIn(bounce, "restitution_coefficient", what).value_or(0) != 0) {
    unsupported->insert(what + ": bounce");
  }
  const XMLElement* contact = descend(element, {"contact"});
  surface.kp = numberIn(descend(contact, {"ode"}), "kp", what);
  surface.kd = numberIn(descend(contact, {"ode"}), "kd", what);
  surface.bitmask = readBitmask(contact, what);
  if (contact != nullptr && isTrue(*contact, "collide_without_contact")) {
    unsupported->insert(what + ": collide_without_contact");
  }
  return surface;
}

std::optional<std::array<double, 4>> readMaterial(const XMLElement& visual, const std::string& what,
                                                  std::set<std::string>* unsupported) {
  const XMLElement* material = visual.FirstChildElement("material");
  if (material == nullptr) {
    return std::nullopt;
  }
  if (material->FirstChildElement("pbr") != nullptr) {
    unsupported->insert(what + ": textures of a <pbr> material");
  }
  const XMLElement* named = material->FirstChildElement("script");
  const std::string script = named == nullptr ? std::string() : childText(*named, "name");
  if (script.empty()) {
    return readColor(*material, "diffuse", {1, 1, 1, 1}, what);
  }
  const auto known = plainMaterials().find(script.substr(script.rfind('/') + 1));
  if (known == plainMaterials().end()) {
    unsupported->insert(what + ": the material '" + script + "' (it is drawn gray)");
    return kGrey;
  }
  return std::array<double, 4>{known->second[0], known->second[1], known->second[2], 1};
}

}  // namespace franka_sim::physics
