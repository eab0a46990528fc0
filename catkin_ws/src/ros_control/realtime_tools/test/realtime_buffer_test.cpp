// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime_tools/realtime_buffer.h"

#include <gtest/gtest.h>
#include <rt_guard/rt_guard.h>

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include "realtime_tools/realtime_box.h"

using realtime_tools::RealtimeBox;
using realtime_tools::RealtimeBuffer;

namespace {

struct NoDefault {
  explicit NoDefault(int v) : value(v) {}
  int value;
};

}  // namespace

TEST(RealtimeBuffer, StartsWithTheGivenValueOnBothSides) {
  RealtimeBuffer<NoDefault> buffer(NoDefault(42));
  EXPECT_EQ(42, buffer.readFromRT()->value);
  EXPECT_EQ(42, buffer.readFromNonRT()->value);
  RealtimeBuffer<int> zero;
  EXPECT_EQ(0, *zero.readFromRT());
}

TEST(RealtimeBuffer, RealTimeSideSeesTheNewestWrite) {
  RealtimeBuffer<int> buffer(1);
  buffer.writeFromNonRT(2);
  buffer.writeFromNonRT(3);
  EXPECT_EQ(3, *buffer.readFromRT());
  EXPECT_EQ(3, *buffer.readFromRT());
  buffer.writeFromNonRT(4);
  EXPECT_EQ(4, *buffer.readFromNonRT());
  EXPECT_EQ(4, *buffer.readFromRT());
}

TEST(RealtimeBuffer, PointerStaysValidWhileOthersWrite) {
  RealtimeBuffer<int> buffer(1);
  int* held = buffer.readFromRT();
  for (int i = 10; i < 15; ++i) {
    buffer.writeFromNonRT(i);
    EXPECT_EQ(1, *held);
  }
  EXPECT_EQ(14, *buffer.readFromRT());
}

TEST(RealtimeBuffer, ChangesThroughThePointerPersistUntilTheNextWrite) {
  RealtimeBuffer<std::vector<double>> buffer(std::vector<double>{1.0, 2.0});
  buffer.writeFromNonRT({3.0, 4.0});
  buffer.readFromRT()->assign(2, 0.0);
  EXPECT_EQ(std::vector<double>({0.0, 0.0}), *buffer.readFromRT());
  buffer.writeFromNonRT({5.0, 6.0});
  EXPECT_EQ(std::vector<double>({5.0, 6.0}), *buffer.readFromRT());
}

TEST(RealtimeBuffer, InitReplacesAnUnreadWriteOnBothSides) {
  RealtimeBuffer<int> buffer(1);
  buffer.writeFromNonRT(2);
  buffer.initRT(3);
  EXPECT_EQ(3, *buffer.readFromRT());
  EXPECT_EQ(3, *buffer.readFromNonRT());
  buffer.writeFromNonRT(4);
  EXPECT_EQ(4, *buffer.readFromRT());
}

TEST(RealtimeBuffer, CopiesHoldTheLatestValueOfTheirOwn) {
  RealtimeBuffer<int> buffer(1);
  buffer.writeFromNonRT(2);
  RealtimeBuffer<int> copy(buffer);
  RealtimeBuffer<int> assigned(9);
  assigned = buffer;
  buffer.writeFromNonRT(5);
  EXPECT_EQ(2, *copy.readFromRT());
  EXPECT_EQ(2, *assigned.readFromRT());
  EXPECT_EQ(2, *assigned.readFromNonRT());
  EXPECT_EQ(5, *buffer.readFromRT());
}

TEST(RealtimeBuffer, RealTimeSideNeitherAllocatesNorLocks) {
  RealtimeBuffer<std::vector<double>> buffer(std::vector<double>(7, 0.0));
  const std::vector<double> data(7, 1.0);
  for (int i = 0; i < 10; ++i) {
    buffer.writeFromNonRT(data);
    rt_guard::Scope scope;
    buffer.readFromRT();
    buffer.initRT(data);
    EXPECT_EQ(0u, scope.allocations());
    EXPECT_EQ(0u, scope.locks());
    EXPECT_EQ(0u, scope.sleeps());
  }
}

// Two writers and one reader: each value is consistent, and each writer's values arrive in order.
TEST(RealtimeBuffer, ValuesAreWholeAndInOrderUnderConcurrentWrites) {
  constexpr int kWrites = 50000;
  using Value = std::vector<int>;  // {writer, count, count, ...}
  RealtimeBuffer<Value> buffer(Value(16, 0));
  std::atomic<int> running{2};
  auto write = [&](int writer) {
    Value value(16, 0);
    value[0] = writer;
    for (int count = 1; count <= kWrites; ++count) {
      std::fill(value.begin() + 1, value.end(), count);
      buffer.writeFromNonRT(value);
    }
    --running;
  };
  std::thread first(write, 0);
  std::thread second(write, 1);
  int last[2] = {0, 0};
  int torn = 0;
  int backwards = 0;
  bool done = false;
  while (!done) {
    done = running == 0;
    const Value& value = *buffer.readFromRT();
    for (std::size_t i = 2; i < value.size(); ++i) {
      torn += value[i] != value[1] ? 1 : 0;
    }
    backwards += value[1] < last[value[0]] ? 1 : 0;
    last[value[0]] = value[1];
  }
  first.join();
  second.join();
  EXPECT_EQ(0, torn);
  EXPECT_EQ(0, backwards);
  EXPECT_EQ(kWrites, (*buffer.readFromRT())[1]);
}

TEST(RealtimeBox, ReturnsWhatWasSet) {
  RealtimeBox<int> box(3);
  int value = 0;
  box.get(value);
  EXPECT_EQ(3, value);
  box.set(4);
  box.get(value);
  EXPECT_EQ(4, value);
}
