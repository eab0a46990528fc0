// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>
#include <tinyxml2.h>

#include <set>
#include <string>

namespace franka_sim::physics {

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

/// Reads an SDF text of version 1.2 or newer, inserts all included models and makes the names of
/// mesh files absolute. The result is in the terms of SDF 1.9. Of the changes between versions, the
/// reader needs three: `relative_to` of poses and `expressed_in` of axes (since 1.7), and a world's
/// gravity (since 1.6). `model://sun` and `model://ground_plane`, which every Gazebo has, always
/// exist. A model with `<include merge="true">` is inserted with the attribute `merge`.
/// @param title names the text in errors
/// @param model_name when not empty, the root's model gets this name
/// @param document collapses white space
/// @param notes gets what is not inserted as written
/// @throws std::runtime_error with a sentence: an error in the text, a missing model.
void expandSdf(const std::string& text, const SdfFiles& files, const std::string& title,
               const std::string& model_name, tinyxml2::XMLDocument* document,
               std::set<std::string>* notes);

}  // namespace franka_sim::physics
