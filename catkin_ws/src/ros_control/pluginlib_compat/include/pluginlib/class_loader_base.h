// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Debian's pluginlib has this header only under its newer name.
#include <pluginlib/class_loader_base.hpp>
