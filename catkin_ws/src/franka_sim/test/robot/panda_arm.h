// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_sim/robot/control_unit_parameters.h>

#include <cmath>

namespace franka_sim::test {

/// The Panda's chain from the tables of its description, without a file.
inline franka_core::ArmModel pandaModel() {
  constexpr double kQuarter = 1.57079632679489661923;
  struct Row {
    double x, y, z, roll;  // joint origin
    double mass, cx, cy, cz, xx, yy, zz, xy, xz, yz;
  };
  constexpr Row kRows[7] = {{0, 0, 0.333, 0, 4.970684, 0.003875, 0.002081, -0.04762, 0.70337,
                             0.70661, 0.0091170, -0.000139, 0.0067720, 0.019169},
                            {0, 0, 0, -kQuarter, 0.646926, -0.003141, -0.02872, 0.003495, 0.0079620,
                             0.02811, 0.025995, -0.003925, 0.010254, 0.000704},
                            {0, -0.316, 0, kQuarter, 3.228604, 0.027518, 0.039252, -0.066502,
                             0.037242, 0.036155, 0.01083, -0.004761, -0.011396, -0.012805},
                            {0.0825, 0, 0, kQuarter, 3.587895, -0.05317, 0.104419, 0.027454,
                             0.025853, 0.019552, 0.028323, 0.007796, -0.001332, 0.008641},
                            {-0.0825, 0.384, 0, -kQuarter, 1.225946, -0.011953, 0.041065, -0.038437,
                             0.035549, 0.029474, 0.008627, -0.002117, -0.004037, 0.000229},
                            {0, 0, 0, kQuarter, 1.666555, 0.060149, -0.014117, -0.010517, 0.001964,
                             0.004354, 0.005433, 0.000109, -0.001158, 0.000341},
                            {0.088, 0, 0, kQuarter, 0.735522, 0.010517, -0.004252, 0.061597,
                             0.012516, 0.010027, 0.004815, -0.000428, -0.001196, -0.000741}};
  std::array<franka_core::ArmModel::Link, 7> links;
  for (std::size_t i = 0; i < 7; i++) {
    const Row& r = kRows[i];
    const double c = std::cos(r.roll);
    const double s = std::sin(r.roll);
    links[i].origin = {{1, 0, 0, 0, 0, c, s, 0, 0, -s, c, 0, r.x, r.y, r.z, 1}};
    links[i].mass = r.mass;
    links[i].com = {{r.cx, r.cy, r.cz}};
    links[i].inertia = {{r.xx, r.xy, r.xz, r.xy, r.yy, r.yz, r.xz, r.yz, r.zz}};
  }
  std::array<double, 16> flange = franka_core::kIdentityTransform;
  flange[14] = 0.107;
  return franka_core::ArmModel(links, flange);
}

/// The robot's start pose (start_pose.yaml).
constexpr std::array<double, 7> kReady{
    {0, -0.785398163397, 0, -2.35619449019, 0, 1.57079632679, 0.785398163397}};

/// Hand and both closed fingers in the flange frame: masses 0.73 + 2 * 0.015, hand turned by -45
/// degrees.
inline franka_core::Payload pandaHand() {
  const double s = std::sqrt(0.5);
  franka_core::Payload hand;
  hand.mass = 0.73;
  hand.com = {{-0.01 * s, 0.01 * s, 0.03}};
  const double xx = 0.5 * (0.001 + 0.0025);
  const double xy = 0.5 * (0.0025 - 0.001);
  hand.inertia = {{xx, xy, 0, xy, xx, 0, 0, 0, 0.0017}};
  franka_core::Payload fingers;
  fingers.mass = 0.03;
  fingers.com = {{0, 0, 0.0584}};
  fingers.inertia = {{4.75e-6, 0, 0, 0, 4.75e-6, 0, 0, 0, 1.5e-6}};
  return franka_core::combine(hand, fingers);
}

}  // namespace franka_sim::test
