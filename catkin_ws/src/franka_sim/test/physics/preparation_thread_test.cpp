// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/preparation_thread.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace franka_sim::physics {
namespace {

using namespace std::chrono_literals;

TEST(PreparationThreadTest, RunsBesideTheThreadThatAsks) {
  std::atomic<int> calls{0};
  std::thread::id where;
  PreparationThread preparation([&] {
    where = std::this_thread::get_id();
    ++calls;
  });
  const auto end = std::chrono::steady_clock::now() + 20s;
  while (calls == 0 && std::chrono::steady_clock::now() < end) {
    preparation.request();
    std::this_thread::sleep_for(1ms);  // a thread that sleeps looks again after 20 ms
    preparation.finish();
  }
  ASSERT_LT(0, calls);
  EXPECT_NE(std::this_thread::get_id(), where);
}

TEST(PreparationThreadTest, NothingIsPreparedAfterItWasFinished) {
  int prepared = 0;  // not atomic: the two threads never use it at the same time
  PreparationThread preparation([&] { ++prepared; });
  int done = 0;
  for (int i = 0; i < 20000; ++i) {
    preparation.request();
    preparation.finish();
    EXPECT_LE(prepared - done, 1);
    done = prepared;
  }
}

TEST(PreparationThreadTest, EndsWithARequestThatNobodyFinished) {
  PreparationThread preparation([] {});
  preparation.request();
}

}  // namespace
}  // namespace franka_sim::physics
