// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// MuJoCo's model of the merged robot against ArmModel, which does not use MuJoCo.
#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "physics/engine/model_compiler.h"
#include "physics/engine/model_data.h"
#include "test_support.h"

namespace franka_sim::test {
namespace {

constexpr int kStates = 1000;

/// The merged model with its fingers closed and the arm's degrees of freedom found by name.
class Reference {
 public:
  explicit Reference(const std::string& kind) : kind_(kind) {
    World world;
    RobotDescription description = robot(kind);
    description.rotor_inertia.clear();
    description.rotor_inertia[kind + "_finger_joint1"] = 0;
    description.rotor_inertia[kind + "_finger_joint2"] = 0;
    world.addRobot(description);
    model = physics::compile(world.mjcf(false), "the merged model");
    data = physics::makeData(*model);
    for (int i = 0; i < 7; ++i) {
      const std::string name = kind + "_joint" + std::to_string(i + 1);
      const int joint = mj_name2id(model.get(), mjOBJ_JOINT, name.c_str());
      qpos[i] = model->jnt_qposadr[joint];
      dof[i] = model->jnt_dofadr[joint];
    }
  }

  void set(const std::array<double, 7>& q, const std::array<double, 7>& dq) {
    for (int i = 0; i < 7; ++i) {
      data->qpos[qpos[i]] = q[i];
      data->qvel[dof[i]] = dq[i];
    }
    mj_forward(model.get(), data.get());
  }

  int body(const std::string& link) const {
    return mj_name2id(model.get(), mjOBJ_BODY, (kind_ + "_" + link).c_str());
  }

  physics::ModelPtr model;
  physics::DataPtr data;
  std::array<int, 7> qpos{}, dof{};

 private:
  std::string kind_;
};

class ModelAgreement : public ::testing::TestWithParam<const char*> {
 protected:
  ModelAgreement()
      : reference_(GetParam()),
        model_(franka_core::ArmModel::fromUrdf(urdfOf(GetParam()), GetParam())),
        payload_(handPayload(GetParam())) {}

  void draw() {
    std::uniform_real_distribution<double> angle(-2.8, 2.8), speed(-2.5, 2.5);
    for (int i = 0; i < 7; ++i) {
      q_[i] = angle(random_);
      dq_[i] = speed(random_);
    }
    reference_.set(q_, dq_);
  }

  Reference reference_;
  franka_core::ArmModel model_;
  franka_core::Payload payload_;
  std::mt19937 random_{7};
  std::array<double, 7> q_{}, dq_{};
};

TEST_P(ModelAgreement, MassMatrixAndBiasOnRandomStates) {
  std::vector<double> full(reference_.model->nv * reference_.model->nv);
  double worst = 0, worst_bias = 0;
  for (int k = 0; k < kStates; ++k) {
    draw();
    mj_fullM(reference_.model.get(), full.data(), reference_.data->qM);
    const auto mass = model_.mass(q_, payload_);
    const auto gravity = model_.gravity(q_, payload_);
    const auto coriolis = model_.coriolis(q_, dq_, payload_);
    for (int row = 0; row < 7; ++row) {
      for (int column = 0; column < 7; ++column) {
        const double theirs =
            full[reference_.dof[row] * reference_.model->nv + reference_.dof[column]];
        worst = std::max(worst, std::abs(theirs - mass[row + 7 * column]));
      }
      const double bias = reference_.data->qfrc_bias[reference_.dof[row]];
      worst_bias = std::max(worst_bias, std::abs(bias - gravity[row] - coriolis[row]));
    }
  }
  EXPECT_LT(worst, 1e-12);
  EXPECT_LT(worst_bias, 1e-11);
}

TEST_P(ModelAgreement, JacobianAndPoseOfTheFlangeOnRandomStates) {
  const int nv = reference_.model->nv;
  std::vector<double> linear(3 * nv), angular(3 * nv);
  double worst = 0;
  for (int k = 0; k < kStates; ++k) {
    draw();
    const auto pose = model_.pose(franka_core::ArmFrame::kFlange, q_);
    const auto jacobian = model_.zeroJacobian(franka_core::ArmFrame::kFlange, q_);
    mj_jac(reference_.model.get(), reference_.data.get(), linear.data(), angular.data(), &pose[12],
           reference_.body("link7"));
    const double* link7 = reference_.data->xpos + 3 * reference_.body("link7");
    const double* axes = reference_.data->xmat + 9 * reference_.body("link7");
    for (int row = 0; row < 3; ++row) {
      worst = std::max(worst, std::abs(link7[row] + 0.107 * axes[3 * row + 2] - pose[12 + row]));
      for (int i = 0; i < 7; ++i) {
        const int dof = reference_.dof[i];
        worst = std::max(worst, std::abs(linear[row * nv + dof] - jacobian[row + 6 * i]));
        worst = std::max(worst, std::abs(angular[row * nv + dof] - jacobian[row + 3 + 6 * i]));
      }
    }
  }
  EXPECT_LT(worst, 1e-13);
}

INSTANTIATE_TEST_SUITE_P(Robots, ModelAgreement, ::testing::Values("panda", "fr3"));

}  // namespace
}  // namespace franka_sim::test
