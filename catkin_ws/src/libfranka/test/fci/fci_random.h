// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/protocol.h>
#include <franka_core/robot_state.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <random>

#include "../state_fields.h"

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
    forEachSentField(s, [this](auto& values) { fill(values); });
    fillAll(s.accelerometer_top, s.accelerometer_bottom, s.errors, s.reflex_reason);
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
  EXPECT_EQ(sentValues(a), sentValues(b));
  EXPECT_EQ(a.message_id, b.message_id);
  EXPECT_EQ(a.accelerometer_top, b.accelerometer_top);
  EXPECT_EQ(a.accelerometer_bottom, b.accelerometer_bottom);
  EXPECT_EQ(a.motion_generator_mode, b.motion_generator_mode);
  EXPECT_EQ(a.controller_mode, b.controller_mode);
  EXPECT_EQ(a.errors, b.errors);
  EXPECT_EQ(a.reflex_reason, b.reflex_reason);
  EXPECT_EQ(a.robot_mode, b.robot_mode);
}

}  // namespace franka_test
