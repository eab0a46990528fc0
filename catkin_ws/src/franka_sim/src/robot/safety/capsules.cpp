// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/safety/capsules.h"

#include <franka_sim/robot/safety/link_pair.h>

namespace franka_sim {

namespace {

constexpr double kHalfRoot = 0.70710678118654752440;  // cos and sin of 45 degrees

}  // namespace

// The frame of link 7's volumes is turned by 45 degrees about the link's z.
const std::array<Capsule, kCapsuleCount> kCapsules{{
    {0, {{-0.09, 0, 0.06}}, {{-0.06, 0, 0.06}}, 0.06},
    {1, {{0, 0, -0.333}}, {{0, 0, -0.05}}, 0.06},
    {2, {{0, 0, -0.06}}, {{0, 0, 0.06}}, 0.06},
    {3, {{0, 0, -0.22}}, {{0, 0, -0.07}}, 0.06},
    {4, {{0, 0, -0.06}}, {{0, 0, 0.06}}, 0.06},
    {5, {{0, 0, -0.31}}, {{0, 0, -0.21}}, 0.06},
    {5, {{0, 0.08, -0.2}}, {{0, 0.08, -0.06}}, 0.025},
    {6, {{0, 0, -0.07}}, {{0, 0, 0.01}}, 0.05},
    {7, {{0, 0, -0.06}}, {{0, 0, 0.08}}, 0.04},
    {7,
     {{0.055 * kHalfRoot, 0.055 * kHalfRoot, 0.082}},
     {{0.065 * kHalfRoot, 0.065 * kHalfRoot, 0.082}},
     0.03},
    {kHandLink, {{0, -0.05, 0.04}}, {{0, 0.05, 0.04}}, 0.04},
    {kHandLink, {{0, -0.05, 0.1}}, {{0, 0.05, 0.1}}, 0.02},
}};

}  // namespace franka_sim
