// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/sdf/sdf_mjcf.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "physics/contacts/contact_parameters.h"
#include "physics/engine/rotations.h"
#include "physics/meshes/mesh_conversion.h"
#include "physics/mjcf/mjcf_files.h"
#include "physics/mjcf/xml_util.h"
#include "physics/stepping/links_without_gravity.h"

namespace franka_sim::physics {
namespace {

using tinyxml2::XMLElement;
using Kind = SdfShape::Kind;

std::string color(const std::array<double, 3>& rgb) { return toText(rgb.data(), 3); }

/// Stiffness of the simulator's own contacts [1/s^2]: 1 / time constant^2 of kContactSolref.
constexpr double kOwnStiffness = 1 / (0.01 * 0.01);
/// The impedance of soft contacts does not depend on depth, so that they are linear springs.
constexpr double kSoftImpedance = 0.9;
constexpr const char* kSoftSolimp = "0.9 0.9 0.001 0.5 2";

class SdfWriter {
 public:
  SdfWriter(SdfScene* scene, double angle_unit, tinyxml2::XMLDocument* document)
      : scene_(*scene), angle_unit_(angle_unit) {
    root_ = append(document, "mujoco");
    append(root_, "compiler")->SetAttribute("angle", angle_unit_ == 1 ? "radian" : "degree");
    assets_ = append(root_, "asset");
    worldbody_ = append(root_, "worldbody");
    contact_ = append(root_, "contact");
  }

  void writeSurroundings() {
    append(root_, "option")->SetAttribute("gravity", toText(scene_.gravity.data(), 3).c_str());
    append(root_, "size")->SetAttribute("nuser_cam", 3);
    XMLElement* headlight = append(append(root_, "visual"), "headlight");
    headlight->SetAttribute("ambient", color(scene_.ambient).c_str());
    headlight->SetAttribute("diffuse", "0.25 0.25 0.25");
    headlight->SetAttribute("specular", "0.05 0.05 0.05");
    XMLElement* sky = append(assets_, "texture");
    sky->SetAttribute("name", "sky");
    sky->SetAttribute("type", "skybox");
    sky->SetAttribute("builtin", scene_.background ? "flat" : "gradient");
    const std::array<double, 3> above = scene_.background.value_or(std::array{0.86, 0.9, 0.95});
    const std::array<double, 3> below = scene_.background.value_or(std::array{0.55, 0.66, 0.8});
    sky->SetAttribute("rgb1", color(above).c_str());
    sky->SetAttribute("rgb2", color(below).c_str());
    sky->SetAttribute("width", 64);
    sky->SetAttribute("height", 384);
  }

  SdfAsMjcf write() {
    joint_of_.assign(scene_.links.size(), -1);
    for (std::size_t j = 0; j < scene_.joints.size(); ++j) {
      joint_of_[scene_.joints[j].child] = static_cast<int>(j);
    }
    bodies_.assign(scene_.links.size(), nullptr);
    frames_.resize(scene_.links.size());
    for (const SdfModel& model : scene_.models) {
      nameBodies(model);
      for (const int link : model.links) {
        writeLink(link, 0);
      }
      writeExcludes(model);
    }
    for (const SdfLight& light : scene_.lights) {
      writeLight(light);
    }
    for (const SdfCamera& camera : scene_.cameras) {
      Eigen::Isometry3d link_pose;
      XMLElement* body = holder(camera.link, &link_pose);
      writeCamera(camera, link_pose, body);
    }
    return result_;
  }

 private:
  /// MuJoCo finds contacts of a plane twice if it belongs to another body than the world.
  bool belongsToWorld(const SdfLink& link) const {
    return link.is_static &&
           std::any_of(link.collisions.begin(), link.collisions.end(),
                       [](const SdfShape& shape) { return shape.kind == Kind::kPlane; });
  }

  void nameBodies(const SdfModel& model) {
    const bool alone = model.links.size() == 1;
    for (const int link : model.links) {
      // A single link takes the model's name and frame: users look up and move the model.
      names_[link] = alone ? model.name : scene_.links[link].name;
      const Eigen::Isometry3d& shown = alone ? model.pose : scene_.links[link].pose;
      frames_[link] = shown;
      if (belongsToWorld(scene_.links[link])) {
        frames_[link].setIdentity();
        bodies_[link] = worldbody_;
        result_.aliases.push_back({names_[link], "world", shown});
      }
      if (alone) {
        result_.aliases.push_back(
            {scene_.links[link].name, model.name, shown.inverse() * scene_.links[link].pose});
      } else if (link == model.links.front()) {
        result_.aliases.push_back({model.name, names_[link], shown.inverse() * model.pose});
      }
    }
  }

  void writeLink(int link, std::size_t depth) {
    if (written_.count(link) > 0) {
      return;
    }
    if (depth > scene_.links.size()) {
      throw std::runtime_error("The joints of model '" + scene_.links[link].model +
                               "' go round in a circle; one of its links must have no joint to a "
                               "parent.");
    }
    const int joint = joint_of_[link];
    const int parent = joint < 0 ? -1 : scene_.joints[joint].parent;
    if (parent >= 0) {
      writeLink(parent, depth + 1);
    }
    written_.insert(link);
    const Eigen::Isometry3d in_body = frames_[link].inverse() * scene_.links[link].pose;
    if (bodies_[link] == nullptr) {
      XMLElement* body = append(parent < 0 ? worldbody_ : bodies_[parent], "body");
      bodies_[link] = body;
      body->SetAttribute("name", names_[link].c_str());
      setPose(body, parent < 0 ? frames_[link] : frames_[parent].inverse() * frames_[link]);
      moving_[link] = writeMobility(link, joint, body);
      writeInertial(inBody(scene_.links[link].inertial, in_body), body);
    }
    if (!scene_.links[link].gravity) {
      const UrdfInertial inertial = inBody(scene_.links[link].inertial, in_body);
      LinksWithoutGravity::write(names_[link], inertial.mass, inertial.com, bodies_[link]);
    }
    int count = 0;
    for (const SdfShape& shape : scene_.links[link].collisions) {
      writeCollision(shape, in_body, link, &count);
    }
    for (const SdfShape& shape : scene_.links[link].visuals) {
      writeVisual(shape, in_body, link, bodies_[link]);
    }
  }

  static UrdfInertial inBody(UrdfInertial inertial, const Eigen::Isometry3d& pose) {
    inertial.com = pose * inertial.com;
    inertial.inertia = pose.linear() * inertial.inertia * pose.linear().transpose();
    return inertial;
  }

  /// @returns whether the link can move at all
  bool writeMobility(int link, int joint, XMLElement* body) {
    if (scene_.links[link].is_static) {
      return false;
    }
    if (joint < 0) {
      append(body, "freejoint")->SetAttribute("name", names_[link].c_str());
      return true;
    }
    const SdfJoint& j = scene_.joints[joint];
    const bool carried = j.parent >= 0 && moving_[j.parent];
    if (j.kind == SdfJoint::Kind::kFixed) {
      return carried;
    }
    writeJoint(j, link, body);
    return true;
  }

  void writeJoint(const SdfJoint& joint, int link, XMLElement* body) {
    const Eigen::Isometry3d to_body = frames_[link].inverse();
    const bool slides = joint.kind == SdfJoint::Kind::kSlide;
    const bool ball = joint.kind == SdfJoint::Kind::kBall;
    const double unit = slides ? 1 : angle_unit_;
    XMLElement* e = append(body, "joint");
    e->SetAttribute("name", joint.name.c_str());
    e->SetAttribute("type", ball ? "ball" : slides ? "slide" : "hinge");
    e->SetAttribute("pos", toText(Eigen::Vector3d(to_body * joint.position)).c_str());
    e->SetAttribute("armature", "0");
    e->SetAttribute("damping", toText({joint.damping}).c_str());
    e->SetAttribute("frictionloss", toText({joint.friction}).c_str());
    e->SetAttribute("stiffness", toText({joint.stiffness}).c_str());
    e->SetAttribute("limited", joint.limits ? "true" : "false");
    if (!ball) {
      e->SetAttribute("axis", toText(Eigen::Vector3d(to_body.linear() * joint.axis)).c_str());
      e->SetAttribute("springref", toText({joint.reference / unit}).c_str());
    }
    if (joint.limits) {
      e->SetAttribute("range",
                      toText({(*joint.limits)[0] / unit, (*joint.limits)[1] / unit}).c_str());
      e->SetAttribute("solreflimit", kStopSolref);
      e->SetAttribute("solimplimit", kContactSolimp);
    }
  }

  void writeCollision(const SdfShape& shape, const Eigen::Isometry3d& in_body, int link,
                      int* count) {
    XMLElement* body = bodies_[link];
    const bool moves = moving_[link];
    const std::string name = names_[link] + "/collision_" + std::to_string((*count)++);
    if (shape.kind == Kind::kPlane && moves) {
      note("collision", shape, link, "a plane that moves");
      return;
    }
    XMLElement* geom = append(body, "geom");
    if (shape.kind == Kind::kMesh && !setSolidMesh(shape, link, geom)) {
      body->DeleteChild(geom);
      return;
    }
    geom->SetAttribute("name", name.c_str());
    setShape(shape, in_body, geom);
    const SdfSurface& surface = shape.surface;
    // The lowest bit stands for every bit, which robots and the bodies of MJCF have.
    const int own = surface.bitmask == SdfSurface::kEveryBit ? 1 : surface.bitmask << 1;
    geom->SetAttribute("contype", own);
    geom->SetAttribute("conaffinity", own == 0 ? 0 : own | 1);
    geom->SetAttribute("condim", surface.torsion ? kGraspCondim : kCondim);
    geom->SetAttribute("friction", toText({surface.mu, surface.torsion.value_or(kTorsionalFriction),
                                           kRollingFriction})
                                       .c_str());
    setStiffness(surface, scene_.links[link].inertial.mass, moves, geom);
    geom->SetAttribute("margin", "0");
    geom->SetAttribute("gap", "0");
    geom->SetAttribute("group", "3");
  }

  /// @returns whether the mesh is usable; if not, `unsupported` gives the reason
  bool setSolidMesh(const SdfShape& shape, int link, XMLElement* geom) {
    try {
      const SolidMesh mesh = loadMeshToCollide(shape.mesh);
      setMesh(geom, mesh.file);
      if (!mesh.is_convex) {
        note("collision", shape, link,
             "of the mesh " + shape.mesh.file + " others touch the convex hull");
      }
      return true;
    } catch (const std::runtime_error& error) {
      note("collision", shape, link, error.what());
      return false;
    }
  }

  void note(const std::string& kind, const SdfShape& shape, int link, const std::string& what) {
    scene_.unsupported.insert(kind + " '" + shape.name + "' of '" + scene_.links[link].name +
                              "': " + what);
  }

  /// A contact of impedance d between something fixed and mass m pushes with
  /// (s r + b v) m / (1 - d) for solref = (-s, -b), depth r and speed v.
  void setStiffness(const SdfSurface& surface, double mass, bool moves, XMLElement* geom) {
    const double weight = (1 - kSoftImpedance) / mass;
    const double stiffness = surface.kp ? *surface.kp * weight : kOwnStiffness;
    if (!moves || !(stiffness > 0 && stiffness < kOwnStiffness)) {
      geom->SetAttribute("solref", kContactSolref);
      geom->SetAttribute("solimp", kContactSolimp);
      return;
    }
    const double damping = surface.kd ? *surface.kd * weight : 2 * std::sqrt(stiffness);
    geom->SetAttribute("solref", toText({-stiffness, -damping}).c_str());
    geom->SetAttribute("solimp", kSoftSolimp);
    // The contact uses its own impedance, not the mean of both surfaces.
    geom->SetAttribute("solmix", "1000000");
  }

  void writeVisual(const SdfShape& shape, const Eigen::Isometry3d& in_body, int link,
                   XMLElement* body) {
    if (shape.kind != Kind::kMesh) {
      XMLElement* geom = append(body, "geom");
      setShape(shape, in_body, geom);
      setLook(shape.rgba.value_or(kGrey), shape.opacity, geom);
      return;
    }
    try {
      const DrawnMesh mesh = loadMeshToDraw(shape.mesh);
      for (const MeshPart& part : mesh.parts) {
        XMLElement* geom = append(body, "geom");
        setMesh(geom, part.file);
        setShape(shape, in_body, geom);
        setLook(shape.rgba.value_or(part.rgba.value_or(kGrey)), shape.opacity, geom);
      }
      if (mesh.is_textured && !shape.rgba) {
        note("visual", shape, link, "textures of the mesh " + shape.mesh.file);
      }
    } catch (const std::runtime_error& error) {
      note("visual", shape, link, error.what());
    }
  }

  static void setLook(std::array<double, 4> rgba, double opacity, XMLElement* geom) {
    rgba[3] *= opacity;
    geom->SetAttribute("contype", "0");
    geom->SetAttribute("conaffinity", "0");
    geom->SetAttribute("group", "2");
    geom->SetAttribute("mass", "0");
    geom->SetAttribute("rgba", toText(rgba.data(), 4).c_str());
  }

  static void setShape(const SdfShape& shape, const Eigen::Isometry3d& in_body, XMLElement* geom) {
    setPose(geom, in_body * shape.pose);
    const auto set = [geom](const char* type, const std::string& size) {
      geom->SetAttribute("type", type);
      if (!size.empty()) {
        geom->SetAttribute("size", size.c_str());
      }
    };
    const Eigen::Vector3d& s = shape.size;
    switch (shape.kind) {
      case Kind::kBox:
        return set("box", toText(Eigen::Vector3d(s / 2)));
      case Kind::kSphere:
        return set("sphere", toText({s.x()}));
      case Kind::kCylinder:
        return set("cylinder", toText({s.x(), s.y() / 2}));
      case Kind::kCapsule:
        return set("capsule", toText({s.x(), s.y() / 2}));
      case Kind::kEllipsoid:
        return set("ellipsoid", toText(s));
      case Kind::kPlane:
        return set("plane", toText({s.x() / 2, s.y() / 2, 0.1}));
      case Kind::kMesh:
        return set("mesh", "");
    }
  }

  void setMesh(XMLElement* geom, const std::string& file) {
    auto known = meshes_.find(file);
    if (known == meshes_.end()) {
      const std::string name =
          scene_.models.front().name + "/mesh_" + std::to_string(meshes_.size());
      XMLElement* mesh = append(assets_, "mesh");
      mesh->SetAttribute("name", name.c_str());
      mesh->SetAttribute("file", file.c_str());
      known = meshes_.emplace(file, name).first;
    }
    geom->SetAttribute("mesh", known->second.c_str());
  }

  /// Links of a model do not collide with each other unless one of them, or the model, has
  /// <self_collide>.
  void writeExcludes(const SdfModel& model) {
    const auto collides = [&](int link) {
      return scene_.links[link].self_collide.value_or(model.self_collide);
    };
    for (std::size_t a = 0; a < model.links.size(); ++a) {
      for (std::size_t b = a + 1; b < model.links.size(); ++b) {
        if (collides(model.links[a]) || collides(model.links[b])) {
          continue;
        }
        if (moving_[model.links[a]] || moving_[model.links[b]]) {
          XMLElement* e = append(contact_, "exclude");
          e->SetAttribute("body1", names_[model.links[a]].c_str());
          e->SetAttribute("body2", names_[model.links[b]].c_str());
        }
      }
    }
  }

  XMLElement* holder(int link, Eigen::Isometry3d* in_body) {
    *in_body = link < 0 ? Eigen::Isometry3d::Identity()
                        : frames_[link].inverse() * scene_.links[link].pose;
    return link < 0 ? worldbody_ : bodies_[link];
  }

  void writeLight(const SdfLight& light) {
    Eigen::Isometry3d pose;
    XMLElement* e = append(holder(light.link, &pose), "light");
    const std::string scope =
        light.link < 0 ? "" : scene_.links[static_cast<std::size_t>(light.link)].name + "::";
    if (!light.name.empty() && lights_.insert(scope + light.name).second) {
      e->SetAttribute("name", (scope + light.name).c_str());
    }
    const bool spot = light.kind == SdfLight::Kind::kSpot;
    e->SetAttribute("directional", light.kind == SdfLight::Kind::kDirectional ? "true" : "false");
    e->SetAttribute("pos", toText(Eigen::Vector3d(pose * light.position)).c_str());
    e->SetAttribute("dir", toText(Eigen::Vector3d(pose.linear() * light.direction)).c_str());
    e->SetAttribute("diffuse", color(light.diffuse).c_str());
    e->SetAttribute("specular", color(light.specular).c_str());
    e->SetAttribute("attenuation", color(light.attenuation).c_str());
    e->SetAttribute("castshadow", light.shadows ? "true" : "false");
    // OpenGL's cones have up to a right angle; beyond, light to all sides (180).
    e->SetAttribute("cutoff",
                    toText({spot ? std::clamp(light.cutoff / kDegree, 1.0, 90.0) : 180.0}).c_str());
  }

  SdfScene& scene_;
  double angle_unit_;
  SdfAsMjcf result_;
  XMLElement *root_, *assets_, *worldbody_, *contact_;
  std::vector<int> joint_of_;
  std::vector<XMLElement*> bodies_;
  std::vector<Eigen::Isometry3d, Eigen::aligned_allocator<Eigen::Isometry3d>> frames_;
  std::map<int, std::string> names_;
  std::map<int, bool> moving_;
  std::set<int> written_;
  std::set<std::string> lights_;  ///< names
  std::map<std::string, std::string> meshes_;
};

}  // namespace

SdfAsMjcf writeSdf(SdfScene* scene, double angle_unit, bool surroundings,
                   tinyxml2::XMLDocument* document) {
  SdfWriter writer(scene, angle_unit, document);
  if (surroundings) {
    writer.writeSurroundings();
  }
  return writer.write();
}

}  // namespace franka_sim::physics
