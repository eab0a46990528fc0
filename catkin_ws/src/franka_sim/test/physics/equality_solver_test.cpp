// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Which solver a step uses: equalities are solved directly, piles by conjugate gradients,
// everything else by MuJoCo's Newton method.
#include "physics/stepping/equality_solver.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "physics/world/world_impl.h"
#include "stone_in_hand.h"

namespace franka_sim::test {
namespace {

class EqualitySolverTest : public StoneInHandTest {
 protected:
  /// The constraints of the present state, solved by both.
  void compare() {
    World::Impl& impl = implOf(world_);
    const mjModel& model = *impl.model;
    const physics::DataPtr ours(mj_copyData(nullptr, &model, impl.data.get()));
    impl.model->opt.disableflags |= mjDSBL_CONTACT;
    mj_step1(&model, ours.get());
    impl.model->opt.disableflags &= ~mjDSBL_CONTACT;
    mj_fwdActuation(&model, ours.get());
    mj_fwdAcceleration(&model, ours.get());
    const physics::DataPtr theirs(mj_copyData(nullptr, &model, ours.get()));
    rows_ = ours->nefc;
    ASSERT_EQ(ours->ne, rows_) << "equalities only";
    mj_fwdConstraint(&model, theirs.get());
    physics::EqualitySolver solver;
    solver.fit(model);
    solver.solve(model, ours.get());
    expectNear(theirs->qacc, ours->qacc, model.nv, "qacc");
    expectNear(theirs->qacc_warmstart, ours->qacc_warmstart, model.nv, "qacc_warmstart");
    expectNear(theirs->qfrc_constraint, ours->qfrc_constraint, model.nv, "qfrc_constraint");
    expectNear(theirs->efc_force, ours->efc_force, rows_, "efc_force");
  }

  static void expectNear(const double* theirs, const double* ours, int count, const char* what) {
    double largest = 0.0;
    for (int i = 0; i < count; ++i) {
      largest = std::max(largest, std::abs(theirs[i]));
    }
    for (int i = 0; i < count; ++i) {
      EXPECT_NEAR(theirs[i], ours[i], 1e-6 * largest + 1e-9) << what << ' ' << i;
    }
  }

  int rows_{0};
};

TEST_P(EqualitySolverTest, CoupledFingersAreAsWithMuJoCo) {
  for (int k = 0; k < 400; ++k) {
    auto q_d = kHome;
    q_d[0] += 0.3 * std::sin(0.01 * k);
    holder_->hold(q_d);
    const double opening = hand_->measure().q[0];  // away from the stops, which are inequalities
    hand_->applyForces({20.0 * (0.02 - opening) + std::sin(0.1 * k), 0.0});
    if (k % 10 == 0) {
      compare();
      ASSERT_FALSE(HasFatalFailure());
      EXPECT_EQ(1, rows_);
    }
    world_.step();
  }
}

TEST_P(EqualitySolverTest, ClosedBrakesAreAsWithMuJoCo) {
  for (int k = 0; k < 100; ++k) {
    auto q_d = kHome;
    q_d[0] += 0.5 * std::sin(0.01 * k);
    holder_->hold(q_d);
    world_.step();
  }
  arm_->setBrakes(true);
  for (int k = 0; k < 50; ++k) {
    compare();
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_EQ(8, rows_);
    world_.step();
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, EqualitySolverTest, ::testing::Values("panda"));

/// Cubes that touch each other in layers, in their first step.
class PileSolverTest : public ::testing::Test {
 protected:
  PileSolverTest() : world_(test::world("empty")) {}

  void addCube(double x, double y, double z) {
    world_.addObject(
        "cube" + std::to_string(cubes_++),
        "<body><freejoint/><geom type='box' size='0.02 0.02 0.02' mass='0.05'/></body>",
        at(x, y, z));
  }
  /// @param side cubes at each side of the lowest layer; each layer has one less than that below
  void addPile(int side) {
    constexpr double kPitch = 0.0399;  // [m] a little less than a cube's side
    for (int layer = 0; layer < side; ++layer) {
      const int length = side - layer;
      for (int i = 0; i < length * length; ++i) {
        const int row = i / length;
        addCube(kPitch * (i % length + 0.5 * layer), kPitch * (row + 0.5 * layer),
                0.0199 + kPitch * layer);
      }
    }
  }
  /// Velocities after a step from the initial state with a model that names a solver.
  std::vector<double> velocitiesWith(mjtSolver solver) {
    World::Impl& impl = implOf(world_);
    world_.reset();
    impl.model->opt.solver = solver;
    world_.step();
    return {impl.data->qvel, impl.data->qvel + impl.model->nv};
  }
  std::size_t contactsBetweenCubes() {
    const auto found = contacts(world_);
    return std::count_if(found.begin(), found.end(), [](const Contact& contact) {
      return contact.body1.find("cube") == 0 && contact.body2.find("cube") == 0;
    });
  }

  World world_;
  int cubes_{0};
};

TEST_F(PileSolverTest, ManyContactsBetweenMovingBodiesAreSolvedByConjugateGradients) {
  addPile(4);
  ASSERT_EQ(mjSOL_NEWTON, implOf(world_).model->opt.solver);
  const std::vector<double> velocities = velocitiesWith(mjSOL_NEWTON);
  EXPECT_GT(contactsBetweenCubes(), 200u);
  EXPECT_EQ(velocitiesWith(mjSOL_CG), velocities);
  EXPECT_NE(velocitiesWith(mjSOL_PGS), velocities) << "a model that names another solver keeps it";
}

TEST_F(PileSolverTest, ContactsWithTheGroundDoNotCount) {
  addPile(2);
  std::string feet;
  for (int i = 0; i < 60; ++i) {
    feet += "<geom type='box' size='0.02 0.02 0.02' pos='" + franka_core::numberText(0.1 * i) +
            " 0 0'/>";
  }
  world_.addObject("table", "<body><freejoint/>" + feet + "</body>", at(-3, 1, 0.0199));
  const std::vector<double> velocities = velocitiesWith(mjSOL_NEWTON);
  EXPECT_GT(contacts(world_).size(), 200u);
  EXPECT_LT(contactsBetweenCubes(), 200u);
  EXPECT_NE(velocitiesWith(mjSOL_CG), velocities);
}

}  // namespace
}  // namespace franka_sim::test
