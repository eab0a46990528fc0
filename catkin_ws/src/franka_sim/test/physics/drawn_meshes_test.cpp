// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "physics/engine/model_compiler.h"
#include "physics/engine/model_data.h"
#include "physics/meshes/mesh_simplification.h"

namespace franka_sim::physics {
namespace {

using Vertex = Eigen::Vector3f;

constexpr int kSteps = 40;
constexpr float kRadius = 0.1F;  // [m]
constexpr float kError = 3e-4F;  // (decision 63)

/// A cube of `kSteps` squares along each edge, with each vertex moved by `shape`.
ModelPtr model(const std::function<Vertex(const Vertex&)>& shape) {
  std::ostringstream vertices, faces;
  int count = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0F, 1.0F}) {
      for (int i = 0; i <= kSteps; ++i) {
        for (int j = 0; j <= kSteps; ++j) {
          Vertex v;
          v[axis] = side;
          v[(axis + 1) % 3] = 2.0F * i / kSteps - 1.0F;
          v[(axis + 2) % 3] = 2.0F * j / kSteps - 1.0F;
          vertices << shape(v).transpose() << " ";
          if (i < kSteps && j < kSteps) {
            const int a = count, b = count + kSteps + 1, c = b + 1, d = count + 1;
            const std::array<int, 6> up{a, b, c, a, c, d}, down{a, c, b, a, d, c};
            for (const int corner : side > 0 ? up : down) {
              faces << corner << " ";
            }
          }
          ++count;
        }
      }
    }
  }
  return compile("<mujoco><asset><mesh name='m' vertex='" + vertices.str() + "' face='" +
                     faces.str() +
                     "'/></asset><worldbody><geom type='mesh' mesh='m'/></worldbody>"
                     "</mujoco>",
                 "a test");
}

Vertex onCube(const Vertex& v) { return kRadius * v; }
Vertex onBall(const Vertex& v) { return kRadius * v.normalized(); }

Vertex vertexOf(const mjModel& m, int face, int corner) {
  return Vertex::Map(m.mesh_vert + 3 * m.mesh_face[3 * face + corner]);
}
Vertex normalOf(const mjModel& m, int face, int corner) {
  return Vertex::Map(m.mesh_normal + 3 * m.mesh_face[3 * face + corner]);
}
Vertex middleOf(const mjModel& m, int face) {
  return (vertexOf(m, face, 0) + vertexOf(m, face, 1) + vertexOf(m, face, 2)) / 3.0F;
}

TEST(DrawnMeshesTest, ABallKeepsItsShapeWithFewerFaces) {
  const ModelPtr ball = model(onBall);
  const int before = ball->mesh_facenum[0];
  simplifyDrawnMeshes(ball.get());
  EXPECT_LT(ball->mesh_facenum[0], before / 2);
  for (int face = 0; face < ball->mesh_facenum[0]; ++face) {
    const Vertex middle = middleOf(*ball, face);
    EXPECT_NEAR(kRadius, middle.norm(), 2 * kError);
    const Vertex area = (vertexOf(*ball, face, 1) - vertexOf(*ball, face, 0))
                            .cross(vertexOf(*ball, face, 2) - vertexOf(*ball, face, 0));
    EXPECT_GT(area.dot(middle), 0.0F);  // seen from outside
    for (int corner = 0; corner < 3; ++corner) {
      const Vertex normal = normalOf(*ball, face, corner);
      EXPECT_NEAR(1.0F, normal.norm(), 1e-5F);
      EXPECT_GT(normal.dot(vertexOf(*ball, face, corner).normalized()), 0.98F);
    }
  }
}

TEST(DrawnMeshesTest, ACubeKeepsItsEdges) {
  const ModelPtr cube = model(onCube);
  simplifyDrawnMeshes(cube.get());
  EXPECT_LT(cube->mesh_facenum[0], 100);
  float area = 0.0F;
  for (int face = 0; face < cube->mesh_facenum[0]; ++face) {
    const Vertex twice = (vertexOf(*cube, face, 1) - vertexOf(*cube, face, 0))
                             .cross(vertexOf(*cube, face, 2) - vertexOf(*cube, face, 0));
    area += twice.norm() / 2.0F;
    for (int corner = 0; corner < 3; ++corner) {
      EXPECT_NEAR(1.0F, normalOf(*cube, face, corner).dot(twice.normalized()), 1e-5F);
    }
  }
  EXPECT_NEAR(24.0F * kRadius * kRadius, area, 1e-5F);
}

TEST(DrawnMeshesTest, MeshesOfFewFacesStayAsTheyAre) {
  const ModelPtr before = compile(
      "<mujoco><asset><mesh name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 1'/></asset><worldbody><geom "
      "type='mesh' mesh='m'/></worldbody></mujoco>",
      "a test");
  const ModelPtr after(mj_copyModel(nullptr, before.get()));
  simplifyDrawnMeshes(after.get());
  ASSERT_EQ(before->mesh_facenum[0], after->mesh_facenum[0]);
  EXPECT_TRUE(
      std::equal(before->mesh_vert, before->mesh_vert + 3 * before->nmeshvert, after->mesh_vert));
}

}  // namespace
}  // namespace franka_sim::physics
