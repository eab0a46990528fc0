// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/protocol.h>
#include <franka_core/robot_state.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <random>

namespace franka_test {

/// Messages full of different values, the same on every run.
class FciRandom {
 public:
  explicit FciRandom(std::uint64_t seed) : engine_(seed) {}

  /// A number that survives single precision.
  double real() {
    return static_cast<float>(std::uniform_real_distribution<double>(-100.0, 100.0)(engine_));
  }
  std::uint64_t upTo(std::uint64_t last) {
    return std::uniform_int_distribution<std::uint64_t>(0, last)(engine_);
  }
  bool flag() { return upTo(1) == 1; }

  void fill(double& value) { value = real(); }
  void fill(bool& value) { value = flag(); }
  template <typename T, std::size_t kSize>
  void fill(std::array<T, kSize>& values) {
    for (T& value : values) {
      fill(value);
    }
  }
  template <typename... Ts>
  void fillAll(Ts&... values) {
    (fill(values), ...);
  }

  /// A state in which every field of the version is random.
  franka_core::RobotState state(std::uint16_t version) {
    franka_core::RobotState s;
    s.message_id = engine_();
    fillAll(s.O_T_EE, s.O_T_EE_d, s.F_T_EE, s.EE_T_K, s.F_T_NE, s.NE_T_EE, s.m_ee, s.I_ee,
            s.F_x_Cee, s.m_load, s.I_load, s.F_x_Cload, s.elbow, s.elbow_d, s.tau_J, s.tau_J_d,
            s.dtau_J, s.q, s.q_d, s.dq, s.dq_d, s.ddq_d, s.joint_contact, s.cartesian_contact,
            s.joint_collision, s.cartesian_collision, s.tau_ext_hat_filtered, s.O_F_ext_hat_K,
            s.K_F_ext_hat_K, s.O_dP_EE_d, s.O_ddP_O, s.elbow_c, s.delbow_c, s.ddelbow_c, s.O_T_EE_c,
            s.O_dP_EE_c, s.O_ddP_EE_c, s.theta, s.dtheta, s.accelerometer_top,
            s.accelerometer_bottom, s.errors, s.reflex_reason, s.control_command_success_rate);
    s.motion_generator_mode =
        static_cast<franka_core::MotionGeneratorMode>(upTo(version >= 7 ? 5 : 4));
    s.controller_mode = static_cast<franka_core::ControllerMode>(upTo(3));
    s.robot_mode = static_cast<franka_core::RobotMode>(upTo(6));
    reduce(s, version);
    return s;
  }

 private:
  // Reduces a state to the fields and precision of the version.
  static void reduce(franka_core::RobotState& s, std::uint16_t version) {
    if (version < 10) {
      s.accelerometer_top = {};
      s.accelerometer_bottom = {};
    }
    if (version < 5) {
      s.O_ddP_O = {0.0, 0.0, -9.81};
      for (std::size_t i = 37; i < franka_core::kErrorCount; i++) {
        s.errors[i] = false;
        s.reflex_reason[i] = false;
      }
    }
    if (version < 4) {
      s.F_T_NE = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
      s.NE_T_EE = s.F_T_EE;
    }
  }

  std::mt19937_64 engine_;
};

inline void expectSame(const franka_core::RobotState& a, const franka_core::RobotState& b) {
#define FRANKA_SAME(field) EXPECT_EQ(a.field, b.field) << #field
  FRANKA_SAME(message_id);
  FRANKA_SAME(O_T_EE);
  FRANKA_SAME(O_T_EE_d);
  FRANKA_SAME(F_T_EE);
  FRANKA_SAME(EE_T_K);
  FRANKA_SAME(F_T_NE);
  FRANKA_SAME(NE_T_EE);
  FRANKA_SAME(m_ee);
  FRANKA_SAME(I_ee);
  FRANKA_SAME(F_x_Cee);
  FRANKA_SAME(m_load);
  FRANKA_SAME(I_load);
  FRANKA_SAME(F_x_Cload);
  FRANKA_SAME(elbow);
  FRANKA_SAME(elbow_d);
  FRANKA_SAME(tau_J);
  FRANKA_SAME(tau_J_d);
  FRANKA_SAME(dtau_J);
  FRANKA_SAME(q);
  FRANKA_SAME(q_d);
  FRANKA_SAME(dq);
  FRANKA_SAME(dq_d);
  FRANKA_SAME(ddq_d);
  FRANKA_SAME(joint_contact);
  FRANKA_SAME(cartesian_contact);
  FRANKA_SAME(joint_collision);
  FRANKA_SAME(cartesian_collision);
  FRANKA_SAME(tau_ext_hat_filtered);
  FRANKA_SAME(O_F_ext_hat_K);
  FRANKA_SAME(K_F_ext_hat_K);
  FRANKA_SAME(O_dP_EE_d);
  FRANKA_SAME(O_ddP_O);
  FRANKA_SAME(elbow_c);
  FRANKA_SAME(delbow_c);
  FRANKA_SAME(ddelbow_c);
  FRANKA_SAME(O_T_EE_c);
  FRANKA_SAME(O_dP_EE_c);
  FRANKA_SAME(O_ddP_EE_c);
  FRANKA_SAME(theta);
  FRANKA_SAME(dtheta);
  FRANKA_SAME(accelerometer_top);
  FRANKA_SAME(accelerometer_bottom);
  FRANKA_SAME(motion_generator_mode);
  FRANKA_SAME(controller_mode);
  FRANKA_SAME(errors);
  FRANKA_SAME(reflex_reason);
  FRANKA_SAME(robot_mode);
  FRANKA_SAME(control_command_success_rate);
#undef FRANKA_SAME
}

}  // namespace franka_test
