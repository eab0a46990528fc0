// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace franka_example_controllers {

/// The ratio of a circle's circumference to its diameter, since C++17 has no std::numbers.
constexpr double kPi = 3.14159265358979323846;

}  // namespace franka_example_controllers
