// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/supervisor/desired_state.h"

#include "robot/transforms.h"

namespace franka_sim {

using franka_core::ArmFrame;

void DesiredState::set(const std::array<double, 7>& q_d, const std::array<double, 7>& dq_d,
                       const std::array<double, 7>& ddq_d) noexcept {
  state_->q_d = q_d;
  state_->dq_d = dq_d;
  state_->ddq_d = ddq_d;
  stale_ = true;
}

void DesiredState::set(const DesiredMotion& desired) noexcept {
  state_->q_d = desired.q_d;
  state_->dq_d = desired.dq_d;
  state_->ddq_d = desired.ddq_d;
  state_->O_T_EE_d = desired.O_T_EE_d;
  state_->O_T_EE_c = desired.O_T_EE_c;
  state_->O_dP_EE_d = desired.O_dP_EE_d;
  state_->O_dP_EE_c = desired.O_dP_EE_c;
  state_->O_ddP_EE_c = desired.O_ddP_EE_c;
  state_->elbow_d = desired.elbow_d;
  state_->elbow_c = desired.elbow_c;
  state_->delbow_c = desired.delbow_c;
  state_->ddelbow_c = desired.ddelbow_c;
  stale_ = false;
}

// For states in which no generator sets these fields: at rest or braking.
void DesiredState::update(const franka_core::ArmModel& model) noexcept {
  if (!stale_) {
    return;
  }
  stale_ = false;
  state_->O_T_EE_d =
      model.pose(ArmFrame::kEndEffector, state_->q_d, state_->F_T_EE, state_->EE_T_K);
  state_->O_T_EE_c = state_->O_T_EE_d;
  state_->O_dP_EE_d.fill(0.0);
  if (state_->dq_d != std::array<double, 7>{}) {
    state_->O_dP_EE_d = twist(
        model.zeroJacobian(ArmFrame::kEndEffector, state_->q_d, state_->F_T_EE, state_->EE_T_K),
        state_->dq_d);
  }
  state_->O_dP_EE_c = state_->O_dP_EE_d;
  state_->O_ddP_EE_c.fill(0.0);
  state_->elbow_d = elbowOf(state_->q_d);
  state_->elbow_c = state_->elbow_d;
  state_->delbow_c = {{state_->dq_d[2], 0.0}};
  state_->ddelbow_c = {{state_->ddq_d[2], 0.0}};
}

}  // namespace franka_sim
