// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <string>

namespace franka_sim::fci {

/// A new directory to which only this user can write; removed at the end.
class OwnDirectory {
 public:
  OwnDirectory() { EXPECT_NE(nullptr, mkdtemp(path_.data())); }
  ~OwnDirectory() { std::filesystem::remove_all(path_); }
  OwnDirectory(const OwnDirectory&) = delete;
  OwnDirectory& operator=(const OwnDirectory&) = delete;

  const std::string& path() const noexcept { return path_; }

 private:
  std::string path_{::testing::TempDir() + "franka_sim_XXXXXX"};
};

}  // namespace franka_sim::fci
