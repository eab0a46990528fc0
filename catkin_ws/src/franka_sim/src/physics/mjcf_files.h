// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tinyxml2.h>

#include <string>

namespace franka_sim::physics {

/// Absolute folder of a file, with the final '/'.
std::string folderOf(const std::string& file);

/// Loads an MJCF file and replaces each <include> by the content of its file.
/// @param title names the file in errors.
/// @throws std::runtime_error with a sentence: unreadable, malformed, included twice or in a
/// circle.
void loadExpanded(const std::string& file, const std::string& title,
                  tinyxml2::XMLDocument* document);

/// Makes the file names of meshes, textures, height fields and skins absolute (removing meshdir and
/// texturedir), so that the text can be compiled anywhere.
void makeFilesAbsolute(tinyxml2::XMLElement* root, const std::string& folder);

}  // namespace franka_sim::physics
