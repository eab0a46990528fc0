// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>
#include <mujoco/mujoco.h>
#include <tinyxml2.h>

#include <string>

namespace franka_sim::physics {

/// Keeps a file's content in memory until the process ends and returns the name for MJCF texts. The
/// same content is stored once and always has the same name. Thread-safe.
/// @param extension with its dot, e.g. ".msh": MuJoCo derives the file's kind from it
std::string registerFile(const std::string& content, const std::string& extension);

/// Gives MuJoCo access to the kept files that a text names, while it compiles that text.
/// @throws std::runtime_error with a sentence when there are too many or memory is short
void addRegisteredFiles(const std::string& mjcf, mjVFS* files);

/// Resolves names in SDF texts: `model://`, `package://`, `file://`, paths relative to the text.
class SdfFiles {
 public:
  SdfFiles(std::string folder, ResourceResolver resolve)
      : folder_(std::move(folder)), resolve_(std::move(resolve)) {}
  /// An existing file or folder, or an empty text. @param folder of the text that names it; empty:
  /// the folder of the main text.
  std::string find(const std::string& uri, const std::string& folder = "") const;

 private:
  std::string folder_;
  ResourceResolver resolve_;
};

/// Applies an <include>'s name, pose, static, placement_frame and plugins to the included model.
void takeOver(const tinyxml2::XMLElement& include, tinyxml2::XMLElement* model);

/// Returns the text with `model://sun` and `model://ground_plane`, which every Gazebo has, inserted
/// if no such model is found. @param model_name when not empty, the root's model gets this name.
/// @throws std::runtime_error when it is not well-formed XML.
std::string withStandardModels(const std::string& text, const SdfFiles& files,
                               const std::string& title, const std::string& model_name);

}  // namespace franka_sim::physics
