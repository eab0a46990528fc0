// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/stepping/step_preparation.h"

#include <sched.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "physics/contacts/contacts.h"
#include "physics/mjcf/rotations.h"

namespace franka_sim::physics {

void EqualitySolver::fit(const mjModel& model) {
  jacobian_rows_.assign(kMaxRows * model.nv, 0.0);
  solved_rows_.assign(kMaxRows * model.nv, 0.0);
}

bool EqualitySolver::handles(const mjData& data) const noexcept {
  return data.nefc > 0 && data.nefc <= kMaxRows && data.nefc == data.ne;
}

// The rows, and the matrix that is to be factorized.
void EqualitySolver::multiply(const mjModel& model, mjData* data) {
  const int rows = data->nefc;
  Row unit{};
  for (int i = 0; i < rows; ++i) {
    unit.fill(0.0);
    unit[i] = 1.0;
    double* jacobian = &jacobian_rows_[i * model.nv];
    mj_mulJacTVec(&model, data, jacobian, unit.data());
    mju_copy(&solved_rows_[i * model.nv], jacobian, model.nv);
  }
  mj_solveM(&model, data, solved_rows_.data(), solved_rows_.data(), rows);
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j <= i; ++j) {
      factor_[i][j] = mju_dot(&jacobian_rows_[i * model.nv], &solved_rows_[j * model.nv], model.nv);
    }
    factor_[i][i] += data->efc_R[i];
  }
}

bool EqualitySolver::factorize(const mjData& data) noexcept {
  for (int i = 0; i < data.nefc; ++i) {
    for (int j = 0; j <= i; ++j) {
      double value = factor_[i][j];
      for (int k = 0; k < j; ++k) {
        value -= factor_[i][k] * factor_[j][k];
      }
      if (i != j) {
        factor_[i][j] = value / factor_[j][j];
      } else if (value > 0.0) {
        factor_[i][i] = std::sqrt(value);
      } else {
        return false;
      }
    }
  }
  return true;
}

void EqualitySolver::solve(const mjModel& model, mjData* data) {
  if (!handles(*data)) {
    solveConstraints(model, data);
    return;
  }
  multiply(model, data);
  if (!factorize(*data)) {  // of numbers that are not finite
    mj_fwdConstraint(&model, data);
    return;
  }
  const int rows = data->nefc;
  double* force = data->efc_force;
  for (int i = 0; i < rows; ++i) {
    force[i] =
        data->efc_aref[i] - mju_dot(&jacobian_rows_[i * model.nv], data->qacc_smooth, model.nv);
    for (int k = 0; k < i; ++k) {
      force[i] -= factor_[i][k] * force[k];
    }
    force[i] /= factor_[i][i];
  }
  for (int i = rows - 1; i >= 0; --i) {
    for (int k = i + 1; k < rows; ++k) {
      force[i] -= factor_[k][i] * force[k];
    }
    force[i] /= factor_[i][i];
  }
  mju_copy(data->qacc, data->qacc_smooth, model.nv);
  mju_zero(data->qfrc_constraint, model.nv);
  for (int i = 0; i < rows; ++i) {
    mju_addToScl(data->qacc, &solved_rows_[i * model.nv], force[i], model.nv);
    mju_addToScl(data->qfrc_constraint, &jacobian_rows_[i * model.nv], force[i], model.nv);
    data->efc_state[i] = mjCNSTRSTATE_QUADRATIC;
  }
  mju_copy(data->qacc_warmstart, data->qacc, model.nv);
  data->solver_iter = 0;
}

namespace {

/// Time between two checks for a request while it does not pay to wait without sleep: at first
/// after a short interruption of the stepping thread, and at last. Chosen here: 50 wake-ups per
/// second take 0.3 % of a slow processor.
constexpr std::chrono::milliseconds kMinSleep{1};
constexpr std::chrono::milliseconds kMaxSleep{20};

/// Checks of a running preparation before the stepping thread yields its processor, which the
/// preparation may need. Chosen here: they take longer than a preparation for a few arms.
constexpr int kChecks = 2000;

}  // namespace

PreparationThread::PreparationThread(std::function<void()> prepare)
    : prepare_(std::move(prepare)), thread_([this] { run(); }) {}

PreparationThread::~PreparationThread() {
  ends_ = true;
  thread_.join();
}

void PreparationThread::run() {
  using Clock = franka_core::SpinRule::Clock;
  while (!ends_.load(std::memory_order_relaxed)) {
    if (spin_rule_.spin([this] { return takeRequest(); })) {
      prepare_();
      state_.store(State::kIdle, std::memory_order_release);
      continue;
    }
    const unsigned requests = requests_.load(std::memory_order_relaxed);
    Clock::duration sleep =
        std::clamp<Clock::duration>(spin_rule_.pauseLeft(Clock::now()), kMinSleep, kMaxSleep);
    // While nobody steps there is nothing to wait for, and nothing that SpinRule could learn.
    do {
      std::this_thread::sleep_for(sleep);
      sleep = std::min<Clock::duration>(2 * sleep, kMaxSleep);
    } while (requests == requests_.load(std::memory_order_relaxed) &&
             !ends_.load(std::memory_order_relaxed));
  }
}

bool PreparationThread::takeRequest() noexcept {
  State expected = State::kRequested;
  return state_.load(std::memory_order_relaxed) == expected &&
         state_.compare_exchange_strong(expected, State::kRunning, std::memory_order_acquire,
                                        std::memory_order_relaxed);
}

void PreparationThread::cancelOrWait() noexcept {
  State expected = State::kRequested;
  if (state_.compare_exchange_strong(expected, State::kIdle, std::memory_order_acquire)) {
    return;
  }
  for (int check = 0; state_.load(std::memory_order_acquire) != State::kIdle; ++check) {
    if (check >= kChecks) {
      sched_yield();
    }
  }
}

namespace {

template <typename T>
void keep(std::vector<T>& values, const T* from) noexcept {
  std::copy_n(from, values.size(), values.begin());
}

// Compares numbers, not bits: zeros of either sign have the same effect.
template <typename T>
bool same(const std::vector<T>& values, const T* others) noexcept {
  return std::equal(values.begin(), values.end(), others);
}

std::optional<StepFault> findFault(const mjtNum* values, int count,
                                   StepFault::Where where) noexcept {
  for (int i = 0; i < count; ++i) {
    if (!(std::abs(values[i]) <= mjMAXVAL)) {
      return StepFault{where, i, values[i]};
    }
  }
  return std::nullopt;
}

std::optional<StepFault> findFault(const mjModel& model, const mjData& data) noexcept {
  const auto position = findFault(data.qpos, model.nq, StepFault::Where::kPosition);
  return position ? position : findFault(data.qvel, model.nv, StepFault::Where::kVelocity);
}

}  // namespace

// Like mj_step2, but without the reset of a world with wrong accelerations. Merged models use the
// Euler integrator.
std::optional<StepFault> StepPreparation::finishStep(const mjModel& model, mjData* data,
                                                     HoldLimits& hold_limits) {
  mj_fwdActuation(&model, data);
  mj_fwdAcceleration(&model, data);
  hold_limits.limitReturn(model, data);
  solver_.solve(model, data);
  while (hold_limits.replaceExceeded(model, data)) {
    solver_.solve(model, data);
  }
  mj_sensorAcc(&model, data);
  if (const auto fault = findFault(data->qacc, model.nv, StepFault::Where::kAcceleration)) {
    return fault;
  }
  mj_Euler(&model, data);
  return std::nullopt;
}

void StepPreparation::fit(const mjModel& model) {
  solver_.fit(model);
  ready_ = false;
  qpos_.resize(model.nq);
  qvel_.resize(model.nv);
  eq_data_.resize(mjNEQDATA * model.neq);
  eq_active_.resize(model.neq);
  gravity_.resize(3);
}

bool StepPreparation::isFor(const mjModel& model, const mjData& data) const noexcept {
  return ready_ && same(qpos_, data.qpos) && same(qvel_, data.qvel) &&
         same(eq_data_, model.eq_data) && same(eq_active_, model.eq_active) &&
         same(gravity_, model.opt.gravity) && timestep_ == model.opt.timestep;
}

void StepPreparation::prepare(mjModel* model, mjData* data, CollisionScope& collisions) {
  if (isFor(*model, *data) || findFault(*model, *data)) {
    return;
  }
  keep(qpos_, data->qpos);
  keep(qvel_, data->qvel);
  keep(eq_data_, model->eq_data);
  keep(eq_active_, model->eq_active);
  keep(gravity_, model->opt.gravity);
  timestep_ = model->opt.timestep;
  collisions.firstHalf(model, data);
  // The preparation is not visible until the step.
  copyQuaternions(*model, qpos_.data(), data->qpos);
  ready_ = true;
}

std::optional<StepFault> StepPreparation::step(mjModel* model, mjData* data,
                                               CollisionScope& collisions,
                                               JointFrictions& frictions, HoldLimits& hold_limits) {
  if (isFor(*model, *data)) {
    mj_normalizeQuat(model, data->qpos);
  } else {
    if (const auto fault = findFault(*model, *data)) {
      return fault;
    }
    collisions.firstHalf(model, data);
  }
  ready_ = false;
  frictions.apply(*model, data);
  return finishStep(*model, data, hold_limits);
}

}  // namespace franka_sim::physics
