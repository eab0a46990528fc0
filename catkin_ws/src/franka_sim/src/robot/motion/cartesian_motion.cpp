// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/motion/cartesian_motion.h"

#include <franka_core/arm_model.h>
#include <franka_core/finite.h>
#include <franka_core/rotations.h>
#include <franka_core/transform.h>
#include <franka_sim/robot/plant.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "robot/motion/motion_checks.h"

namespace franka_sim {

namespace {

using franka_core::ArmFrame;
using franka_core::ArmModel;
using Joints = std::array<double, 7>;
using Jacobian = Eigen::Matrix<double, 6, 7>;
using Matrix7 = Eigen::Matrix<double, 7, 7>;
using Vector7 = Eigen::Matrix<double, 7, 1>;

// Chosen from measured convergence (decision 12).
constexpr double kSingularStart = 0.01;
constexpr double kNearlySingular = 0.02;
constexpr double kMaxDamping = 0.02;
constexpr int kMaxIterations = 8;
constexpr double kTolerance = 1e-13;  // larger residuals become jerk

Matrix7 withElbowRow(const std::array<double, 42>& jacobian) noexcept {
  Matrix7 matrix = Matrix7::Zero();
  matrix.topRows<6>() = Eigen::Map<const Jacobian>(jacobian.data());
  matrix(6, 2) = 1.0;
  return matrix;
}

// A symmetric matrix minus s^2 I is positive definite if and only if its eigenvalues exceed s^2;
// this test is cheaper than the eigenvalues.
bool hasSingularValueBelow(const Matrix7& gram, double bound) noexcept {
  Matrix7 shifted = gram;
  shifted.diagonal().array() -= bound * bound;
  return shifted.llt().info() != Eigen::Success;
}

double smallestSingularValue(const Matrix7& gram) noexcept {
  const Eigen::SelfAdjointEigenSolver<Matrix7> solver(gram, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(solver.eigenvalues()(0), 0.0));
}

Vector7 residual(const Transform& desired, double q3_desired, const Transform& reached,
                 double q3) noexcept {
  const Eigen::Map<const Eigen::Matrix4d> to(desired.data());
  const Eigen::Map<const Eigen::Matrix4d> from(reached.data());
  const Eigen::Matrix3d turn = to.topLeftCorner<3, 3>() * from.topLeftCorner<3, 3>().transpose();
  Vector7 error;
  error.head<3>() = to.topRightCorner<3, 1>() - from.topRightCorner<3, 1>();
  error.segment<3>(3) << turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1);
  error.segment<3>(3) *= 0.5;
  error(6) = q3_desired - q3;
  return error;
}

void add(const Vector7& step, Joints& q) noexcept { Eigen::Map<Vector7>(q.data()) += step; }

void reach(const Transform& F_T_EE, const ArmModel& model,
           InverseKinematics::Solution& solution) noexcept {
  solution.O_T_EE = model.pose(ArmFrame::kEndEffector, solution.q, F_T_EE);
  solution.jacobian = model.zeroJacobian(ArmFrame::kEndEffector, solution.q, F_T_EE);
}

// One step of damped least squares: J^T (J J^T + damping I)^-1 error. The damping grows from zero
// at the bound to kMaxDamping^2 at a singularity (Chiaverini, 1997).
Vector7 dampedStep(const Matrix7& matrix, const Matrix7& gram, const Vector7& error) noexcept {
  const double share = smallestSingularValue(gram) / kNearlySingular;
  const double damping = (1.0 - share * share) * kMaxDamping * kMaxDamping;
  Matrix7 damped = gram;
  damped.diagonal().array() += damping;
  return matrix.transpose() * damped.llt().solve(error);
}

}  // namespace

bool InverseKinematics::isSingular(const Joints& q, const Transform& F_T_EE,
                                   const ArmModel& model) noexcept {
  const Matrix7 matrix = withElbowRow(model.zeroJacobian(ArmFrame::kEndEffector, q, F_T_EE));
  return hasSingularValueBelow(matrix.lazyProduct(matrix.transpose()), kSingularStart);
}

InverseKinematics::Solution InverseKinematics::solve(const Joints& q_last, const Transform& O_T_EE,
                                                     double q3, const Transform& F_T_EE,
                                                     const ArmModel& model) noexcept {
  Solution solution;
  solution.q = q_last;
  reach(F_T_EE, model, solution);
  Vector7 error = residual(O_T_EE, q3, solution.O_T_EE, solution.q[2]);
  Matrix7 matrix = withElbowRow(solution.jacobian);
  const Matrix7 gram = matrix.lazyProduct(matrix.transpose());
  if (hasSingularValueBelow(gram, kNearlySingular)) {
    solution.near_singularity = true;
    add(dampedStep(matrix, gram, error), solution.q);
    reach(F_T_EE, model, solution);
    return solution;
  }
  for (int i = 0; i < kMaxIterations && error.cwiseAbs().maxCoeff() >= kTolerance; i++) {
    add(matrix.partialPivLu().solve(error), solution.q);
    reach(F_T_EE, model, solution);
    error = residual(O_T_EE, q3, solution.O_T_EE, solution.q[2]);
    matrix = withElbowRow(solution.jacobian);
  }
  return solution;
}

using franka_core::RobotError;

namespace {

constexpr double kPoseTolerance = 1e-3;   // [m]; [rad] likewise (decision 13)
constexpr double kElbowTolerance = 1e-3;  // [rad] (decision 13)

bool isNear(const CartesianSample& step) noexcept {
  const Eigen::Map<const Eigen::Matrix<double, 6, 1>> twist(step.twist.data());
  return twist.head<3>().norm() * kTick <= kPoseTolerance &&
         twist.tail<3>().norm() * kTick <= kPoseTolerance;
}

Transform tidied(const Transform& pose) noexcept {
  Transform tidy = franka_core::kIdentityTransform;
  const Eigen::Map<const Eigen::Matrix4d> from(pose.data());
  Eigen::Map<Eigen::Matrix4d> to(tidy.data());
  to.topLeftCorner<3, 3>() = franka_core::orthonormalized(from.topLeftCorner<3, 3>());
  to.topRightCorner<3, 1>() = from.topRightCorner<3, 1>();
  return tidy;
}

CartesianSample atRest(const Transform& pose, double q3) noexcept {
  CartesianSample sample;
  sample.pose = pose;
  sample.elbow.q3 = q3;
  return sample;
}

}  // namespace

void CartesianMotion::start(const Transform& pose, const std::array<double, 2>& elbow) noexcept {
  last_ = atRest(pose, elbow[0]);
  started_ = false;
}

ErrorSet CartesianMotion::checkElbow(const ElbowCommand& command, double sign) const noexcept {
  ErrorSet errors;
  if (!command.valid) {
    return errors;
  }
  if (!std::isfinite(command.elbow[0])) {
    return RobotError::kCartesianMotionGeneratorElbowLimitViolation;
  }
  errors.addIf(command.elbow[1] != sign,
               RobotError::kCartesianMotionGeneratorElbowSignInconsistent);
  errors.addIf(!started_ && std::abs(command.elbow[0] - last_.elbow.q3) > kElbowTolerance,
               RobotError::kCartesianMotionGeneratorStartElbowInvalid);
  return errors;
}

ErrorSet CartesianMotion::takePose(const Transform& pose, const ElbowCommand& elbow, double sign,
                                   const MotionLimits& limits) noexcept {
  has_refused_ = false;
  if (!franka_core::isRigidTransform(pose)) {
    return RobotError::kCartesianPositionMotionGeneratorInvalidFrameFlag;
  }
  const double q3 = elbow.valid ? elbow.elbow[0] : last_.elbow.q3;
  CartesianSample step = stepToPose(last_, tidied(pose), q3);
  ErrorSet errors = checkElbow(elbow, sign);
  errors.addIf(!started_ && !isNear(step),
               RobotError::kCartesianPositionMotionGeneratorStartPoseInvalid);
  if (errors) {
    return errors;
  }
  if (!started_) {
    step = atRest(step.pose, q3);
  }
  errors = checkStep(step, last_, limits);
  // Against the history as read by the client, the exact command counts, as in the client.
  if (errors && limits.echoes_floats && started_) {
    const CartesianSample seen = asEchoed(last_);
    errors = checkStep(stepToPose(seen, pose, q3), seen, limits) ? errors : ErrorSet{};
  }
  return take(step, errors);
}

ErrorSet CartesianMotion::takeTwist(const std::array<double, 6>& twist, const ElbowCommand& elbow,
                                    double sign, const MotionLimits& limits) noexcept {
  has_refused_ = false;
  if (!franka_core::allFinite(twist)) {
    return RobotError::kCartesianMotionGeneratorVelocityLimitsViolation;
  }
  if (const ErrorSet errors = checkElbow(elbow, sign)) {
    return errors;
  }
  const double q3 = elbow.valid ? elbow.elbow[0] : last_.elbow.q3;
  if (!started_) {
    last_.elbow.q3 = q3;  // within the tolerance; the elbow's history starts here
  }
  const CartesianSample step = stepByTwist(last_, twist, q3);
  ErrorSet errors = checkStep(step, last_, limits);
  if (errors && limits.echoes_floats) {
    const CartesianSample seen = asEchoed(last_);
    errors = checkStep(stepByTwist(seen, twist, q3), seen, limits) ? errors : ErrorSet{};
  }
  return take(step, errors);
}

ErrorSet CartesianMotion::extrapolate(const MotionLimits& limits) noexcept {
  has_refused_ = false;
  if (!started_) {
    return {};
  }
  const CartesianSample step = stepByAcceleration(last_);
  return take(step, checkStep(step, last_, limits));
}

// The end of each of these steps.
ErrorSet CartesianMotion::take(const CartesianSample& step, const ErrorSet& errors) noexcept {
  if (errors) {
    refused_ = step;
    has_refused_ = true;
  } else {
    last_ = step;
    started_ = true;
  }
  return errors;
}

ErrorSet CartesianMotion::checkStop(const MotionLimits& limits) const noexcept {
  return checkStep(stepByTwist(last_, {}, last_.elbow.q3), last_, limits);
}

}  // namespace franka_sim
