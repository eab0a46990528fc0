// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/spin_rule.h>
#include <mujoco/mujoco.h>

#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <optional>
#include <thread>
#include <vector>

#include "physics/contacts/robot_clearance.h"
#include "physics/joints/hold_limits.h"
#include "physics/joints/joint_dynamics.h"

namespace franka_sim::physics {

/// Replaces mj_fwdConstraint (decision 61). Constraints that are equalities only, such as the
/// coupling of a hand's fingers and closed brakes, are linear:
///
///     f = -(J M^-1 J^T + R)^-1 (J a_smooth - a_ref),   a = a_smooth + M^-1 J^T f
///
/// which needs one Cholesky factor of their few rows, where MuJoCo's Newton method needs several of
/// all degrees of freedom. All other constraints are left to solveConstraints.
///
/// Called by the stepping thread; allocates only in `fit`.
class EqualitySolver {
 public:
  static constexpr int kMaxRows = 16;  ///< two arms with hands and closed brakes (chosen here)

  /// Call for a new model.
  void fit(const mjModel& model);
  /// Computes constraint forces and accelerations. Real-time safe. @throws EngineError within its
  /// scope
  void solve(const mjModel& model, mjData* data);

 private:
  bool handles(const mjData& data) const noexcept;
  void multiply(const mjModel& model, mjData* data);
  bool factorize(const mjData& data) noexcept;

  using Row = std::array<double, kMaxRows>;

  std::vector<double> jacobian_rows_, solved_rows_;  ///< J^T and M^-1 J^T, row by row
  std::array<Row, kMaxRows> factor_{};               ///< lower triangle
};

/// Prepares the next step on a thread of its own while the stepping thread computes something else,
/// so that a tick takes less time (decision 62).
///
/// Neither thread waits for the other one to wake up. This thread checks for requests without sleep
/// while SpinRule recommends that, and the stepping thread cancels a request that has not begun.
/// One stepping thread at a time calls request() and finish().
class PreparationThread {
 public:
  /// @param prepare must not throw. Not real-time safe.
  explicit PreparationThread(std::function<void()> prepare);
  ~PreparationThread();
  PreparationThread(const PreparationThread&) = delete;
  PreparationThread& operator=(const PreparationThread&) = delete;

  /// Asks for one call of `prepare`. Real-time safe.
  void request() noexcept {
    requests_.store(requests_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    state_.store(State::kRequested, std::memory_order_release);
  }
  /// Returns when nothing is being prepared and nothing is requested any more; what `prepare` wrote
  /// is visible then. Real-time safe.
  void finish() noexcept {
    if (state_.load(std::memory_order_acquire) != State::kIdle) {
      cancelOrWait();
    }
  }

 private:
  enum class State { kIdle, kRequested, kRunning };

  void run();
  bool takeRequest() noexcept;
  void cancelOrWait() noexcept;

  std::function<void()> prepare_;
  std::atomic<State> state_{State::kIdle};
  std::atomic<unsigned> requests_{0};  ///< so far
  std::atomic<bool> ends_{false};
  /// Other threads of this process, which publish and serve, mostly interrupt this one for shorter
  /// times, other programs for longer ones (chosen here).
  static constexpr std::chrono::microseconds kGap{100};

  franka_core::SpinRule spin_rule_{franka_core::WaitMode::kAuto, franka_core::hasTwoProcessors(),
                                   kGap};
  std::thread thread_;
};

/// A number that is not finite, or beyond MuJoCo's range. MuJoCo itself would reset the whole world
/// and continue (2.2 has no option against that), so it is checked before MuJoCo does.
struct StepFault {
  enum class Where {
    kPosition,
    kVelocity,
    kAcceleration,
    kEngine,  ///< an EngineError; no index and no value
  };
  Where where;
  int index{-1};  ///< in qpos or qvel
  double value{0};
};

/// Computes in advance the half of a physics step that depends on positions and velocities alone:
/// while a client works on its answer the simulator is idle.
///
/// Results are the same to the last bit with and without preparation: it is used only if positions,
/// velocities, holds, gravity and the length of the step have not changed since. Called by one
/// thread at a time; while it prepares, others may read positions and velocities of joints with one
/// degree of freedom. Throws nothing but EngineError. Real-time safe.
/// Exception: `fit`.
class StepPreparation {
 public:
  /// Call for a new model, or one whose state was overwritten.
  void fit(const mjModel& model);
  /// Discards the preparation.
  void drop() noexcept { ready_ = false; }
  /// Does not change positions and velocities; contacts become those of the next step.
  void prepare(mjModel* model, mjData* data, CollisionScope& collisions);
  /// One physics step with friction in the joints and limited holds, or the fault that prevents it:
  /// then time, positions and velocities are unchanged.
  std::optional<StepFault> step(mjModel* model, mjData* data, CollisionScope& collisions,
                                JointFrictions& frictions, HoldLimits& hold_limits);

 private:
  bool isFor(const mjModel& model, const mjData& data) const noexcept;
  std::optional<StepFault> finishStep(const mjModel& model, mjData* data, HoldLimits& hold_limits);

  EqualitySolver solver_;
  bool ready_{false};
  // Inputs of the preparation.
  std::vector<double> qpos_, qvel_, eq_data_, gravity_;
  std::vector<unsigned char> eq_active_;
  double timestep_{0};
};

}  // namespace franka_sim::physics
