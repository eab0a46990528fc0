// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "physics/world/world_impl.h"
#include "temporary_folder.h"
#include "test_support.h"

namespace franka_sim::test {

/// Writes SDF texts and their files into a temporary folder.
class SdfTest : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    return folder_.write(name, text);
  }
  /// Writes a world file with this content.
  std::string file(const std::string& content, const std::string& version = "1.6") {
    return write("test.world", "<?xml version='1.0'?><!-- a world --><sdf version='" + version +
                                   "'><world name='w'>" + content + "</world></sdf>");
  }
  franka_test::TemporaryFolder folder_;
};

inline int bodyId(World& world, const std::string& name) {
  return mj_name2id(implOf(world).model.get(), mjOBJ_BODY, name.c_str());
}

}  // namespace franka_sim::test
