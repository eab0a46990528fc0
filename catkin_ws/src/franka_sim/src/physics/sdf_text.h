// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "physics/model_files.h"

namespace franka_sim::physics {

/// Version of SDF after expansion. Of the changes between versions, the reader needs two:
/// `relative_to` of poses and `expressed_in` of axes (both since 1.7).
inline constexpr double kSdfVersion = 1.9;

/// The text with all included models inserted, mesh files by their absolute paths, in the terms of
/// SDF 1.9. By Debian's sdformat, which also checks the text against the schema; without that
/// package (Debian 13), by `expandByTinyXml`.
/// @param title names the text in errors
/// @throws std::runtime_error with a sentence: an error in the text, a missing model.
std::string expandSdf(const std::string& text, const SdfFiles& files, const std::string& title);

/// The same without sdformat and without a schema: unknown elements are ignored.
/// Not supported: `<include merge="true">`, whose models are included without merging, and
/// included URDF files.
/// @throws std::runtime_error as above.
std::string expandByTinyXml(const std::string& text, const SdfFiles& files,
                            const std::string& title);

}  // namespace franka_sim::physics
