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
/// Layouts, frames and units are those of ModelBase; O is the root link, F the tip link. Only the
/// links between root and tip have mass here: the hand enters through the total load each call is
/// given.
///
/// All solvers and arrays are built once, in the constructor; the calls neither allocate nor lock
/// nor throw and may run in the 1 kHz loop. They share one workspace, so an instance serves one
/// thread at a time (takeSingularityWarning() excepted); give every thread its own instance.
class ModelKDL : public ModelBase {
 public:
  /// @param model the parsed URDF, with <inertial> in the arm's seven moving links
  /// @param root base of the arm, `<arm_id>_link0`
  /// @param tip the flange, `<arm_id>_link8`
  /// @param singularity_threshold the smallest singular value of J*J^T below which a warning is
  /// raised;
  ///        negative switches the check off
  /// @throws std::invalid_argument with a sentence when root to tip is not seven revolute joints
  /// and a
  ///         fixed flange, or a moving link has no mass
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

  /// True once after a Jacobian of the flange, end effector or stiffness frame was found
  /// near-singular; the caller prints the warning, outside the loop. The Jacobians are looked at
  /// ten times a second at most. May be called from any thread.
  bool takeSingularityWarning() noexcept;

  /// Appends a fixed, massless frame to a chain. @param transform 4x4 column-major
  static void augmentFrame(const std::string& name, const std::array<double, 16>& transform,
                           KDL::Chain& chain);
  /// Appends a fixed body to a chain, at the frame the chain ended in.
  /// @param center_of_mass in that frame [m] @param mass [kg]
  /// @param inertia about the centre of mass, 3x3 column-major [kg m^2]
  static void augmentFrame(const std::string& name, const std::array<double, 3>& center_of_mass,
                           double mass, const std::array<double, 9>& inertia, KDL::Chain& chain);

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace franka_hw
