// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/duration.h>
#include <pybind11/pybind11.h>

#include <cstdint>

#include "python_types.h"

/// @file
/// Numbers that can also be used as the objects that they are in pylibfranka and panda-python. Call
/// with the interpreter's lock held, after bindNumbers.

namespace pyfranka {

/// A time as a float [s] that has Duration's functions.
python::Duration seconds(franka::Duration time);

/// A time [s] as whole milliseconds. @throws std::invalid_argument unless it is 0 to 1e12
franka::Duration durationOf(double seconds);

/// The version of a protocol as an int that may be called, which returns it.
python::Version version(std::uint16_t number);

}  // namespace pyfranka
