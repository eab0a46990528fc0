// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_hw/franka_model_interface.h>
#include <franka_hw/model_base.h>
#include <gtest/gtest.h>

#include <type_traits>

namespace franka_hw {
namespace {

static_assert(!std::is_default_constructible_v<FrankaModelHandle>);
static_assert(std::is_nothrow_destructible_v<ModelBase>);

/// Records its arguments and returns numbers that identify the called function.
class RecordingModel : public ModelBase {
 public:
  using ModelBase::bodyJacobian;
  using ModelBase::coriolis;
  using ModelBase::gravity;
  using ModelBase::mass;
  using ModelBase::pose;
  using ModelBase::zeroJacobian;

  std::array<double, 16> pose(franka::Frame frame_in, const std::array<double, 7>& q_in,
                              const std::array<double, 16>& F_T_EE_in,
                              const std::array<double, 16>& EE_T_K_in) const override {
    remember(frame_in, q_in, F_T_EE_in, EE_T_K_in);
    return {{1.0}};
  }
  std::array<double, 42> bodyJacobian(franka::Frame frame_in, const std::array<double, 7>& q_in,
                                      const std::array<double, 16>& F_T_EE_in,
                                      const std::array<double, 16>& EE_T_K_in) const override {
    remember(frame_in, q_in, F_T_EE_in, EE_T_K_in);
    return {{2.0}};
  }
  std::array<double, 42> zeroJacobian(franka::Frame frame_in, const std::array<double, 7>& q_in,
                                      const std::array<double, 16>& F_T_EE_in,
                                      const std::array<double, 16>& EE_T_K_in) const override {
    remember(frame_in, q_in, F_T_EE_in, EE_T_K_in);
    return {{3.0}};
  }
  std::array<double, 49> mass(const std::array<double, 7>& q_in,
                              const std::array<double, 9>& inertia_in, double mass_in,
                              const std::array<double, 3>& com_in) const override {
    rememberBody(q_in, mass_in, com_in);
    inertia = inertia_in;
    return {{4.0}};
  }
  std::array<double, 7> coriolis(const std::array<double, 7>& q_in,
                                 const std::array<double, 7>& dq_in,
                                 const std::array<double, 9>& inertia_in, double mass_in,
                                 const std::array<double, 3>& com_in) const override {
    rememberBody(q_in, mass_in, com_in);
    dq = dq_in;
    inertia = inertia_in;
    return {{5.0}};
  }
  std::array<double, 7> gravity(const std::array<double, 7>& q_in, double mass_in,
                                const std::array<double, 3>& com_in,
                                const std::array<double, 3>& gravity_in) const override {
    rememberBody(q_in, mass_in, com_in);
    gravity_earth = gravity_in;
    return {{6.0}};
  }

  mutable franka::Frame frame{};
  mutable std::array<double, 7> q{}, dq{};
  mutable std::array<double, 16> F_T_EE{}, EE_T_K{};
  mutable std::array<double, 9> inertia{};
  mutable std::array<double, 3> com{}, gravity_earth{};
  mutable double total_mass{};

 private:
  void remember(franka::Frame frame_in, const std::array<double, 7>& q_in,
                const std::array<double, 16>& F_T_EE_in,
                const std::array<double, 16>& EE_T_K_in) const {
    frame = frame_in;
    q = q_in;
    F_T_EE = F_T_EE_in;
    EE_T_K = EE_T_K_in;
  }
  void rememberBody(const std::array<double, 7>& q_in, double mass_in,
                    const std::array<double, 3>& com_in) const {
    q = q_in;
    total_mass = mass_in;
    com = com_in;
  }
};

class ModelTest : public testing::Test {
 protected:
  ModelTest() {
    state.q.fill(0.5);
    state.dq.fill(-0.25);
    state.F_T_EE.fill(2.0);
    state.EE_T_K.fill(3.0);
    state.I_total.fill(4.0);
    state.m_total = 5.0;
    state.F_x_Ctotal.fill(6.0);
    state.O_ddP_O = {{1.0, 2.0, 3.0}};
    // These values must never reach a model of the total load:
    state.m_load = state.m_ee = -1.0;
    state.q_d.fill(-1.0);
  }

  void expectKinematics(franka::Frame frame) const {
    EXPECT_EQ(frame, model.frame);
    EXPECT_EQ(state.q, model.q);
    EXPECT_EQ(state.F_T_EE, model.F_T_EE);
    EXPECT_EQ(state.EE_T_K, model.EE_T_K);
  }
  void expectBody() const {
    EXPECT_EQ(state.q, model.q);
    EXPECT_EQ(5.0, model.total_mass);
    EXPECT_EQ(state.F_x_Ctotal, model.com);
  }

  RecordingModel model;
  franka::RobotState state;
  FrankaModelHandle handle{"panda_model", model, state};
  const std::array<double, 3> kUpright{{0.0, 0.0, -9.81}};
};

TEST_F(ModelTest, TakesKinematicsFromTheState) {
  EXPECT_EQ(1.0, model.pose(franka::Frame::kJoint3, state)[0]);
  expectKinematics(franka::Frame::kJoint3);
  EXPECT_EQ(2.0, model.bodyJacobian(franka::Frame::kFlange, state)[0]);
  expectKinematics(franka::Frame::kFlange);
  EXPECT_EQ(3.0, model.zeroJacobian(franka::Frame::kStiffness, state)[0]);
  expectKinematics(franka::Frame::kStiffness);
}

TEST_F(ModelTest, TakesTheTotalLoadFromTheState) {
  EXPECT_EQ(4.0, model.mass(state)[0]);
  expectBody();
  EXPECT_EQ(state.I_total, model.inertia);
  EXPECT_EQ(5.0, model.coriolis(state)[0]);
  expectBody();
  EXPECT_EQ(state.dq, model.dq);
}

TEST_F(ModelTest, TakesGravityFromTheBaseSensor) {
  EXPECT_EQ(6.0, model.gravity(state)[0]);
  expectBody();
  EXPECT_EQ(state.O_ddP_O, model.gravity_earth);
  model.gravity(state, {{0.0, 9.81, 0.0}});
  EXPECT_EQ((std::array<double, 3>{0.0, 9.81, 0.0}), model.gravity_earth);
  model.gravity(state.q, 5.0, state.F_x_Ctotal);
  EXPECT_EQ(kUpright, model.gravity_earth);
}

TEST_F(ModelTest, HandleEvaluatesTheLiveState) {
  EXPECT_EQ("panda_model", handle.getName());
  state.q.fill(1.5);
  EXPECT_EQ(1.0, handle.getPose(franka::Frame::kEndEffector)[0]);
  expectKinematics(franka::Frame::kEndEffector);
  EXPECT_EQ(2.0, handle.getBodyJacobian(franka::Frame::kJoint1)[0]);
  expectKinematics(franka::Frame::kJoint1);
  EXPECT_EQ(3.0, handle.getZeroJacobian(franka::Frame::kJoint7)[0]);
  expectKinematics(franka::Frame::kJoint7);
  EXPECT_EQ(4.0, handle.getMass()[0]);
  expectBody();
  EXPECT_EQ(5.0, handle.getCoriolis()[0]);
  expectBody();
}

TEST_F(ModelTest, HandleAssumesUprightGravityByDefault) {
  handle.getGravity();
  expectBody();
  EXPECT_EQ(kUpright, model.gravity_earth);
  handle.getGravity({{0.0, 1.0, 0.0}});
  EXPECT_EQ((std::array<double, 3>{0.0, 1.0, 0.0}), model.gravity_earth);
  handle.getGravity({{7, 7, 7, 7, 7, 7, 7}}, 8.0, {{9, 9, 9}});
  EXPECT_EQ(kUpright, model.gravity_earth);
  EXPECT_EQ(8.0, model.total_mass);
}

TEST_F(ModelTest, HandlePassesArgumentsThrough) {
  const std::array<double, 7> q{{1, 2, 3, 4, 5, 6, 7}};
  const std::array<double, 16> F_T_EE{{8}};
  const std::array<double, 16> EE_T_K{{9}};
  handle.getPose(franka::Frame::kStiffness, q, F_T_EE, EE_T_K);
  EXPECT_EQ(q, model.q);
  EXPECT_EQ(F_T_EE, model.F_T_EE);
  EXPECT_EQ(EE_T_K, model.EE_T_K);
  EXPECT_EQ(2.0, handle.getBodyJacobian(franka::Frame::kJoint2, q, F_T_EE, EE_T_K)[0]);
  EXPECT_EQ(3.0, handle.getZeroJacobian(franka::Frame::kJoint2, q, F_T_EE, EE_T_K)[0]);
  handle.getMass(q, {{10}}, 11.0, {{12}});
  EXPECT_EQ(10, model.inertia[0]);
  EXPECT_EQ(11.0, model.total_mass);
  handle.getCoriolis(q, {{13}}, {{14}}, 15.0, {{16}});
  EXPECT_EQ(13, model.dq[0]);
  EXPECT_EQ(14, model.inertia[0]);
  EXPECT_EQ(16, model.com[0]);
}

TEST_F(ModelTest, InterfaceClaimsNothing) {
  FrankaModelInterface models;
  models.registerHandle(handle);
  EXPECT_EQ("panda_model", models.getHandle("panda_model").getName());
  EXPECT_TRUE(models.getClaims().empty());
}

}  // namespace
}  // namespace franka_hw
