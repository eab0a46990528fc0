// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/exception.h>
#include <franka/model.h>

#include <fstream>
#include <sstream>
#include <utility>

#include "franka/model_source.h"
#include "franka/robot_impl.h"

namespace franka {

Frame operator++(Frame& frame, int /* postfix */) noexcept {
  const Frame before = frame;
  frame = static_cast<Frame>(static_cast<int>(frame) + 1);
  return before;
}

namespace {

namespace fci = franka_core::fci;

/// The shared object must match this machine.
constexpr fci::Architecture architecture() {
#if defined(__aarch64__)
  return fci::Architecture::kArm64;
#elif defined(__arm__)
  return fci::Architecture::kArm;
#elif defined(__i386__)
  return fci::Architecture::kX86;
#else
  return fci::Architecture::kX64;
#endif
}

}  // namespace

Model Robot::loadModel() {
  if (isMobileRobot()) {
    throw ModelException(
        "libfranka: This robot is a mobile base, not an arm. Please make a franka::MobileModel "
        "from "
        "what getRobotModel returns.");
  }
  if (fci::hasRobotModel(impl_->version())) {
    try {
      return Model(modelFromUrdf(getRobotModel(), ""));
    } catch (const Exception&) {
      // Versions 8 and 9 have both; if one is unusable the other remains.
      if (!fci::hasModelLibrary(impl_->version())) {
        throw;
      }
    }
  }
  return Model(modelFromLibrary(
      impl_->download(fci::LoadModelLibraryRequest{architecture(), fci::OperatingSystem::kLinux})));
}

Model Model::fromUrdf(const std::string& urdf, const std::string& arm_id) {
  return Model(modelFromUrdf(urdf, arm_id));
}

Model Model::fromUrdfFile(const std::string& path, const std::string& arm_id) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) {
    throw ModelException("libfranka: The URDF file '" + path + "' cannot be read.");
  }
  return fromUrdf(text.str(), arm_id);
}

Model::Model(const std::string& urdf) : source_(modelFromUrdf(urdf, "")) {}
Model::Model(std::unique_ptr<Source> source) : source_(std::move(source)) {}
Model::Model(Model&& model) noexcept = default;
Model& Model::operator=(Model&& model) noexcept = default;
Model::~Model() noexcept = default;

std::array<double, 16> Model::pose(Frame frame, const RobotState& state) const {
  return pose(frame, state.q, state.F_T_EE, state.EE_T_K);
}
std::array<double, 16> Model::pose(Frame frame, const std::array<double, 7>& q,
                                   const std::array<double, 16>& F_T_EE,
                                   const std::array<double, 16>& EE_T_K) const {
  return source_->pose(frame, q, F_T_EE, EE_T_K);
}

std::array<double, 42> Model::bodyJacobian(Frame frame, const RobotState& state) const {
  return bodyJacobian(frame, state.q, state.F_T_EE, state.EE_T_K);
}
std::array<double, 42> Model::bodyJacobian(Frame frame, const std::array<double, 7>& q,
                                           const std::array<double, 16>& F_T_EE,
                                           const std::array<double, 16>& EE_T_K) const {
  return source_->bodyJacobian(frame, q, F_T_EE, EE_T_K);
}

std::array<double, 42> Model::zeroJacobian(Frame frame, const RobotState& state) const {
  return zeroJacobian(frame, state.q, state.F_T_EE, state.EE_T_K);
}
std::array<double, 42> Model::zeroJacobian(Frame frame, const std::array<double, 7>& q,
                                           const std::array<double, 16>& F_T_EE,
                                           const std::array<double, 16>& EE_T_K) const {
  return source_->zeroJacobian(frame, q, F_T_EE, EE_T_K);
}

std::array<double, 49> Model::mass(const RobotState& state) const noexcept {
  return mass(state.q, state.I_total, state.m_total, state.F_x_Ctotal);
}
std::array<double, 49> Model::mass(const std::array<double, 7>& q,
                                   const std::array<double, 9>& I_total, double m_total,
                                   const std::array<double, 3>& F_x_Ctotal) const noexcept {
  return source_->mass(q, I_total, m_total, F_x_Ctotal);
}

std::array<double, 7> Model::coriolis(const RobotState& state) const noexcept {
  return coriolis(state.q, state.dq, state.I_total, state.m_total, state.F_x_Ctotal);
}
std::array<double, 7> Model::coriolis(const std::array<double, 7>& q,
                                      const std::array<double, 7>& dq,
                                      const std::array<double, 9>& I_total, double m_total,
                                      const std::array<double, 3>& F_x_Ctotal) const noexcept {
  return source_->coriolis(q, dq, I_total, m_total, F_x_Ctotal);
}
std::array<double, 7> Model::coriolis(
    const std::array<double, 7>& q, const std::array<double, 7>& dq,
    const std::array<double, 9>& I_total, double m_total, const std::array<double, 3>& F_x_Ctotal,
    const std::array<double, 3>& /*gravity_earth*/) const noexcept {
  return coriolis(q, dq, I_total, m_total, F_x_Ctotal);
}

std::array<double, 7> Model::gravity(const std::array<double, 7>& q, double m_total,
                                     const std::array<double, 3>& F_x_Ctotal,
                                     const std::array<double, 3>& gravity_earth) const noexcept {
  return source_->gravity(q, m_total, F_x_Ctotal, gravity_earth);
}
std::array<double, 7> Model::gravity(const RobotState& state,
                                     const std::array<double, 3>& gravity_earth) const noexcept {
  return gravity(state.q, state.m_total, state.F_x_Ctotal, gravity_earth);
}
std::array<double, 7> Model::gravity(const RobotState& state) const noexcept {
  return gravity(state, state.O_ddP_O);
}

}  // namespace franka
