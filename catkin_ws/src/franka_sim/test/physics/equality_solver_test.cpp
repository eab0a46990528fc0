// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Equalities that are solved directly, against MuJoCo's own solver.
#include <cmath>
#include <vector>

#include "physics/step_preparation.h"
#include "physics/world_impl.h"
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

}  // namespace
}  // namespace franka_sim::test
