// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/stepping/preparation_thread.h"

#include <gtest/gtest.h>
#include <ros_test/eventually.h>

#include <atomic>
#include <thread>

namespace franka_sim::physics {
namespace {

TEST(PreparationThreadTest, RunsBesideTheThreadThatAsks) {
  std::atomic<int> calls{0};
  std::thread::id where;
  PreparationThread preparation([&] {
    where = std::this_thread::get_id();
    ++calls;
  });
  preparation.request();
  ASSERT_TRUE(ros_test::eventually([&] { return calls > 0; }));
  preparation.finish();
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
