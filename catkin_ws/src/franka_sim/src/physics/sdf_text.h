// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "physics/sdf_files.h"

namespace franka_sim::physics {

/// Version of SDF whose meaning the texts below have. Of what changed between the versions, the
/// reader needs two things: `relative_to` of poses and `expressed_in` of axes (both since 1.7).
inline constexpr double kSdfVersion = 1.9;

/// The text with all included models written out, files of meshes by their absolute paths, in the
/// terms of SDF 1.9. By Debian's sdformat, which also checks the text against the schema; where
/// that package is missing (Debian 13), by `expandByTinyXml`.
/// @param title names the text in errors
/// @throws std::runtime_error with a sentence: what is wrong with the text, a missing model.
std::string expandSdf(const std::string& text, const SdfFiles& files, const std::string& title);

/// The same without sdformat and without a schema: elements that do not exist are passed over.
/// Not supported: `<include merge="true">`, whose models are included without merging, and
/// included URDF files.
/// @throws std::runtime_error as above.
std::string expandByTinyXml(const std::string& text, const SdfFiles& files,
                            const std::string& title);

}  // namespace franka_sim::physics
