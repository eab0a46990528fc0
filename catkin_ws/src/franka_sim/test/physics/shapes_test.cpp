// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/physics/world_bodies.h>
#include <franka_sim/physics/world_shapes.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <set>
#include <string>

#include "temporary_folder.h"
#include "test_support.h"

namespace franka_sim::test {
namespace {

constexpr char kWorld[] = R"(<mujoco>
  <asset>
    <material name="red" rgba="0.8 0.1 0.1 1"/>
    <mesh name="wedge" vertex="0 0 0  1 0 0  0 1 0  0 0 1"/>
  </asset>
  <worldbody>
    <geom type="plane" size="2 3 0.1" rgba="0.1 0.2 0.3 1"/>
    <body name="stone" pos="0.6 0.4 0.5">
      <freejoint/>
      <geom type="box" size="0.01 0.02 0.03" pos="0 0 0.1" material="red"/>
      <geom type="sphere" size="0.2" group="3"/>
      <geom type="sphere" size="0.2" rgba="1 1 1 0"/>
    </body>
    <body pos="-1 0 1"><freejoint/><geom type="mesh" mesh="wedge" pos="0 0 0.5"/></body>
  </worldbody></mujoco>)";

class ShapesTest : public ::testing::Test {
 protected:
  std::size_t indexOf(const std::string& body) const {
    const auto& names = shapes.bodies;
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), body) - names.begin());
  }
  std::vector<Shape> shapesOn(const std::string& body) const {
    std::vector<Shape> result;
    for (const Shape& shape : shapes.shapes) {
      if (shape.body == indexOf(body)) {
        result.push_back(shape);
      }
    }
    return result;
  }

  franka_test::TemporaryFolder folder;
  World world{folder.write("world.xml", kWorld)};
  WorldShapes shapes = shapesOf(world)();
};

TEST_F(ShapesTest, HaveKindSizePlaceAndColor) {
  ASSERT_EQ(1U, shapesOn("world").size());
  const Shape plane = shapesOn("world")[0];
  EXPECT_EQ(Shape::Kind::kPlane, plane.kind);
  EXPECT_EQ(2.0, plane.size[0]);
  EXPECT_FLOAT_EQ(0.3F, plane.color[2]);
  ASSERT_EQ(1U, shapesOn("stone").size()) << "hidden and transparent ones are left out";
  const Shape box = shapesOn("stone")[0];
  EXPECT_EQ(Shape::Kind::kBox, box.kind);
  EXPECT_EQ((std::array<double, 3>{0.01, 0.02, 0.03}), box.size);
  EXPECT_EQ(0.1, box.pose.position[2]);
  EXPECT_FLOAT_EQ(0.8F, box.color[0]) << "of its material";
}

TEST_F(ShapesTest, MeshesAreAtThePositionsOfTheirVertices) {
  ASSERT_EQ(1U, shapesOn("").size()) << "of the body without a name";
  const Shape shape = shapesOn("")[0];
  ASSERT_EQ(Shape::Kind::kMesh, shape.kind);
  const ShapeMesh& mesh = shapes.meshes.at(shape.mesh);
  ASSERT_EQ(12U, mesh.vertices.size());
  EXPECT_EQ(12U, mesh.faces.size());
  std::set<std::array<int, 3>> corners;  // [mm]
  for (std::size_t v = 0; v < 4; v++) {
    const Eigen::Vector3f vertex(mesh.vertices.data() + 3 * v);
    const Eigen::Vector3d at = toEigen(shape.pose) * vertex.cast<double>();
    corners.insert({static_cast<int>(std::lround(1e3 * at.x())),
                    static_cast<int>(std::lround(1e3 * at.y())),
                    static_cast<int>(std::lround(1e3 * at.z()))});
  }
  EXPECT_EQ(
      (std::set<std::array<int, 3>>{{0, 0, 500}, {1000, 0, 500}, {0, 1000, 500}, {0, 0, 1500}}),
      corners);
}

TEST_F(ShapesTest, EachLinkOfARobotIsABodyWithItsShapes) {
  world.addRobot(robot("panda", "left"));
  shapes = shapesOf(world)();
  for (const char* link : {"link0", "link3", "link7", "hand", "leftfinger", "rightfinger"}) {
    EXPECT_FALSE(shapesOn(std::string("left_") + link).empty()) << link;
  }
  EXPECT_LT(indexOf("left_link8"), shapes.bodies.size()) << "a frame without shapes";
}

TEST_F(ShapesTest, PosesAreThoseOfTheBodies) {
  world.addRobot(robot("fr3"));
  setBodyPose(world, "stone", {{0.1, 0.2, 0.3}, {{0.6, 0, 0.8, 0}}});
  shapes = shapesOf(world)();
  const auto& names = shapes.bodies;
  const auto poses = framePoses(world);
  ASSERT_EQ(names.size(), poses.size());
  for (std::size_t i = 0; i < names.size(); i++) {
    if (!names[i].empty()) {
      EXPECT_EQ(bodyPose(world, names[i]).position, poses[i].position) << names[i];
      EXPECT_EQ(bodyPose(world, names[i]).orientation, poses[i].orientation) << names[i];
    }
  }
  EXPECT_EQ(-1.0, poses[indexOf("")].position[0]) << "of the body without a name";
}

TEST_F(ShapesTest, TheGenerationChangesWithRobotsAndObjects) {
  const auto before = world.generation();
  world.step();
  EXPECT_EQ(before, world.generation());
  world.addRobot(robot("fr3"));
  EXPECT_NE(before, world.generation());
}

TEST_F(ShapesTest, AreReadFromAWorldThatHasGone) {
  std::function<WorldShapes()> read;
  {
    World gone;
    gone.addRobot(robot("panda"));
    read = shapesOf(gone);
  }
  EXPECT_GT(read().shapes.size(), 8U);
}

}  // namespace
}  // namespace franka_sim::test
