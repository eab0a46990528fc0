// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/model.h>
#include <franka/robot_state.h>
#include <franka_hw/model_base.h>
#include <hardware_interface/internal/hardware_resource_manager.h>

#include <array>
#include <string>

namespace franka_hw {

/// Kinematics and dynamics of one arm for controllers.
///
/// Functions without q evaluate the model at the state that the hardware last read; the others at
/// their arguments. Layouts, frames and units: ModelBase. Called by the thread that calls the
/// controllers. Real-time safe. The model must be so too, as ModelKDL and franka::Model are.
class FrankaModelHandle {
 public:
  FrankaModelHandle() = delete;

  /// @param name resource name, `<arm_id>_model`
  /// @param model and @param robot_state are referenced and must outlive the handle
  FrankaModelHandle(const std::string& name, franka_hw::ModelBase& model,
                    franka::RobotState& robot_state)
      : name_(name), model_(&model), robot_state_(&robot_state) {}

  /// The resource's name.
  std::string getName() const noexcept { return name_; }

  /// Mass matrix [kg m^2].
  std::array<double, 49> getMass() const { return model_->mass(*robot_state_); }
  std::array<double, 49> getMass(const std::array<double, 7>& q,
                                 const std::array<double, 9>& total_inertia, double total_mass,
                                 const std::array<double, 3>& F_x_Ctotal) const {
    return model_->mass(q, total_inertia, total_mass, F_x_Ctotal);
  }

  /// Coriolis and centrifugal torques [Nm].
  std::array<double, 7> getCoriolis() const { return model_->coriolis(*robot_state_); }
  std::array<double, 7> getCoriolis(const std::array<double, 7>& q, const std::array<double, 7>& dq,
                                    const std::array<double, 9>& total_inertia, double total_mass,
                                    const std::array<double, 3>& F_x_Ctotal) const {
    return model_->coriolis(q, dq, total_inertia, total_mass, F_x_Ctotal);
  }

  /// Gravity torques [Nm]; the default is gravity of an upright robot, without the acceleration
  /// sensor.
  std::array<double, 7> getGravity(const std::array<double, 3>& gravity_earth = {
                                       {0., 0., -9.81}}) const {
    return model_->gravity(*robot_state_, gravity_earth);
  }
  std::array<double, 7> getGravity(const std::array<double, 7>& q, double total_mass,
                                   const std::array<double, 3>& F_x_Ctotal,
                                   const std::array<double, 3>& gravity_earth = {
                                       {0., 0., -9.81}}) const {
    return model_->gravity(q, total_mass, F_x_Ctotal, gravity_earth);
  }

  /// Pose of a frame in O.
  std::array<double, 16> getPose(const franka::Frame& frame) const {
    return model_->pose(frame, *robot_state_);
  }
  std::array<double, 16> getPose(const franka::Frame& frame, const std::array<double, 7>& q,
                                 const std::array<double, 16>& F_T_EE,
                                 const std::array<double, 16>& EE_T_K) const {
    return model_->pose(frame, q, F_T_EE, EE_T_K);
  }

  /// Jacobian of a frame in its own axes.
  std::array<double, 42> getBodyJacobian(const franka::Frame& frame) const {
    return model_->bodyJacobian(frame, *robot_state_);
  }
  std::array<double, 42> getBodyJacobian(const franka::Frame& frame, const std::array<double, 7>& q,
                                         const std::array<double, 16>& F_T_EE,
                                         const std::array<double, 16>& EE_T_K) const {
    return model_->bodyJacobian(frame, q, F_T_EE, EE_T_K);
  }

  /// Jacobian of a frame in O.
  std::array<double, 42> getZeroJacobian(const franka::Frame& frame) const {
    return model_->zeroJacobian(frame, *robot_state_);
  }
  std::array<double, 42> getZeroJacobian(const franka::Frame& frame, const std::array<double, 7>& q,
                                         const std::array<double, 16>& F_T_EE,
                                         const std::array<double, 16>& EE_T_K) const {
    return model_->zeroJacobian(frame, q, F_T_EE, EE_T_K);
  }

 private:
  std::string name_;
  const franka_hw::ModelBase* model_;
  const franka::RobotState* robot_state_;
};

/// Provides FrankaModelHandles by name; any number of controllers may use the model.
class FrankaModelInterface : public hardware_interface::HardwareResourceManager<FrankaModelHandle> {
};

}  // namespace franka_hw
