// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/plant.h>
#include <mujoco/mujoco.h>

#include <array>
#include <string>

#include "physics/joints/hold_limits.h"
#include "physics/joints/joint_dynamics.h"
#include "physics/stepping/step_preparation.h"

namespace franka_sim::physics {

/// Indices of a joint with one degree of freedom in the present model.
struct JointSlot {
  int qpos{-1}, dof{-1};
  int brake{-1};  ///< equality, -1: it has none
};

/// The model and state that plants use; replaced when the model is recompiled.
struct PlantView {
  mjModel* model{nullptr};
  mjData* data{nullptr};
  MotorSide* motor_side{nullptr};
  HoldLimits* hold_limits{nullptr};
  /// Must have finished before a hold is written, which a preparation reads; null: there is none.
  PreparationThread* preparation_thread{nullptr};
};

/// The seven joints of an arm in MuJoCo's arrays.
class MujocoArm final : public ArmPlant {
 public:
  /// @param torque_offset of the joints' torque sensors [Nm]
  MujocoArm(const PlantView* view, std::array<std::string, 7> joints,
            const std::array<double, 7>& torque_offset);

  ArmMeasurement measure() const noexcept override;
  void applyTorques(const std::array<double, 7>& tau) noexcept override;
  void setBrakes(bool closed) noexcept override;

  const std::array<std::string, 7>& joints() const noexcept { return joints_; }
  using Slots = std::array<JointSlot, 7>;
  /// Call after the model was recompiled.
  void bind(const Slots& slots) noexcept { slots_ = slots; }
  /// Restores the brakes in a recompiled model.
  void restoreBrakes() noexcept;
  /// Call after a joint was teleported: closed brakes hold it there.
  void jointWasMoved(const std::string& joint) noexcept;
  /// Opens brakes, zero torque.
  void reset() noexcept;

  /// What a snapshot keeps of it beside the model and the data.
  struct State {
    bool brakes_closed{false};
    std::array<double, 7> brake_positions{};
  };
  const State& state() const noexcept { return state_; }
  /// Call after the model's equalities were restored.
  void restore(const State& state) noexcept { state_ = state; }

 private:
  void writeBrake(std::size_t joint) noexcept;

  const PlantView* view_;
  std::array<std::string, 7> joints_;
  std::array<double, 7> torque_offset_;
  std::array<JointSlot, 7> slots_{};
  State state_;
};

/// The two fingers of a hand in MuJoCo's arrays.
class MujocoHand final : public HandPlant {
 public:
  MujocoHand(const PlantView* view, std::array<std::string, 2> joints);

  HandMeasurement measure() const noexcept override;
  void applyForces(const std::array<double, 2>& force) noexcept override;

  const std::array<std::string, 2>& joints() const noexcept { return joints_; }
  using Slots = std::array<JointSlot, 2>;
  void bind(const Slots& slots) noexcept { slots_ = slots; }

 private:
  const PlantView* view_;
  std::array<std::string, 2> joints_;
  std::array<JointSlot, 2> slots_{};
};

/// A joint of another device in MuJoCo's arrays. Positions are held in the same way as by brakes.
class MujocoDrive final : public JointDrive {
 public:
  MujocoDrive(const PlantView* view, std::string joint);

  JointMeasurement measure() const noexcept override;
  void applyEffort(double effort) noexcept override;
  using JointDrive::follow;
  bool follow(double position, const DriveLimits& limits) noexcept override;

  const std::array<std::string, 1>& joints() const noexcept { return joint_; }
  using Slots = std::array<JointSlot, 1>;
  /// Call after the model was recompiled; follow() stays in effect.
  void bind(const Slots& slots) noexcept;
  /// Call after the joint was teleported: the followed position is there.
  void jointWasMoved(const std::string& joint) noexcept;
  /// Zero effort, nothing followed.
  void reset() noexcept;
  /// Call before each physics step of a tick, counted from 1: the target moves in even steps, too.
  void prepare(int substep, int substeps) noexcept;

  /// What a snapshot keeps of it beside the model and the data.
  struct State {
    bool follows{false};
    double last_target{0},
        target{0};       ///< followed position at the last tick's end, and at this one's
    DriveLimits limits;  ///< while it follows
  };
  const State& state() const noexcept { return state_; }
  /// Call after the model's equalities were restored.
  void restore(const State& state) noexcept { state_ = state; }

 private:
  void writeTarget() noexcept;

  const PlantView* view_;
  std::array<std::string, 1> joint_;
  JointSlot slot_{};
  State state_;
};

}  // namespace franka_sim::physics
