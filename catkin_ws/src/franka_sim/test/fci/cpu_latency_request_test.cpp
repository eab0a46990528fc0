// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "serve/cpu_latency_request.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace franka_sim::fci {

namespace {

/// Files as the kernel has them.
class CpuLatencyRequestTest : public ::testing::Test {
 protected:
  CpuLatencyRequestTest() {
    std::filesystem::create_directory(folder);
    std::ofstream{device};
  }
  ~CpuLatencyRequestTest() override { std::filesystem::remove_all(folder); }

  void useDriver(const std::string& name) const { std::ofstream(driver) << name << '\n'; }
  std::string written() const {
    std::ifstream file(device);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  bool isOpen() const {
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
      std::error_code gone;  // the descriptor that reads the folder
      if (std::filesystem::read_symlink(entry, gone) == device) {
        return true;
      }
    }
    return false;
  }

  const std::filesystem::path folder{std::filesystem::temp_directory_path() /
                                     ("cpu_latency_" + std::to_string(getpid()))};
  const std::filesystem::path device{folder / "cpu_dma_latency"}, driver{folder / "current_driver"};
  CpuLatencyRequest request{device, driver};
};

TEST_F(CpuLatencyRequestTest, LastsFromBeginToEnd) {
  useDriver("haltpoll");
  EXPECT_FALSE(isOpen());
  request.begin();
  request.begin();
  EXPECT_TRUE(isOpen());
  EXPECT_EQ(std::string(4, '\0'), written()) << "zero microseconds, once, as 32 bits";
  request.end();
  EXPECT_FALSE(isOpen());
  request.end();
  request.begin();
  EXPECT_TRUE(isOpen());
}

TEST_F(CpuLatencyRequestTest, HasNoEffectWithOtherIdleDrivers) {
  request.begin();  // no driver
  for (const char* other : {"intel_idle", "acpi_idle", "none", ""}) {
    useDriver(other);
    request.begin();
  }
  EXPECT_FALSE(isOpen());
  EXPECT_EQ("", written());
}

TEST_F(CpuLatencyRequestTest, HasNoEffectWithoutTheDevice) {
  useDriver("haltpoll");
  std::filesystem::remove(device);
  request.begin();
  request.end();
  EXPECT_FALSE(std::filesystem::exists(device));
}

}  // namespace

}  // namespace franka_sim::fci
