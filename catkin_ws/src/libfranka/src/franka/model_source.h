// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/model.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace franka {

/// Computes the results of a Model. Layouts as in Model. Real-time safe. Thread-safe.
class Model::Source {
 public:
  virtual ~Source() = default;

  virtual std::array<double, 16> pose(Frame frame, const std::array<double, 7>& q,
                                      const std::array<double, 16>& F_T_EE,
                                      const std::array<double, 16>& EE_T_K) const = 0;
  virtual std::array<double, 42> bodyJacobian(Frame frame, const std::array<double, 7>& q,
                                              const std::array<double, 16>& F_T_EE,
                                              const std::array<double, 16>& EE_T_K) const = 0;
  virtual std::array<double, 42> zeroJacobian(Frame frame, const std::array<double, 7>& q,
                                              const std::array<double, 16>& F_T_EE,
                                              const std::array<double, 16>& EE_T_K) const = 0;
  virtual std::array<double, 49> mass(const std::array<double, 7>& q,
                                      const std::array<double, 9>& I_total, double m_total,
                                      const std::array<double, 3>& F_x_Ctotal) const noexcept = 0;
  virtual std::array<double, 7> coriolis(
      const std::array<double, 7>& q, const std::array<double, 7>& dq,
      const std::array<double, 9>& I_total, double m_total,
      const std::array<double, 3>& F_x_Ctotal) const noexcept = 0;
  virtual std::array<double, 7> gravity(
      const std::array<double, 7>& q, double m_total, const std::array<double, 3>& F_x_Ctotal,
      const std::array<double, 3>& gravity_earth) const noexcept = 0;
};

/// The arm of a URDF, computed by ArmModel. @throws ModelException
std::unique_ptr<Model::Source> modelFromUrdf(const std::string& urdf, const std::string& arm_id);

/// The shared object from robots with protocol 3 to 9. @throws ModelException if it cannot be
/// loaded or lacks one of its functions
std::unique_ptr<Model::Source> modelFromLibrary(const std::vector<std::uint8_t>& shared_object);

}  // namespace franka
