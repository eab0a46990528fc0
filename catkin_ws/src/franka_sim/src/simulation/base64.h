// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace franka_sim {

/// Bytes as text (RFC 4648, section 4).
std::string toBase64(std::string_view bytes);

}  // namespace franka_sim
