// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Meshes of SDF worlds and of robots: poses, colors, and errors.
#include <franka_sim/physics/world_bodies.h>
#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <cstring>

#include "physics/engine/file_registry.h"
#include "physics/meshes/mesh_file.h"
#include "physics/meshes/triangle_mesh.h"
#include "sdf_test.h"

namespace franka_sim::test {
namespace {

using physics::TriangleMesh;
using ::testing::HasSubstr;
using ::testing::Not;

using Box = Eigen::AlignedBox3d;
using Vector = Eigen::Vector3d;

const std::string kBox =
    "<instance_geometry url='#box'><bind_material><technique_common>"
    "<instance_material symbol='m' target='#red'/></technique_common></bind_material>"
    "</instance_geometry>";
const std::string kLid =
    "<instance_geometry url='#lid'><bind_material><technique_common>"
    "<instance_material symbol='m' target='#blue'/></technique_common></bind_material>"
    "</instance_geometry>";

std::string effect(const std::string& name, const std::string& color) {
  return "<effect id='" + name + "-fx'><profile_COMMON><technique sid='common'><lambert><diffuse>" +
         color + "</diffuse></lambert></technique></profile_COMMON></effect>";
}

std::string geometry(const std::string& id, const std::string& positions, int vertices,
                     const std::string& counts, int faces, const std::string& corners) {
  return "<geometry id='" + id + "' name='" + id + "'><mesh><source id='" + id +
         "-p'><float_array id='" + id + "-a' count='" + std::to_string(3 * vertices) + "'>" +
         positions + "</float_array><technique_common><accessor source='#" + id + "-a' count='" +
         std::to_string(vertices) +
         "' stride='3'><param name='X' type='float'/><param name='Y' type='float'/>"
         "<param name='Z' type='float'/></accessor></technique_common></source><vertices id='" +
         id + "-v'><input semantic='POSITION' source='#" + id +
         "-p'/></vertices><polylist material='m' count='" + std::to_string(faces) +
         "'><input semantic='VERTEX' source='#" + id + "-v' offset='0'/><vcount>" + counts +
         "</vcount><p>" + corners + "</p></polylist></mesh></geometry>";
}

/// A red box from 0 0 0 to 2 4 6 and a blue square from 0 0 6 to 2 2 6 facing up, in centimeters.
std::string collada(const std::string& nodes, const std::string& up = "Z_UP",
                    const std::string& blue = "<color>0.1 0.2 0.9 1</color>") {
  return "<?xml version='1.0'?><COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' "
         "version='1.4.1'><asset><created>2026-01-01T00:00:00</created>"
         "<modified>2026-01-01T00:00:00</modified><unit name='centimeter' meter='0.01'/><up_axis>" +
         up +
         "</up_axis></asset><library_images><image id='picture'><init_from>wood.png"
         "</init_from></image></library_images><library_effects>" +
         effect("red", "<color>0.8 0.1 0.2 1</color>") + effect("blue", blue) +
         "</library_effects><library_materials><material id='red'><instance_effect url='#red-fx'/>"
         "</material><material id='blue'><instance_effect url='#blue-fx'/></material>"
         "</library_materials><library_geometries>" +
         geometry("box", "0 0 0 0 0 6 0 4 0 0 4 6 2 0 0 2 0 6 2 4 0 2 4 6", 8, "4 4 4 4 4 4", 6,
                  "0 1 3 2 4 6 7 5 0 4 5 1 2 3 7 6 0 2 6 4 1 5 7 3") +
         geometry("lid", "0 0 6 2 0 6 2 2 6 0 2 6", 4, "4", 1, "0 1 2 3") +
         "</library_geometries><library_visual_scenes><visual_scene id='s'>" + nodes +
         "</visual_scene></library_visual_scenes><scene><instance_visual_scene url='#s'/></scene>"
         "</COLLADA>";
}

std::string node(const std::string& name, const std::string& content) {
  return "<node id='" + name + "-id' name='" + name + "'>" + content + "</node>";
}

std::string mesh(const std::string& file, const std::string& more = "") {
  return "<geometry><mesh><uri>" + file + "</uri>" + more + "</mesh></geometry>";
}

std::string visual(const std::string& file, const std::string& of_mesh = "",
                   const std::string& more = "") {
  return "<visual name='v'>" + mesh(file, of_mesh) + more + "</visual>";
}

std::string collision(const std::string& file, const std::string& of_mesh = "") {
  return "<collision name='c'>" + mesh(file, of_mesh) + "</collision>";
}

std::string model(const std::string& content, const std::string& pose = "0 0 0 0 0 0") {
  return "<model name='m'><pose>" + pose +
         "</pose><link name='l'><inertial><mass>1</mass>"
         "<inertia><ixx>0.001</ixx><iyy>0.001</iyy><izz>0.001</izz></inertia></inertial>" +
         content + "</link></model>";
}

/// Bounding box of a body's meshes in the body's frame, and their surface [m^2].
struct Reach {
  Box box;
  double area{0};
  int geoms{0}, vertices{0}, faces{0};
};

Reach reachOf(World& world, const std::string& body) {
  const mjModel& m = *implOf(world).model;
  const int id = bodyId(world, body);
  Reach reach;
  for (int g = 0; g < m.ngeom; ++g) {
    if (m.geom_bodyid[g] != id || m.geom_type[g] != mjGEOM_MESH) {
      continue;
    }
    const int mesh = m.geom_dataid[g];
    const double* q = m.geom_quat + 4 * g;
    const Eigen::Quaterniond turn(q[0], q[1], q[2], q[3]);
    const auto vertex = [&](int v) -> Vector {
      const float* p = m.mesh_vert + 3 * (m.mesh_vertadr[mesh] + v);
      return turn * Vector(p[0], p[1], p[2]) + Eigen::Map<const Vector>(m.geom_pos + 3 * g);
    };
    for (int v = 0; v < m.mesh_vertnum[mesh]; ++v) {
      reach.box.extend(vertex(v));
    }
    for (int f = 0; f < m.mesh_facenum[mesh]; ++f) {
      const int* corner = m.mesh_face + 3 * (m.mesh_faceadr[mesh] + f);
      const Vector a = vertex(corner[0]);
      reach.area += (vertex(corner[1]) - a).cross(vertex(corner[2]) - a).norm() / 2;
    }
    ++reach.geoms;
    reach.vertices += m.mesh_vertnum[mesh];
    reach.faces += m.mesh_facenum[mesh];
  }
  return reach;
}

void expectReach(const Box& box, const Vector& least, const Vector& most) {
  EXPECT_LT((box.min() - least).norm(), 1e-7) << box.min().transpose();
  EXPECT_LT((box.max() - most).norm(), 1e-7) << box.max().transpose();
}

class SdfMeshTest : public SdfTest {};

/// Expected numbers are those of Gazebo's own Collada reader (libignition-common4-graphics): units
/// and nodes count, the declared up axis does not.
TEST_F(SdfMeshTest, ColladaPosesMatchGazebo) {
  const std::string nodes =
      node("outer", "<translate>10 0 0</translate><rotate>0 0 1 90</rotate>" +
                        node("inner", "<translate>0 0 20</translate><scale>2 1 1</scale>" + kBox));
  for (const char* up : {"X_UP", "Y_UP", "Z_UP"}) {
    write("a.dae", collada(nodes, up));
    World world(file(model(visual("a.dae") + collision("a.dae"))));
    EXPECT_EQ(world.unsupported(), "") << up;
    const Reach reach = reachOf(world, "m");
    EXPECT_EQ(reach.geoms, 2);
    expectReach(reach.box, {0.06, 0, 0.2}, {0.1, 0.04, 0.26});
    EXPECT_EQ(reach.vertices, 16);
    EXPECT_NEAR(reach.area, 2 * 2 * (0.04 * 0.04 + 0.04 * 0.06 + 0.06 * 0.04), 1e-8);
  }
}

TEST_F(SdfMeshTest, ScaleAndPoseApply) {
  write("a.dae", collada(node("n", kBox)));
  World world(file(model("<visual name='v'><pose>0 0 1 0 0 1.5707963267948966</pose>" +
                         mesh("a.dae", "<scale>10 -5 2</scale>") + "</visual>")));
  expectReach(reachOf(world, "m").box, {0, 0, 1}, {0.2, 0.2, 1.12});
}

TEST_F(SdfMeshTest, SubmeshesAreFoundByTheirNodesAndCentered) {
  write("a.dae", collada(node("body", kBox) + node("top", "<translate>0 0 4</translate>" + kLid) +
                         "<node id='anonymous'>" + kLid + "</node>"));
  const auto boxOf = [&](const std::string& submesh) {
    World world(file(model(visual("a.dae", "<submesh>" + submesh + "</submesh>"))));
    EXPECT_EQ(world.unsupported(), "");
    return reachOf(world, "m").box;
  };
  expectReach(boxOf("<name>body</name>"), {0, 0, 0}, {0.02, 0.04, 0.06});
  expectReach(boxOf("<name>body</name><center>true</center>"), {-0.01, -0.02, -0.03},
              {0.01, 0.02, 0.03});
  // A square gets a back, 0.1 mm behind its front.
  expectReach(boxOf("<name>top</name>"), {0, 0, 0.0999}, {0.02, 0.02, 0.1});
  expectReach(boxOf("<name>anonymous</name>"), {0, 0, 0.0599}, {0.02, 0.02, 0.06});
  World world(file(model(visual("a.dae", "<submesh><name>legs</name></submesh>"))));
  EXPECT_THAT(world.unsupported(), HasSubstr("visual 'v' of 'm::l'"));
  EXPECT_THAT(world.unsupported(), HasSubstr("no triangles of the name 'legs'"));
}

TEST_F(SdfMeshTest, MaterialColorsOverrideMeshColors) {
  write("a.dae", collada(node("n", kBox + kLid)));
  write("b.stl",
        "solid b\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
        "vertex 0 1 0\nendloop\nendfacet\nendsolid b\n");
  const auto colors = [&](const std::string& text) {
    World world(file(model(text)));
    const mjModel& m = *implOf(world).model;
    std::vector<std::array<float, 4>> result;
    for (int g = 0; g < m.ngeom; ++g) {
      const float* c = m.geom_rgba + 4 * g;
      result.push_back({c[0], c[1], c[2], c[3]});
    }
    return result;
  };
  using Colors = std::vector<std::array<float, 4>>;
  EXPECT_EQ(colors(visual("a.dae")), (Colors{{0.8F, 0.1F, 0.2F, 1}, {0.1F, 0.2F, 0.9F, 1}}));
  EXPECT_EQ(colors(visual("a.dae", "", "<transparency>0.75</transparency>")),
            (Colors{{0.8F, 0.1F, 0.2F, 0.25F}, {0.1F, 0.2F, 0.9F, 0.25F}}));
  const std::array<float, 4> green{0.1F, 0.7F, 0.2F, 1};
  EXPECT_EQ(colors(visual("a.dae", "", "<material><diffuse>0.1 0.7 0.2 1</diffuse></material>")),
            (Colors{green, green}));
  EXPECT_EQ(colors(visual("b.stl")), (Colors{{0.7F, 0.7F, 0.7F, 1}}));
}

TEST_F(SdfMeshTest, ReportsTextures) {
  const std::string textured =
      collada(node("n", kBox + kLid), "Z_UP", "<texture texture='picture' texcoord='UV'/>");
  write("a.dae", textured);
  World world(file(model(visual("a.dae"))));
  EXPECT_THAT(world.unsupported(), HasSubstr("textures of the mesh " + folder_ / "a.dae"));
  EXPECT_EQ(reachOf(world, "m").geoms, 2);
  World colored(
      file(model(visual("a.dae", "", "<material><diffuse>1 0 0 1</diffuse></material>"))));
  EXPECT_EQ(colored.unsupported(), "");
}

/// A tetrahedron in three formats.
TEST_F(SdfMeshTest, FileFormatsGiveTheSameMesh) {
  const float p[4][3] = {{0, 0, 0}, {0.25F, 0, 0}, {0, 0.5F, 0}, {0, 0, 0.125F}};
  const int corners[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  std::string text = "solid t\n", binary(80, ' ');
  const auto add = [&binary](const void* data, std::size_t size) {
    binary.append(static_cast<const char*>(data), size);
  };
  const std::uint32_t faces = 4;
  const std::uint16_t attribute = 0;
  const float normal[3] = {0, 0, 0};
  add(&faces, 4);
  for (const auto& face : corners) {
    add(normal, 12);
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int corner : face) {
      add(p[corner], 12);
      text += "vertex " + franka_core::numberText(p[corner][0]) + " " +
              franka_core::numberText(p[corner][1]) + " " + franka_core::numberText(p[corner][2]) +
              "\n";
    }
    add(&attribute, 2);
    text += "endloop\nendfacet\n";
  }
  write("ascii.stl", text + "endsolid t\n");
  write("binary.STL", binary);
  write("t.obj",
        "v 0 0 0\nv 0.25 0 0\nv 0 0.5 0\nv 0 0 0.125\nf 1 3 2\nf 1 2 4\nf 1 4 3\n"
        "f 2 3 4\n");
  write("t.ply",
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
        "property float z\nelement face 4\nproperty list uchar int vertex_indices\n"
        "end_header\n0 0 0\n0.25 0 0\n0 0.5 0\n0 0 0.125\n3 0 2 1\n3 0 1 3\n3 0 3 2\n"
        "3 1 2 3\n");
  for (const char* name : {"ascii.stl", "binary.STL", "t.obj", "t.ply"}) {
    World world(file(model(visual(name) + collision(name))));
    EXPECT_EQ(world.unsupported(), "") << name;
    const Reach reach = reachOf(world, "m");
    expectReach(reach.box, {0, 0, 0}, {0.25, 0.5, 0.125});
    EXPECT_EQ(reach.vertices, 8) << name;
    EXPECT_EQ(reach.faces, 8) << name;
  }
}

const std::string kGround =
    "<model name='floor'><static>true</static><link name='l'><collision name='c'><geometry><plane>"
    "<normal>0 0 1</normal><size>5 5</size></plane></geometry></collision></link></model>";

TEST_F(SdfMeshTest, ABoxFromAMeshRestsOnItsFace) {
  write("a.dae", collada(node("n", "<translate>-1 -2 -3</translate>" + kBox)));
  World world(file(kGround + model(collision("a.dae"), "0 0 0.035 0 0 0")));
  run(world, 1000);
  EXPECT_NEAR(bodyPose(world, "m").position[2], 0.03, 2e-4);
  EXPECT_NEAR(bodyPose(world, "m").orientation[0], 1, 1e-6);
  EXPECT_GE(contacts(world).size(), 3u);
}

/// A flat mesh has no hull; a ball still rests on it, and does not fall through it from 1 m.
TEST_F(SdfMeshTest, FlatMeshesSupportBodies) {
  write("a.dae", collada(node("n", "<scale>100 100 1</scale>" + kLid)));
  World world(file("<model name='sheet'><static>true</static><link name='l'>" + visual("a.dae") +
                   collision("a.dae") +
                   "</link></model><model name='ball'><pose>1 1 1.11 0 0 0"
                   "</pose><link name='l'><inertial><mass>0.1</mass><inertia><ixx>1e-4</ixx>"
                   "<iyy>1e-4</iyy><izz>1e-4</izz></inertia></inertial><collision name='c'>"
                   "<geometry><sphere><radius>0.05</radius></sphere></geometry></collision></link>"
                   "</model>"));
  EXPECT_EQ(world.unsupported(), "");
  run(world, 3000);
  EXPECT_NEAR(bodyPose(world, "ball").position[2], 0.06 + 0.05, 1e-3);
}

TEST_F(SdfMeshTest, ReportsMeshesThatAreNotConvex) {
  // An L: a box with another one at its end.
  write("l.dae", collada(node("a", kBox) + node("b",
                                                "<translate>2 0 0</translate>"
                                                "<scale>3 1 0.3</scale>" +
                                                    kBox)));
  World world(file(model(visual("l.dae") + collision("l.dae"))));
  EXPECT_THAT(world.unsupported(), HasSubstr("collision 'c' of 'm::l': of the mesh " +
                                             folder_ / "l.dae" + " others touch the convex hull"));
  EXPECT_THAT(world.unsupported(), Not(HasSubstr("visual")));
}

TEST_F(SdfMeshTest, ReportsMeshesTooSmallToCollide) {
  write("a.dae", collada(node("n", kBox)));
  World world(file(model(visual("a.dae", "<scale>1e-4 1e-4 1e-4</scale>") +
                         collision("a.dae", "<scale>1e-4 1e-4 1e-4</scale>"))));
  EXPECT_THAT(world.unsupported(), HasSubstr("too small or too thin"));
  EXPECT_THAT(world.unsupported(), HasSubstr("scale (1e-04 1e-04 1e-04)"));
  EXPECT_THAT(world.unsupported(), Not(HasSubstr("visual")));
}

TEST_F(SdfMeshTest, ReportsBrokenFilesAndRunsTheWorld) {
  const std::string whole = collada(node("n", kBox));
  const std::pair<std::string, std::string> files[] = {
      {"empty.dae", ""},
      {"not_xml.dae", "a body"},
      {"nothing.dae", "<COLLADA version='1.4.1'/>"},
      {"cut.dae", whole.substr(0, whole.size() / 2)},
      {"index.dae", replaceAll(whole, "0 1 3 2 4", "0 1 99 2 4")},
      {"infinite.dae", replaceAll(whole, "0 0 0 0 0 6", "inf 0 0 0 0 6")},
      {"empty.stl", "solid b\nendsolid b\n"},
      {"cut.stl", std::string(80, ' ') + std::string("\4\0\0\0", 4) + std::string(60, '\1')},
      {"points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"},
      {"index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"},
      {"kind.xyz", "0 0 0"},
  };
  for (const auto& [name, content] : files) {
    write(name, content);
    World world(file(model(visual(name) + collision(name))));
    for (const std::string& part : {"visual 'v' of 'm::l': the mesh " + folder_ / name,
                                    "collision 'c' of 'm::l': the mesh " + folder_ / name}) {
      EXPECT_THAT(world.unsupported(), HasSubstr(part));
    }
    EXPECT_EQ(reachOf(world, "m").geoms, 0) << name;
  }
}

TEST_F(SdfMeshTest, RefusesTruncatedFiles) {
  const std::string whole = collada(node("n", kBox + kLid));
  for (std::size_t size = 0; size < whole.size(); size += 11) {
    const std::string path = write("cut.dae", whole.substr(0, size));
    expectSentence([&] { physics::readMeshFile(path); }, {"cut.dae", "cannot be read"});
  }
}

TEST_F(SdfMeshTest, AddedObjectsHaveTheirMesh) {
  write("a.dae", collada(node("n", kBox)));
  World world(file(kGround));
  for (const char* name : {"one", "two"}) {
    world.addObject(
        name, "<sdf version='1.6'>" + model(collision("file://" + folder_ / "a.dae")) + "</sdf>",
        {});
    expectReach(reachOf(world, name).box, {0, 0, 0}, {0.02, 0.04, 0.06});
  }
}

/// A changed file is read again.
TEST_F(SdfMeshTest, ReadsChangedFilesAgain) {
  for (const double width : {0.02, 0.2}) {
    write("a.dae", collada(node("n", width < 0.1 ? kBox : "<scale>10 1 1</scale>" + kBox)));
    World world(file(model(visual("a.dae"))));
    EXPECT_NEAR(reachOf(world, "m").box.max().x(), width, 1e-7);
  }
}

TEST_F(SdfMeshTest, RobotsMayHaveMeshesOfAnyFormat) {
  const std::string path = write("a.dae", collada(node("n", kBox)));
  RobotDescription description = robot("panda");
  const std::string link = "<link name=\"panda_link5\">";
  const std::string shape =
      "<geometry><mesh filename=\"package://x/a.dae\" scale=\"2 1 1\"/>"
      "</geometry>";
  description.urdf =
      replaceAll(description.urdf, link,
                 link + "<visual>" + shape + "</visual><collision>" + shape + "</collision>");
  description.resolve = [path](const std::string&) { return path; };
  World world;
  world.addRobot(description);
  expectReach(reachOf(world, "panda_link5").box, {0, 0, 0}, {0.04, 0.04, 0.06});
  EXPECT_NE(world.mjcf(true).find("rgba=\"0.8"), std::string::npos);
}

TEST(KeptFilesTest, StoresEqualContentOnce) {
  const std::string one = physics::registerFile("one", ".msh");
  EXPECT_EQ(one, physics::registerFile("one", ".msh"));
  EXPECT_NE(one, physics::registerFile("two", ".msh"));
  EXPECT_THAT(one, HasSubstr(".msh"));
}

/// Six times the volume, from oriented faces.
double sixVolumes(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.faces) {
    sum += mesh.vertices[a].cross(mesh.vertices[b]).dot(mesh.vertices[c]);
  }
  return sum;
}

TriangleMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}},
          {}};
}

TEST(TriangleMeshTest, MirroringKeepsTheOrientation) {
  for (const Vector& scale :
       {Vector(2, 3, 4), Vector(-2, 3, 4), Vector(-2, -3, 4), Vector(-2, -3, -4)}) {
    TriangleMesh mesh = tetrahedron();
    stretch(scale, &mesh);
    EXPECT_FLOAT_EQ(sixVolumes(mesh), 24) << scale.transpose();
  }
}

TEST(TriangleMeshTest, FlatMeshesGetABackBehindTheirFront) {
  const Eigen::Matrix3f turn =
      Eigen::AngleAxisf(1, Eigen::Vector3f(1, 2, 3).normalized()).toRotationMatrix();
  TriangleMesh sheet{{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}, {}};
  for (Eigen::Vector3f& vertex : sheet.vertices) {
    vertex = turn * vertex;
  }
  thickenFlat(0.25, &sheet);
  ASSERT_EQ(sheet.vertices.size(), 8u);
  for (int i = 4; i < 8; ++i) {
    EXPECT_NEAR((turn.transpose() * sheet.vertices[i]).z(), -0.25, 1e-6);
  }
  EXPECT_LT((extents(sheet) - Vector(0.25, 1, 2)).norm(), 1e-6);
  TriangleMesh body = tetrahedron();
  thickenFlat(0.25, &body);
  EXPECT_EQ(body.vertices.size(), 4u);
}

TEST(TriangleMeshTest, OutermostPointsGiveNearlyTheSameHull) {
  TriangleMesh ball;
  constexpr int kRings = 200;
  for (int i = 0; i <= kRings; ++i) {
    for (int j = 0; j < kRings; ++j) {
      const double t = M_PI * i / kRings, p = 2 * M_PI * j / kRings;
      ball.vertices.emplace_back(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t));
      ball.vertices.emplace_back(0.999F * ball.vertices.back());
    }
  }
  TriangleMesh few = ball;
  keepOutermost(2000, &few);
  EXPECT_LE(few.vertices.size(), 2000u);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3f direction = Eigen::Vector3f::Random().normalized();
    float reach = 0;
    for (const Eigen::Vector3f& vertex : few.vertices) {
      reach = std::max(reach, vertex.dot(direction));
    }
    EXPECT_GT(reach, 0.998F);
  }
  TriangleMesh body = tetrahedron();
  keepOutermost(2000, &body);
  EXPECT_EQ(body.vertices.size(), 4u);
}

TEST(TriangleMeshTest, DetectsConcaveMeshes) {
  TriangleMesh mesh = tetrahedron();
  EXPECT_TRUE(isConvex(mesh));
  for (auto& face : mesh.faces) {
    std::swap(face[0], face[1]);
  }
  EXPECT_TRUE(isConvex(mesh)) << "inward faces bound the same body";
  TriangleMesh beside = tetrahedron();
  for (Eigen::Vector3f& vertex : beside.vertices) {
    vertex.x() += 2;
  }
  append(beside, &mesh);
  EXPECT_FALSE(isConvex(mesh));
}

}  // namespace
}  // namespace franka_sim::test
