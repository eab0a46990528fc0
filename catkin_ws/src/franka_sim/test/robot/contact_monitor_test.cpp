// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Contacts and collisions by their thresholds.
#include <gtest/gtest.h>

#include "robot/estimator/state_estimator.h"

namespace franka_sim::test {

namespace {

TEST(ContactMonitor, IncludesItsUpperThreshold) {
  ContactMonitor<1> monitor;
  struct Row {
    double value, contact, collision;
  };
  for (const Row& row : {Row{0, 0, 0}, Row{10, 0, 0}, Row{10.001, 1, 0}, Row{-10.001, 1, 0},
                         Row{20, 1, 0}, Row{-20, 1, 0}, Row{-20.001, 0, 1}, Row{0, 0, 1}}) {
    monitor.update({{row.value}}, {{10}}, {{20}});
    EXPECT_EQ(row.contact, monitor.contact()[0]) << row.value;
    EXPECT_EQ(row.collision, monitor.collision()[0]) << row.value;
  }
  monitor.clear();
  EXPECT_EQ(0.0, monitor.collision()[0]);
}

TEST(ContactMonitor, EqualThresholdsGiveNoContact) {
  ContactMonitor<1> monitor;
  for (const double value : {19.0, 20.0}) {
    monitor.update({{value}}, {{20}}, {{20}});
    EXPECT_EQ(0.0, monitor.contact()[0]);
    EXPECT_EQ(0.0, monitor.collision()[0]);
  }
}

}  // namespace

}  // namespace franka_sim::test
