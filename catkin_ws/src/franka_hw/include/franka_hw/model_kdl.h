// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_hw/model_base.h>

#include <array>
#include <memory>
#include <string>

namespace KDL {
class Chain;
}
namespace urdf {
class Model;
}

namespace franka_hw {

/// The model of a Franka arm, read from a URDF and computed with KDL.
///
/// Layouts, frames and units: ModelBase. O is the root link, F the tip link. Only the links between
/// root and tip have mass here: the mass of the hand is part of the total load in the arguments of
/// each call.
///
/// All solvers and arrays are built in the constructor; the calls throw nothing. Real-time safe.
/// All calls except takeSingularityWarning() share one workspace, so use a separate instance for
/// every thread.
class ModelKDL : public ModelBase {
 public:
  /// @param model the parsed URDF, with `<inertial>` in the arm's seven moving links
  /// @param root base of the arm, `<arm_id>_link0`
  /// @param tip the flange, `<arm_id>_link8`
  /// @param singularity_threshold the smallest singular value of J*J^T below which a warning is
  /// raised; a negative value disables the check
  /// @throws std::invalid_argument if root to tip is not seven revolute joints and a fixed flange,
  /// or if a moving link has no mass
  ModelKDL(const urdf::Model& model, const std::string& root, const std::string& tip,
           double singularity_threshold = -1);
  ~ModelKDL() noexcept override;
  ModelKDL(const ModelKDL&) = delete;
  ModelKDL& operator=(const ModelKDL&) = delete;

  using ModelBase::bodyJacobian;
  using ModelBase::coriolis;
  using ModelBase::gravity;
  using ModelBase::mass;
  using ModelBase::pose;
  using ModelBase::zeroJacobian;

  std::array<double, 16> pose(franka::Frame frame, const std::array<double, 7>& q,
                              const std::array<double, 16>& F_T_EE,
                              const std::array<double, 16>& EE_T_K) const override;
  std::array<double, 42> bodyJacobian(franka::Frame frame, const std::array<double, 7>& q,
                                      const std::array<double, 16>& F_T_EE,
                                      const std::array<double, 16>& EE_T_K) const override;
  std::array<double, 42> zeroJacobian(franka::Frame frame, const std::array<double, 7>& q,
                                      const std::array<double, 16>& F_T_EE,
                                      const std::array<double, 16>& EE_T_K) const override;
  std::array<double, 49> mass(const std::array<double, 7>& q,
                              const std::array<double, 9>& total_inertia, double total_mass,
                              const std::array<double, 3>& F_x_Ctotal) const override;
  std::array<double, 7> coriolis(const std::array<double, 7>& q, const std::array<double, 7>& dq,
                                 const std::array<double, 9>& total_inertia, double total_mass,
                                 const std::array<double, 3>& F_x_Ctotal) const override;
  std::array<double, 7> gravity(const std::array<double, 7>& q, double total_mass,
                                const std::array<double, 3>& F_x_Ctotal,
                                const std::array<double, 3>& gravity_earth) const override;

  /// True once after a Jacobian of the flange, end effector or stiffness frame was near-singular.
  /// The Jacobians are checked at most ten times a second. The caller prints the warning, outside
  /// the loop. Thread-safe.
  bool takeSingularityWarning() noexcept;

  /// Appends a fixed, massless frame to a chain. @param transform 4x4 column-major
  static void augmentFrame(const std::string& name, const std::array<double, 16>& transform,
                           KDL::Chain& chain);
  /// Appends a fixed body to a chain, at the last frame of the chain.
  /// @param center_of_mass in that frame [m] @param mass [kg]
  /// @param inertia about the center of mass, 3x3 column-major [kg m^2]
  static void augmentFrame(const std::string& name, const std::array<double, 3>& center_of_mass,
                           double mass, const std::array<double, 9>& inertia, KDL::Chain& chain);

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace franka_hw
