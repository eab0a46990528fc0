// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/sdf_shapes.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <sdf/Box.hh>
#include <sdf/Capsule.hh>
#include <sdf/Cylinder.hh>
#include <sdf/Ellipsoid.hh>
#include <sdf/Material.hh>
#include <sdf/Mesh.hh>
#include <sdf/Plane.hh>
#include <sdf/Sphere.hh>

namespace franka_sim_mujoco::physics {
namespace {

using Kind = SdfShape::Kind;

/// Where a collision says nothing: all bits.
constexpr unsigned kEveryBit = 65535;

/// Gazebo's plain materials, by the word after "Gazebo/".
const std::map<std::string, std::array<double, 3>>& plainMaterials() {
  static const std::map<std::string, std::array<double, 3>> kColours{
      {"Black", {0.05, 0.05, 0.05}},  {"Blue", {0.1, 0.15, 0.9}},    {"DarkGrey", {0.2, 0.2, 0.2}},
      {"DarkGray", {0.2, 0.2, 0.2}},  {"Gold", {0.85, 0.65, 0.15}},  {"Green", {0.1, 0.7, 0.15}},
      {"Grey", {0.55, 0.55, 0.55}},   {"Gray", {0.55, 0.55, 0.55}},  {"Indigo", {0.3, 0.05, 0.5}},
      {"Orange", {0.95, 0.5, 0.1}},   {"Purple", {0.6, 0.1, 0.65}},  {"Red", {0.85, 0.1, 0.1}},
      {"Turquoise", {0.1, 0.8, 0.8}}, {"White", {0.95, 0.95, 0.95}}, {"Wood", {0.72, 0.58, 0.42}},
      {"Yellow", {0.95, 0.85, 0.1}},
  };
  return kColours;
}

sdf::ElementPtr child(const sdf::ElementPtr& element, std::initializer_list<const char*> path) {
  sdf::ElementPtr found = element;
  for (const char* name : path) {
    if (!found || !found->HasElement(name)) {
      return nullptr;
    }
    found = found->GetElement(name);
  }
  return found;
}

std::optional<double> numberIn(const sdf::ElementPtr& element, const char* name) {
  if (!element || !element->HasElement(name)) {
    return std::nullopt;
  }
  return element->Get<double>(name);
}

std::optional<SdfShape> readMesh(const sdf::Mesh& mesh, const SdfFiles& files,
                                 const std::string& what, std::set<std::string>* unsupported) {
  SdfShape shape;
  shape.kind = Kind::kMesh;
  const std::filesystem::path from(mesh.FilePath());
  const bool is_file = from.has_parent_path() && from.is_absolute();
  shape.mesh.file = files.find(mesh.Uri(), is_file ? from.parent_path().string() : "");
  if (shape.mesh.file.empty()) {
    unsupported->insert(what + ": the mesh '" + mesh.Uri() + "' was not found");
    return std::nullopt;
  }
  shape.mesh.scale = {mesh.Scale().X(), mesh.Scale().Y(), mesh.Scale().Z()};
  shape.mesh.submesh = mesh.Submesh();
  shape.mesh.center = !mesh.Submesh().empty() && mesh.CenterSubmesh();
  return shape;
}

}  // namespace

Eigen::Isometry3d toIsometry(const ignition::math::Pose3d& pose) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.translation() = Eigen::Vector3d(pose.Pos().X(), pose.Pos().Y(), pose.Pos().Z());
  const ignition::math::Quaterniond& q = pose.Rot();
  result.linear() = Eigen::Quaterniond(q.W(), q.X(), q.Y(), q.Z()).normalized().matrix();
  return result;
}

std::array<double, 3> rgb(const ignition::math::Color& colour) {
  return {colour.R(), colour.G(), colour.B()};
}

std::optional<SdfShape> readShape(const sdf::Geometry& geometry, const SdfFiles& files,
                                  const std::string& what, std::set<std::string>* unsupported) {
  SdfShape shape;
  if (const sdf::Box* box = geometry.BoxShape()) {
    shape.kind = Kind::kBox;
    shape.size = {box->Size().X(), box->Size().Y(), box->Size().Z()};
  } else if (const sdf::Sphere* sphere = geometry.SphereShape()) {
    shape.kind = Kind::kSphere;
    shape.size.x() = sphere->Radius();
  } else if (const sdf::Cylinder* cylinder = geometry.CylinderShape()) {
    shape.kind = Kind::kCylinder;
    shape.size = {cylinder->Radius(), cylinder->Length(), 0};
  } else if (const sdf::Capsule* capsule = geometry.CapsuleShape()) {
    shape.kind = Kind::kCapsule;
    shape.size = {capsule->Radius(), capsule->Length(), 0};
  } else if (const sdf::Ellipsoid* ellipsoid = geometry.EllipsoidShape()) {
    shape.kind = Kind::kEllipsoid;
    shape.size = {ellipsoid->Radii().X(), ellipsoid->Radii().Y(), ellipsoid->Radii().Z()};
  } else if (const sdf::Plane* plane = geometry.PlaneShape()) {
    shape.kind = Kind::kPlane;
    shape.size = {plane->Size().X(), plane->Size().Y(), 0};
    const Eigen::Vector3d normal(plane->Normal().X(), plane->Normal().Y(), plane->Normal().Z());
    shape.pose.linear() =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal).matrix();
  } else if (const sdf::Mesh* mesh = geometry.MeshShape()) {
    return readMesh(*mesh, files, what, unsupported);
  } else {
    const bool empty = geometry.Type() == sdf::GeometryType::EMPTY;
    unsupported->insert(what + (empty ? ": it has no shape that is known" : ": its shape"));
    return std::nullopt;
  }
  return shape;
}

SdfSurface readSurface(const sdf::ElementPtr& collision, const std::string& what,
                       std::set<std::string>* unsupported) {
  SdfSurface surface;
  const sdf::ElementPtr element = child(collision, {"surface"});
  const sdf::ElementPtr ode = child(element, {"friction", "ode"});
  if (const auto mu = numberIn(ode, "mu")) {
    surface.mu = *mu;
  }
  const double mu2 = numberIn(ode, "mu2").value_or(surface.mu);
  if (mu2 != surface.mu) {
    unsupported->insert(what + ": mu2 other than mu (the smaller one counts in every direction)");
    surface.mu = std::min(surface.mu, mu2);
  }
  for (const char* slip : {"slip1", "slip2"}) {
    if (numberIn(ode, slip).value_or(0) != 0) {
      unsupported->insert(what + ": " + slip);
    }
  }
  if (const sdf::ElementPtr torsional = child(element, {"friction", "torsional"})) {
    // The moment of a round, evenly loaded patch: 3 pi / 16 of radius, coefficient and load.
    const double radius = numberIn(torsional, "patch_radius").value_or(0);
    if (numberIn(torsional, "coefficient") && radius > 0) {
      surface.torsion = 3 * M_PI / 16 * radius * *numberIn(torsional, "coefficient");
    }
  }
  if (numberIn(child(element, {"bounce"}), "restitution_coefficient").value_or(0) != 0) {
    unsupported->insert(what + ": bounce");
  }
  const sdf::ElementPtr contact = child(element, {"contact"});
  surface.kp = numberIn(child(contact, {"ode"}), "kp");
  surface.kd = numberIn(child(contact, {"ode"}), "kd");
  if (contact && contact->HasElement("collide_bitmask")) {
    const auto mask = contact->Get<unsigned>("collide_bitmask");
    surface.bitmask = mask == kEveryBit ? 1 : static_cast<int>(mask);
  }
  if (contact && contact->HasElement("collide_without_contact") &&
      contact->Get<bool>("collide_without_contact")) {
    unsupported->insert(what + ": collide_without_contact");
  }
  return surface;
}

std::optional<std::array<double, 4>> readColour(const sdf::Visual& visual, const std::string& what,
                                                std::set<std::string>* unsupported) {
  const sdf::Material* material = visual.Material();
  if (material == nullptr) {
    return std::nullopt;
  }
  if (material->PbrMaterial() != nullptr) {
    unsupported->insert(what + ": textures of a <pbr> material");
  }
  const std::string script = material->ScriptName();
  if (script.empty()) {
    const ignition::math::Color& diffuse = material->Diffuse();
    return std::array<double, 4>{diffuse.R(), diffuse.G(), diffuse.B(), diffuse.A()};
  }
  const auto known = plainMaterials().find(script.substr(script.rfind('/') + 1));
  if (known == plainMaterials().end()) {
    unsupported->insert(what + ": the material '" + script + "' (it is drawn grey)");
    return kGrey;
  }
  return std::array<double, 4>{known->second[0], known->second[1], known->second[2], 1};
}

}  // namespace franka_sim_mujoco::physics
