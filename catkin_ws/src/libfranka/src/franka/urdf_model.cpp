// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/exception.h>
#include <franka_core/arm_model.h>

#include <stdexcept>

#include "franka/model_source.h"

namespace franka {

namespace {

using franka_core::ArmFrame;
using franka_core::ArmModel;
using franka_core::Payload;

ArmFrame armFrame(Frame frame) {
  if (frame < Frame::kJoint1 || frame > Frame::kStiffness) {
    throw std::invalid_argument("libfranka: Invalid frame given.");
  }
  return static_cast<ArmFrame>(frame);
}

/// Results of ArmModel.
class UrdfModel : public Model::Source {
 public:
  explicit UrdfModel(const ArmModel& arm) : arm_(arm) {}

  std::array<double, 16> pose(Frame frame, const std::array<double, 7>& q,
                              const std::array<double, 16>& F_T_EE,
                              const std::array<double, 16>& EE_T_K) const override {
    return arm_.pose(armFrame(frame), q, F_T_EE, EE_T_K);
  }
  std::array<double, 42> bodyJacobian(Frame frame, const std::array<double, 7>& q,
                                      const std::array<double, 16>& F_T_EE,
                                      const std::array<double, 16>& EE_T_K) const override {
    return arm_.bodyJacobian(armFrame(frame), q, F_T_EE, EE_T_K);
  }
  std::array<double, 42> zeroJacobian(Frame frame, const std::array<double, 7>& q,
                                      const std::array<double, 16>& F_T_EE,
                                      const std::array<double, 16>& EE_T_K) const override {
    return arm_.zeroJacobian(armFrame(frame), q, F_T_EE, EE_T_K);
  }
  std::array<double, 49> mass(const std::array<double, 7>& q, const std::array<double, 9>& I_total,
                              double m_total,
                              const std::array<double, 3>& F_x_Ctotal) const noexcept override {
    return arm_.mass(q, Payload{m_total, F_x_Ctotal, I_total});
  }
  std::array<double, 7> coriolis(const std::array<double, 7>& q, const std::array<double, 7>& dq,
                                 const std::array<double, 9>& I_total, double m_total,
                                 const std::array<double, 3>& F_x_Ctotal) const noexcept override {
    return arm_.coriolis(q, dq, Payload{m_total, F_x_Ctotal, I_total});
  }
  std::array<double, 7> gravity(
      const std::array<double, 7>& q, double m_total, const std::array<double, 3>& F_x_Ctotal,
      const std::array<double, 3>& gravity_earth) const noexcept override {
    return arm_.gravity(q, Payload{m_total, F_x_Ctotal, {}}, gravity_earth);
  }

 private:
  ArmModel arm_;
};

}  // namespace

std::unique_ptr<Model::Source> modelFromUrdf(const std::string& urdf, const std::string& arm_id) {
  try {
    return std::make_unique<UrdfModel>(ArmModel::fromUrdf(urdf, arm_id));
  } catch (const std::invalid_argument& error) {
    throw ModelException(std::string("libfranka: The model cannot be used. ") + error.what());
  }
}

}  // namespace franka
